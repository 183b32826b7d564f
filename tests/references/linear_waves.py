#!/usr/bin/env python3
"""Linear waves made by a body in the free surface of water of finite depth: added mass, damping, wave force, free decay.

Plane (2-D) or axisymmetric (heave of a body of revolution). x >= 0 only: images in x = 0 (plane) or rings (axisymmetric); the bed
by images. Time factor exp(-i w t); potentials are per unit velocity of the body. z up from the still level, bed at z = -h.

Equations
  Green's third identity, G = ln r / 2 pi (Laplace: lap G = delta), n out of the water:
      phi/2 = int (phi dG/dn - G dphi/dn) ds  on body, free surface out to x = X, and the line x = X            (Brebbia 1978)
  body        dphi/dn = n_j: heave n_z; sway n_x; roll (turn from x to z about (0, z0)) x n_z - (z - z0) n_x
  surface     dphi/dz = K phi, K = w^2/g  (phi = 0 at w = infinity)
  line x = X  outgoing wave and decaying modes (Havelock 1929):  phi = sum c_n f_n(z) e_n(x),
      f_0 ~ cosh k(z+h), w^2 = g k tanh kh; f_n ~ cos k_n(z+h), w^2 = -g k_n tan k_n h; int f_m f_n dz = delta
      plane e_0 = exp(ikx), e_n = exp(-k_n x); axisymmetric e_0 = H0(kx), e_n = K0(k_n x).
      With q = dphi/dx on the line this is phi = sum (e_n/e_n')(X) <q, f_n> f_n  (a smoothing operator; exact, so X may be close to the body)
  forces      A_ij + i B_ij/w = rho int phi_j n_i ds                                                         (Newman 1977, 6.16)
  energy      plane B_jj = 2 rho w k |c_0|^2 (X = 0 phase); axisymmetric B = 4 rho w |c_0|^2
  Haskind     |F_j|^2 = 2 rho g c_g B_jj per unit amplitude of the incident wave, F from the diffraction problem   (Newman 1962)
  decay       (M + A_inf) x'' + int_0^t k(t - s) x'(s) ds + C x = 0,  k = (2/pi) int B cos wt dw       (Cummins 1962; Ogilvie 1964)
              and, apart from it,  x = x0 + (2/pi) int Re v sin(wt)/w dw,  [C - w^2 (M + A) - i w B] v = -C x0   (Kotik & Lurye 1964)
  No irregular frequencies: the surface is part of the boundary.
Numerics: straight panels, phi and dphi/dn constant on each, collocation at mid-points, panels graded to corners, ring kernel with
the plane kernel taken out; errors fall as 1/N^2, so figures are extrapolated from N and 2N (Richardson 1911).

Checks in this file: multipoles in deep water for the disc (Ursell 1949) and the sphere (Havelock 1955, Hulme 1982), eigenfunction matching for boxes (after Black, Mei & Bray
1971), energy, Haskind, Kramers-Kronig (A against B).
"""
import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import CubicSpline
from scipy.special import ellipe, ellipkm1, eval_legendre, exp1, hankel1, j0, k0e, k1e

inf = np.inf


# ---------------------------------------------------------------- dispersion and modes

def wavenumbers(K, h, n):
    """k_0 of the propagating and k_1..k_n of the decaying modes (1/m)."""
    m = np.arange(1, n + 1) * np.pi
    if K == inf:
        return 0.0, (m - np.pi / 2) / h
    k = max(K, np.sqrt(K / h))
    for _ in range(60):
        t = np.tanh(k * h)
        k -= (k * t - K) / (t + k * h * (1 - t * t))
    d = np.arctan(K * h / (m - 0.5))
    for _ in range(60):
        y = m - d
        f = d - np.arctan2(K * h, y)
        d -= f / (1 - K * h / (y * y + (K * h) ** 2))
    return k, (m - d) / h


def modes(k, kn, h, z1, z2):
    """Means of f_0..f_n over the pieces z1..z2 (rows: modes)."""
    with np.errstate(over="ignore"):
        n0 = h / 2 * (1 / np.cosh(k * h) ** 2 + np.tanh(k * h) / (k * h)) if k > 0 else 1.0   # over cosh^2 kh
    s = lambda z: (np.exp(k * z) - np.exp(-k * (z + 2 * h))) / (1 + np.exp(-2 * k * h))          # sinh k(z+h)/cosh kh
    f0 = (s(z2) - s(z1)) / (k * (z2 - z1)) / np.sqrt(n0) if k > 0 else np.zeros_like(z1)
    nn = h / 2 * (1 + np.sin(2 * kn * h) / (2 * kn * h))
    fn = (np.sin(np.outer(kn, z2 + h)) - np.sin(np.outer(kn, z1 + h))) / np.outer(kn, z2 - z1) / np.sqrt(nn)[:, None]
    return f0, fn, n0


# ---------------------------------------------------------------- mesh

def graded(n, p0, p1):
    """n pieces of [0, 1], finer towards 0 (power p0) and 1 (p1)."""
    t = np.linspace(0, 1, n + 1)
    a, b = t**p0, (1 - t) ** p1
    return a / (a + b)


class Mesh:
    """`body`: list of (function of s in 0..1 giving points, panels, p0, p1) from (0, -draft) up to the waterline; then surface, line."""

    def __init__(self, body, h, X, n_surface, n_line, p=3, axisymmetric=False):
        self.h, self.X, self.ring = h, X, axisymmetric
        end = body[-1][0](np.array([1.0]))[0]
        parts = body + [(lambda s: np.stack([end[0] + (X - end[0]) * s, 0 * s], 1), n_surface, p, p),
                        (lambda s: np.stack([X + 0 * s, -h * s], 1), n_line, p, 1)]
        tag, pts = [], []
        for i, (f, n, p0, p1) in enumerate(parts):
            pts.append(f(graded(n, p0, p1))[(0 if i == 0 else 1):])
            tag += [min(max(i - len(body) + 1, 0), 2)] * n
        nodes = np.concatenate(pts)
        nodes[0, 0] = 0.0
        self.a, self.b, self.tag = nodes[:-1], nodes[1:], np.array(tag)
        self.c = (self.a + self.b) / 2
        d = self.b - self.a
        self.l = np.hypot(*d.T)
        self.n = np.stack([-d[:, 1], d[:, 0]], 1) / self.l[:, None]
        self.t = d / self.l[:, None]
        self.G, self.H = {}, {}
        for sign in ((1,) if axisymmetric else (1, -1)):
            self.G[sign], self.H[sign] = self._rings() if axisymmetric else self._plane(sign)

    def _log(self, flip_x, flip_z):
        """int G and int dG/dn over each panel (columns; seen from each mid-point) with G = ln r/2 pi; the panel mirrored, n too."""
        sx, sz = (-1 if flip_x else 1), (-1 if flip_z else 1)
        off = -2 * self.h if flip_z else 0
        m = lambda v: v * [sx, sz]
        a, t, n = m(self.a) + [0, off], m(self.t), m(self.n)
        r = self.c[:, None] - a[None]
        u, v = (r * t).sum(2), (r * n).sum(2)                    # along and across the panel
        w = u - self.l
        if not (flip_x or flip_z):
            np.fill_diagonal(v, 0.0)
        lg = lambda s: s * np.log(np.hypot(s, v)) - s
        ang = np.where(v == 0, 0.0, np.arctan2(u, v) - np.arctan2(w, v))
        ang = np.where(ang > np.pi, ang - 2 * np.pi, np.where(ang < -np.pi, ang + 2 * np.pi, ang))
        G = (lg(u) - lg(w) + v * ang) / (2 * np.pi)
        return G, -ang / (2 * np.pi)                              # dG/dn' = -(r.n)/(2 pi r^2)

    def _plane(self, sign):
        G, H = 0, 0
        for fx in (0, 1):
            for fz in (0, 1):
                g, k = self._log(fx, fz)
                G, H = G + (sign if fx else 1) * g, H + (sign if fx else 1) * k
        return G, H

    def _rings(self, gauss=8):
        """Ring sources: G_ring = -(rho'/pi R) K(m), R^2 = (rho + rho')^2 + (z - z')^2, m = 4 rho rho'/R^2."""
        def kernel(P, Q, n):
            ro, rq, dz = P[..., 0], Q[..., 0], P[..., 1] - Q[..., 1]
            R2, r2 = (ro + rq) ** 2 + dz**2, (ro - rq) ** 2 + dz**2
            R, m = np.sqrt(R2), 4 * ro * rq / R2
            k, e = ellipkm1(r2 / R2), ellipe(1 - r2 / R2)
            dk = np.where(m < 1e-5, np.pi / 8 * (1 + 9 * m / 8), (e * R2 / np.maximum(r2, 1e-300) - k) / (2 * np.maximum(m, 1e-300)))
            drho = -(1 / np.pi) * (-(ro + rq) / R**3 * k + dk / R * (4 * ro / R2 - 2 * m * (ro + rq) / R2))
            dzq = -(1 / np.pi) * (dz / R**3 * k + dk / R * (2 * m * dz / R2))
            return -rq / (np.pi * R) * k, rq * (drho * n[..., 0] + dzq * n[..., 1])

        def plane(P, Q, n):
            d = Q - P
            r2 = (d**2).sum(-1)
            return np.log(r2) / (4 * np.pi), (d * n).sum(-1) / (2 * np.pi * r2)

        x, w = leggauss(gauss)
        G, H = 0, 0
        for fz in (0, 1):
            g, k = self._log(0, fz)
            s, off = np.array([1, -1 if fz else 1]), [0, -2 * self.h if fz else 0]
            a, b, n = self.a * s + off, self.b * s + off, self.n * s
            for xi, wi in zip(x, w):
                Q = a + (b - a) * (xi + 1) / 2
                P, Qb, nb = self.c[:, None], Q[None], n[None]
                g1, k1 = kernel(P, Qb, nb)
                g2, k2 = plane(P, Qb, nb)
                g, k = g + (g1 - g2) * self.l * wi / 2, k + (k1 - k2) * self.l * wi / 2
            if not fz:                                            # the panel itself: halves, s = u^2
                x2, w2 = leggauss(16)
                g0, k0 = self._log(0, 0)
                gd, kd = np.diag(g0).copy(), np.diag(k0).copy()
                for half in (-1, 1):
                    for xi, wi in zip(x2, w2):
                        u = (xi + 1) / 2
                        Q = self.c + half * (self.b - self.a) / 2 * u**2
                        wt = self.l / 2 * 2 * u * wi / 2
                        g1, k1 = kernel(self.c, Q, self.n)
                        g2, k2 = plane(self.c, Q, self.n)
                        gd, kd = gd + (g1 - g2) * wt, kd + (k1 - k2) * wt
                np.fill_diagonal(g, gd)
                np.fill_diagonal(k, kd)
            G, H = G + g, H + k
        return G, H


# ---------------------------------------------------------------- radiation and diffraction

DOF = {"heave": 1, "sway": -1, "roll": -1}


def normal(mesh, dof, z0):
    c, n = mesh.c, mesh.n
    return {"heave": n[:, 1], "sway": n[:, 0], "roll": c[:, 0] * n[:, 1] - (c[:, 1] - z0) * n[:, 0]}[dof]


def solve(mesh, w, dofs, rho, g, z0=0.0, wave=False, n_modes=1500):
    """A, B (matrices over dofs), wave amplitudes c_0; with `wave` also exciting forces per unit amplitude."""
    h, K = mesh.h, (inf if w == inf else w * w / g)
    k, kn = wavenumbers(K, h, n_modes)
    body, surf, line = (mesh.tag == i for i in range(3))
    top, low = mesh.a[line, 1], mesh.b[line, 1]
    f0, fn, n0 = modes(k, kn, h, low, top)
    dz = mesh.l[line]
    X = mesh.X
    if mesh.ring:
        s0 = hankel1(0, k * X) / (-k * hankel1(1, k * X)) if k > 0 else 0
        sn = -k0e(kn * X) / (kn * k1e(kn * X))
    else:
        s0 = 1 / (1j * k) if k > 0 else 0
        sn = -1 / kn
    N = s0 * np.outer(f0, f0 * dz) + (fn.T * sn) @ (fn * dz)     # phi = N q on the line
    rr = 2 * np.pi * mesh.c[:, 0] if mesh.ring else 2.0           # half the plane, twice
    size = K * max(X, 1e-9)
    p, q = (1.0, K) if size < 1 else (1.0 / K if K != inf else 0.0, 1.0)
    n_dof = len(dofs)
    A, B = np.zeros((n_dof, n_dof)), np.zeros((n_dof, n_dof))
    c0, F = np.zeros(n_dof, complex), np.zeros(n_dof, complex)
    for sign in sorted({DOF[d] for d in dofs}):
        G, H = mesh.G[sign], mesh.H[sign]
        half = 0.5 * np.eye(len(mesh.l)) - H
        M = np.empty_like(half, dtype=complex)
        M[:, body] = half[:, body]
        M[:, surf] = p * half[:, surf] + q * G[:, surf]
        M[:, line] = half[:, line] @ N + G[:, line]
        mine = [i for i, d in enumerate(dofs) if DOF[d] == sign]
        V = np.stack([normal(mesh, dofs[i], z0) for i in mine], 1)
        rhs = [-G[:, body] @ V[body]]
        if wave:
            x, z = mesh.c.T
            E = lambda z: (np.exp(k * z) + np.exp(-k * (z + 2 * h))) / (1 + np.exp(-2 * k * h))
            S = lambda z: (np.exp(k * z) - np.exp(-k * (z + 2 * h))) / (1 + np.exp(-2 * k * h))
            amp = -1j * g / w                                     # eta = exp(ikx - iwt)
            cx, sx = (np.cos(k * x), -np.sin(k * x)) if sign > 0 else (1j * np.sin(k * x), 1j * np.cos(k * x))
            pI, pn = amp * E(z) * cx, amp * k * (E(z) * sx * mesh.n[:, 0] + S(z) * cx * mesh.n[:, 1])
            rhs.append((G[:, body] @ pn[body])[:, None])
        u = np.linalg.solve(M, np.concatenate(rhs, 1))
        weight = (mesh.l * rr)[body, None] * V[body]
        for a, j in enumerate(mine):
            I = rho * weight.T @ u[body, a]
            A[mine, j], B[mine, j] = I.real, (I.imag * w if w != inf else 0)
            if k > 0:
                c0[j] = s0 * np.sum(u[line, a] * f0 * dz)
        if wave:
            F[mine] = 1j * w * rho * weight.T @ (pI[body] + u[body, -1])
    if mesh.ring and k > 0:
        c0 = c0 / hankel1(0, k * X)
    return dict(A=A, B=B, c0=c0, F=F, k=k, w=w)


def group_speed(w, k, h, g):
    return w / k / 2 * (1 + 2 * k * h / np.sinh(min(2 * k * h, 600)))


def disc(R, h, n=60, span=1.0, axisymmetric=False):
    arc = lambda s: R * np.stack([np.sin(s * np.pi / 2), -np.cos(s * np.pi / 2)], 1)
    return Mesh([(arc, n, 1, 2)], h, R + span * R, n, n, 2.5, axisymmetric)


def box(b, T, h, n=60, span=None, p=3):
    """Half breadth b/2, draft T (0: a strip in the surface)."""
    e = b / 2
    parts = [(lambda s: np.stack([e * s, -T + 0 * s], 1), n, 1, p)]
    if T > 0:
        parts.append((lambda s: np.stack([e + 0 * s, -T + T * s], 1), n, p, p))
    return Mesh(parts, h, e + (span or e), n, n, p)


# ---------------------------------------------------------------- independent solutions, for checks

def ursell_deep(R, w, rho, g, n=30):
    """Heave of a half-immersed disc in deep water by multipoles (Ursell 1949)."""
    K = w * w / g
    th = (np.arange(400) + 0.5) / 400 * np.pi / 2                # from the downward vertical
    def source(r):
        x, y = r * np.sin(th), r * np.cos(th)                    # y down; PV int e^{-k(y - ix)}/(k - K) dk, outgoing wave added
        zeta = -K * (y - 1j * x)
        E = exp1(zeta + 0j)                                      # zeta in the upper left quarter
        pv = np.real(np.exp(zeta) * (E + 1j * np.pi))
        return pv + 1j * np.pi * np.exp(-K * y) * np.cos(K * x)
    d = R * 1e-5
    cols = [(source(R), (source(R + d) - source(R - d)) / (2 * d))]
    for m in range(1, n + 1):
        f = lambda r: np.cos(2 * m * th) / r ** (2 * m) * R ** (2 * m) + K * R / (2 * m - 1) * np.cos((2 * m - 1) * th) / r ** (2 * m - 1) * R ** (2 * m - 1)
        cols.append((f(R), -2 * m / R * np.cos(2 * m * th) - K * np.cos((2 * m - 1) * th)))
    D = np.stack([c[1] for c in cols], 1).astype(complex)
    # dphi/dr = V.e_r; V = up, e_r.up = -cos th
    a = np.linalg.lstsq(D, -np.cos(th).astype(complex), rcond=None)[0]
    phi = np.stack([c[0] for c in cols], 1) @ a
    # n (out of the water) = -e_r, n_z = cos th
    I = rho * 2 * np.sum(phi * np.cos(th)) * R * (np.pi / 2 / 400)
    return I.real, I.imag * w


def hulme_deep(R, w, rho, g, n=20):
    """Heave of a half-immersed sphere in deep water by multipoles (Havelock 1955, Hulme 1982)."""
    K = w * w / g
    u, wu = leggauss(60)
    c, wu = (u + 1) / 2, wu / 2                                  # cos of the angle from the downward vertical
    s = np.sqrt(1 - c * c)
    t = (np.arange(200) + 0.5) / 200 * np.pi                     # J0(a) = mean of exp(i a cos t)
    def source(r):                                               # PV int k e^{-ky} J0(k x)/(k - K) dk, outgoing wave added
        zeta = -K * (r * c[:, None] - 1j * abs(r * s[:, None] * np.cos(t)))
        pv = np.real(np.exp(zeta) * (exp1(zeta) + 1j * np.pi)).mean(1)
        return 1 / r + K * pv + 1j * np.pi * K * np.exp(-K * r * c) * j0(K * r * s)
    d = R * 1e-5
    cols = [(source(R), (source(R + d) - source(R - d)) / (2 * d))]
    for m in range(1, n + 1):
        P, Q = eval_legendre(2 * m, c), eval_legendre(2 * m - 1, c)
        cols.append((P + K * R / (2 * m) * Q, -(2 * m + 1) / R * P - K * Q))   # times (R/r)^(2m + 1)
    D = np.stack([q[1] for q in cols], 1).astype(complex)
    q = np.sqrt(wu)
    a = np.linalg.lstsq(D * q[:, None], -c * q + 0j, rcond=None)[0]
    I = rho * 2 * np.pi * R * R * np.sum(wu * (np.stack([q[0] for q in cols], 1) @ a) * c)
    return I.real, I.imag * w


def box_by_modes(b, T, h, w, rho, g, z0=0.0, n_in=80, n_out=None):
    """Eigenfunction matching (after Black, Mei & Bray 1971): A, B of heave, sway, roll as dict."""
    K = inf if w == inf else w * w / g
    s, e = h - T, b / 2
    n_out = n_out or int(n_in * h / s) * 1
    k, kn = wavenumbers(K, h, n_out)
    if k > 0:
        N0 = h / 2 * (1 + np.sinh(2 * k * h) / (2 * k * h))
    Nn = h / 2 * (1 + np.sin(2 * kn * h) / (2 * kn * h))
    kap = np.concatenate([[-1j * k], kn]) if k > 0 else kn + 0j  # phi ~ exp(-kap (x - e)); f = cos(kap' y), y = z + h
    al = np.concatenate([[1j * k], kn]) if k > 0 else kn + 0j    # f = cos(al y)/sqrt(N)
    Nm = np.concatenate([[N0], Nn]) if k > 0 else Nn
    y, wt = leggauss(4000)
    def quad(lo, hi):
        return lo + (hi - lo) * (y + 1) / 2, wt * (hi - lo) / 2
    yi, wi = quad(0, s)
    fo = np.cos(np.outer(al, yi)) / np.sqrt(Nm)[:, None]         # outer modes over the gap
    m = np.arange(n_in + 1)
    gi = np.cos(np.outer(m * np.pi / s, yi)) * np.where(m > 0, np.sqrt(2 / s), np.sqrt(1 / s))[:, None]
    C = (fo * wi) @ gi.T                                         # <f_n, g_m>
    mu = m * np.pi / s
    ys, ws = (quad(s, h) if T > 0 else (np.array([h]), np.array([0.0])))
    fs = np.cos(np.outer(al, ys)) / np.sqrt(Nm)[:, None]
    out = {}
    sols = {}
    for dof in ("heave", "sway", "roll"):
        even = dof == "heave"
        # particular inner solution (value and slope at x = e), bottom of the box moving
        pv = {"heave": (yi**2 - e * e) / (2 * s), "sway": 0 * yi, "roll": (e * yi**2 - e**3 / 3) / (2 * s)}[dof]
        ps = {"heave": -e / s + 0 * yi, "sway": 0 * yi, "roll": (yi**2 - e * e) / (2 * s)}[dof]
        th = np.tanh(mu * e)
        ratio = (mu * th if even else np.where(m > 0, mu / np.maximum(th, 1e-300), 1 / e))   # slope/value of inner modes at x = e
        side = {"heave": 0 * ys, "sway": 1 + 0 * ys, "roll": -(ys - h - z0)}[dof]
        # outer slopes: -kap c_n = <slope, f_n> = sum_m C_nm ratio_m a_m + <ps, f_n> + <side, f_n>; values over the gap: a_m = sum_n C_nm c_n - <pv, g_m>
        S = (fo * wi) @ ps + (fs * ws) @ side
        c_of = -1 / kap
        M = np.eye(n_in + 1) - C.T @ (c_of[:, None] * (C * ratio))
        a = np.linalg.solve(M, C.T @ (c_of * S) - (gi * wi) @ pv)
        c = c_of * (C @ (ratio * a) + S)
        sols[dof] = (a, c, pv)
    xs, wx = e * (y + 1) / 2, wt * e / 2
    gs = (-1.0) ** m * np.where(m > 0, np.sqrt(2 / s), np.sqrt(1 / s))
    for dj, (a, c, pv) in sols.items():
        even = dj == "heave"
        if even:
            sh = np.exp(np.outer(xs - e, mu)) * (1 + np.exp(-2 * np.outer(xs, mu))) / (1 + np.exp(-2 * mu * e))
            part = (s * s - xs**2) / (2 * s)
        else:
            with np.errstate(all="ignore"):
                sh = np.exp(np.outer(xs - e, mu)) * (1 - np.exp(-2 * np.outer(xs, mu))) / (1 - np.exp(-2 * mu * e))
            sh[:, 0] = xs / e
            part = 0 * xs if dj == "sway" else (xs * s * s - xs**3 / 3) / (2 * s)
        under = part + sh @ (gs * a)
        beside = c @ fs
        for di in sols:
            if (di == "heave") != even:
                continue
            I = 0
            if di in ("heave", "roll"):
                I += 2 * np.sum(wx * under * (xs if di == "roll" else 1))
            if di in ("sway", "roll"):                            # n_x = -1 on the right side
                sgn = {"sway": -1 + 0 * ys, "roll": (ys - h - z0)}[di]
                I += 2 * np.sum(ws * beside * sgn)
            I *= rho
            out[di, dj] = (I.real, I.imag * w if w != inf else 0.0)
    return out


# ---------------------------------------------------------------- free decay

def cummins(M, Ainf, C, x0, w, B, t_end=3.0, dt=0.002, more=None):
    """Convolution with the memory of the water; trapezoidal rule. w: even grid from 0; B[w, i, j]. more(x): restoring force beyond -C x."""
    t = np.arange(int(round(t_end / dt)) + 1) * dt
    wt = np.full(len(w), w[1] - w[0]); wt[[0, -1]] /= 2
    k = 2 / np.pi * np.einsum("tw,wij->tij", np.cos(np.outer(t, w)) * wt, B)
    n = len(x0)
    x, v = np.zeros((len(t), n)), np.zeros((len(t), n))
    x[0] = x0
    more = more or (lambda x: 0.0)
    a = np.linalg.solve(M + Ainf, -C @ x[0] + more(x[0]))
    S = np.linalg.inv(M + Ainf + dt / 2 * (dt / 2 * k[0]) + dt * dt / 4 * C)
    for i in range(1, len(t)):
        vp, xp = v[i - 1] + dt / 2 * a, x[i - 1] + dt * v[i - 1] + dt * dt / 4 * a
        mem = dt * (0.5 * k[i] @ v[0] + (np.einsum("tij,tj->i", k[i - 1:0:-1], v[1:i]) if i > 1 else 0) + 0.5 * k[0] @ vp)
        a = S @ (-mem - C @ xp + more(xp + dt * dt / 4 * a))
        v[i], x[i] = vp + dt / 2 * a, xp + dt * dt / 4 * a
    return t, x, k


def synthesis(M, Ainf, C, x0, w, A, B, t):
    """Frequency-domain synthesis; beyond the last w the body has A_inf and no damping (tail by a grid to 40 times that)."""
    def re_v(w, A, B):
        Z = C - (w * w)[:, None, None] * (M + A) - 1j * w[:, None, None] * B
        return np.linalg.solve(Z, np.broadcast_to(-(C @ x0), (len(w), len(x0)))[..., None])[..., 0].real
    lo = np.linspace(0, w[-1], 20 * (len(w) - 1) + 1)              # finer: a lightly damped body has a sharp peak
    A, B = CubicSpline(w, A)(lo[1:]), CubicSpline(w, B)(lo[1:])
    lo, dw = lo[1:], lo[1]
    v = re_v(lo, A, B)
    wt = np.full(len(lo), dw); wt[-1] /= 2
    x = x0 + 2 / np.pi * (np.sin(np.outer(t, lo)) / lo * wt) @ v
    v0 = v[0] * 1.0                                               # the interval 0..dw: sin(wt)/w -> t
    x += 2 / np.pi * np.outer(t, v0) * dw / 2
    hi = np.linspace(w[-1], 40 * w[-1], 20001)
    vh = re_v(hi, np.broadcast_to(Ainf, (len(hi),) + Ainf.shape), np.zeros((len(hi),) + Ainf.shape))
    wt = np.full(len(hi), hi[1] - hi[0]); wt[[0, -1]] /= 2
    return x + 2 / np.pi * (np.sin(np.outer(t, hi)) / hi * wt) @ vh


def tank_decay(mesh, M, C, x0, rho, g, t, dofs, damping=None, eps=2.0, w_max=60.0, dw=0.25):
    """As `synthesis` in a tank with walls at +-mesh.X, by frequencies w + i eps (Laplace). `damping(x)`: dv/dt = -damping v, as
    dphi/dz = (w^2 + i w damping)/g phi at the surface (exact where damping is even over a wave length)."""
    body, surf, line = (mesh.tag == i for i in range(3))
    sign = DOF[dofs[0]]
    G, half = mesh.G[sign], 0.5 * np.eye(len(mesh.l)) - mesh.H[sign]
    V = np.stack([normal(mesh, d, 0.0) for d in dofs], 1)
    weight = rho * 2 * mesh.l[body, None] * V[body]
    gam = np.zeros(surf.sum()) if damping is None else damping(mesh.c[surf, 0])
    rhs, x = -G[:, body] @ V[body], np.zeros((len(t), len(x0)))
    w = (np.arange(int(w_max / dw)) + 0.5) * dw
    def add(w, dw, I):
        s = w + 1j * eps
        v = np.linalg.solve(C - s * s * (M + I), -(C @ x0))
        return np.outer(np.exp(-1j * s * t), v / (-1j * s)).real * dw / np.pi
    for wi in w:
        s = wi + 1j * eps
        K = (s * s + 1j * s * gam) / g
        A = half.astype(complex)
        A[:, surf] = half[:, surf] / K + G[:, surf]               # unknown dphi/dz there; dphi/dx = 0 on the line, phi unknown
        I = weight.T @ np.linalg.solve(A, rhs)[body]
        x += add(wi, dw, I)
    for wi in np.arange(w_max + dw / 2, 10 * w_max, dw):
        x += add(wi, dw, I)
    return x0 + x


def extrema(t, x):
    """Times and values of the turning points after t = 0 (parabola through three samples)."""
    i = np.nonzero((x[1:-1] - x[:-2]) * (x[2:] - x[1:-1]) < 0)[0] + 1
    out = []
    for j in i:
        y0, y1, y2 = x[j - 1:j + 2]
        d = (y0 - y2) / (2 * (y0 - 2 * y1 + y2))
        out.append((t[j] + d * (t[1] - t[0]), y1 - (y0 - y2) * d / 4))
    return out


def crossings(t, x):
    i = np.nonzero(x[1:] * x[:-1] < 0)[0]
    return t[i] + (t[1] - t[0]) * x[i] / (x[i] - x[i + 1])


# ---------------------------------------------------------------- the figures (python linwave.py a b c d e f)

DOFS = ["heave", "sway", "roll"]
PAIRS = [("33", 0, 0), ("22", 1, 1), ("44", 2, 2), ("24", 1, 2)]


def refined(make, ws, dofs, rho, g, n):
    """A, B at ws by extrapolation from n, 2n, 4n panels: arrays [w, i, j] and error estimates (twice the change of the extrapolate)."""
    r = []
    for m in (n, 2 * n, 4 * n):
        mesh = make(m)
        s = [solve(mesh, w, dofs, rho, g) for w in ws]
        r.append(np.array([[q["A"], q["B"]] for q in s]))
    e1, e2 = (4 * r[1] - r[0]) / 3, (4 * r[2] - r[1]) / 3
    err = 2 * abs(e2 - e1)
    return e2[:, 0], e2[:, 1], err[:, 0], err[:, 1]


def checks(make, ws, dofs, rho, g, h, n):
    """Largest departures from the energy and Haskind relations at the finest mesh, by dof."""
    mesh, out = make(4 * n), np.zeros((2, len(dofs)))
    for w in ws:
        if w < inf:
            r = solve(mesh, w, dofs, rho, g, wave=not mesh.ring)
            B = r["B"].diagonal()
            out[0] = np.maximum(out[0], abs((4 if mesh.ring else 2 * r["k"]) * rho * w * abs(r["c0"]) ** 2 / B - 1))
            if not mesh.ring:
                out[1] = np.maximum(out[1], abs(abs(r["F"]) ** 2 / (2 * rho * g * group_speed(w, r["k"], h, g)) / B - 1))
    return out


def sweep(make, dofs, rho, g, n=30, w_max=40.0, dw=0.2):
    """A, B on an even grid from 0, A_inf; extrapolated (n, 2n) and plain (2n)."""
    w = np.arange(int(round(w_max / dw)) + 1) * dw
    ws = np.concatenate([[0.02], w[1:], [inf]])
    r = []
    for m in (n, 2 * n):
        mesh = make(m)
        r.append(np.array([[q["A"], q["B"]] for q in (solve(mesh, x, dofs, rho, g) for x in ws)]))
    e = (4 * r[1] - r[0]) / 3
    return w, [(x[:-1, 0], x[:-1, 1], x[-1, 0]) for x in (e, r[1])]


def sym(a):
    return (a + np.swapaxes(a, -1, -2)) / 2


def kramers_kronig(w, A, B, Ainf, t_end=20.0):
    """Largest |A - A_inf + (1/w) int k sin wt dt| over 4 < w < 12, from B alone."""
    dt = 0.004
    t = np.arange(int(t_end / dt)) * dt
    wt = np.full(len(w), w[1] - w[0]); wt[[0, -1]] /= 2
    k = 2 / np.pi * np.cos(np.outer(t, w)) @ (wt * B)
    s = (w > 4) & (w < 12)
    tw = np.full(len(t), dt); tw[0] /= 2
    return np.max(abs(A[s] - Ainf + (np.sin(np.outer(w[s], t)) @ (tw * k)) / w[s]))


def decay(name, make, dofs, M, C, x0, rho, g, t_end=3.0, n=30, out=None):
    w, both = sweep(make, dofs, rho, g, n)
    t = np.arange(int(round(t_end / 0.002)) + 1) * 0.002
    runs = []
    for label, (A, B, Ai) in zip(("Cummins, extrapolated", "Cummins, 2n panels"), both):
        A, B, Ai = sym(A), sym(B), sym(Ai)
        tc, x, _ = cummins(M, Ai, C, x0, w, B, t_end)
        runs.append((label, x))
        if label.endswith("ated"):
            runs.append(("synthesis", synthesis(M, Ai, C, x0, w, A, B, t)))
            tc2, x2, _ = cummins(M, Ai, C, x0, w, B, t_end, dt=0.004)
            runs.append(("Cummins, dt 4 ms", np.stack([np.interp(t, tc2, x2[:, j]) for j in range(len(x0))], 1)))
            kk = [kramers_kronig(w, A[:, j, j], B[:, j, j], Ai[j, j]) for j in range(len(x0))]
            print(name, "A_inf", Ai.tolist(), "B(40)", B[-1].diagonal(), "Kramers-Kronig, largest departure of A", kk)
    j = int(np.argmax(abs(np.array(x0))))
    for label, x in runs:
        print(f"{name:12s} {label:24s}", "  ".join(f"{b / x0[j]:+.4f} at {a:.4f}" for a, b in extrema(t, x[:, j])[:6]),
              " crossings", np.round(crossings(t, x[:, j])[:6], 4), f" x(0) {x[0, j] / x0[j]:.4f}")
    return t, runs, w, both


def write(path, comments, header, rows):
    with open(path, "w") as f:
        f.write("".join(f"# {c}\n" for c in comments) + header + "\n")
        f.writelines(",".join(v if isinstance(v, str) else f"{v:.6g}" for v in r) + "\n" for r in rows)


HOW = "source: computed for this project with linwave.py (linear potential flow, panels; extrapolated from n, 2n, 4n panels, n = 30)"


def item_a():
    rho, g, R, h = 998.2, 9.82, 0.15, 0.6
    ws = [3, 4, 5, 6, 7, 7.2, 8, 9, 9.5, 10, 12, 15, 20, 40, inf]
    make = lambda n: disc(R, h, n, 0.6)
    A, B, eA, eB = refined(make, ws, ["heave"], rho, g, 30)
    print("a checks: energy, Haskind", checks(make, ws[:-2], ["heave"], rho, g, h, 30).ravel())
    for depth in (12.0,):
        a, b, _, _ = refined(lambda n: disc(R, depth, n), [5, 7.2, 9.5], ["heave"], rho, g, 60)
        u = np.array([ursell_deep(R, w, rho, g) for w in (5, 7.2, 9.5)])
        print("a against Ursell, depth 12 m:", a.ravel() / u[:, 0] - 1, b.ravel() / u[:, 1] - 1)
    rows = [(w, A[i, 0, 0], B[i, 0, 0], max(eA[i, 0, 0], 1e-4 * A[i, 0, 0]), max(eB[i, 0, 0], 1e-4 * B[i, 0, 0])) for i, w in enumerate(ws)]
    write("a_disc_heave.csv", ["Forced heave of a half-immersed disc (circular cylinder, per metre): added mass A, damping B",
          "set-up: 2-D, D = 0.3 m, centre at the still level, depth 0.6 m, open on both sides, water 998.2 kg/m3, g = 9.82 m/s2; F = -K z - A z'' - B z', K = 2940.7 N/m2",
          HOW, "error: err_A, err_B, twice the change of the extrapolate or 1e-4, the larger; the energy and Haskind relations hold within 4e-4; Ursell 1949 (deep water) within 1e-4"],
          "w_rad_per_s,A_kg_per_m,B_kg_per_m_s,err_A,err_B", rows)
    for r in rows: print("a", *(f"{v:.5g}" for v in r))


def item_b():
    rows = []
    for name, b, T, h, ws in (("ten-row", 0.2, 0.05, 0.3, [6, 8, 10, inf]), ("ren", 0.3, 0.1, 0.4, [2 * np.pi / 1.2, inf])):
        rho, g = 1000.0, 9.81
        make = lambda n: box(b, T, h, n, 0.3 * b)
        A, B, eA, eB = refined(make, ws, DOFS, rho, g, 30)
        A, B, eA, eB = (sym(q) for q in (A, B, eA, eB))
        print("b checks: energy, Haskind (heave, sway, roll)", name, checks(make, ws, DOFS, rho, g, h, 30))
        for i, w in enumerate(ws):
            o = [box_by_modes(b, T, h, w, rho, g, 0.0, n) for n in (80, 160)]
            row, errs = [name, w], []
            for label, p, q in PAIRS:
                a0, b0 = o[1][DOFS[p], DOFS[q]]
                row += [A[i, p, q], B[i, p, q]]
                errs += [max(eA[i, p, q], abs(A[i, p, q] - a0)), max(eB[i, p, q], abs(B[i, p, q] - b0))]
                print("b", name, f"{w:.4g}", label, f"A {A[i, p, q]:.6g} +- {eA[i, p, q]:.1g} (modes {a0:.6g})  B {B[i, p, q]:.6g} +- {eB[i, p, q]:.1g} (modes {b0:.6g})")
            rows.append(row + errs)
        if name == "ren":                                         # motions in waves: homogeneous, half as dense as water
            m = rho * b * T
            M, C = np.diag([m, m, m * (b * b + 0.04) / 12]), np.diag([rho * g * b, 0, rho * g * (b**3 / 12 - b * T * T / 2)])
            for n in (30, 60, 120):
                r = solve(make(n), ws[0], DOFS, rho, g, wave=True)
                X = np.linalg.solve(C - ws[0] ** 2 * (M + r["A"]) - 1j * ws[0] * r["B"], r["F"])
                print("b Ren, per wave amplitude: heave, sway", abs(X[:2]), "pitch, degrees at 20.3 mm", np.degrees(abs(X[2]) * 0.0203),
                      "sway after heave, periods", (np.angle(X[1] / X[0]) / 2 / np.pi) % 1, "roll after heave", (np.angle(X[2] / X[0]) / 2 / np.pi) % 1)
    write("b_boxes.csv", ["Forced heave (33), sway (22), roll (44) and sway-roll (24 = 42) of half-immersed boxes, per metre: added mass A, damping B",
          "set-up: 2-D, open on both sides, water 1000 kg/m3, g = 9.81 m/s2; ten-row: 0.2 m x 0.1 m, draft 0.05 m, depth 0.3 m (roll test); ren: 0.3 m x 0.2 m, draft 0.1 m, depth 0.4 m",
          "roll about the point on the waterline at mid-breadth, which is also the centre of mass (both boxes are half as dense as water and half immersed); positive from +x to +z (counter-clockwise), sway along +x",
          "about a point z0 above the waterline: X24' = X24 + z0 X22, X44' = X44 + 2 z0 X24 + z0^2 X22 (X = A, B)",
          "units: 33, 22 kg/m and kg/(m s); 24 kg and kg/s; 44 kg m and kg m/s (all per metre of breadth of the tank)",
          HOW, "error: err_*, the larger of twice the change of the extrapolate and the difference from eigenfunction matching (independent, 160 modes, not extrapolated); energy and Haskind within 3e-4, roll of ren (B44 nearly 0) 1.4e-3"],
          "box,w_rad_per_s," + ",".join(f"A{p[0]},B{p[0]}" for p in PAIRS) + "," + ",".join(f"err_A{p[0]},err_B{p[0]}" for p in PAIRS), rows)


def item_c():
    rho, g, b, T, h, x0 = 1000.0, 9.81, 0.2, 0.05, 0.3, np.array([0, np.radians(8.0)])
    m = rho * b * T
    M, C = np.diag([m, m * (b * b + 0.01) / 12]), np.diag([0, rho * g * (b**3 / 12 - b * T * T / 2)])
    t, runs, w, both = decay("c roll", lambda n: box(b, T, h, n, 0.06), ["sway", "roll"], M, C, x0, rho, g)
    x = runs[0][1]
    B, Ai = sym(both[0][1]), sym(both[0][2])
    # box with plane sides: exact righting moment rho g S sin a (GM + BM tan^2 a/2)
    S, GM, BM = b * T, C[1, 1] / (rho * g * b * T), b * b / 12 / T
    arm = lambda y: np.array([0, C[1, 1] * y[1] - rho * g * S * np.sin(y[1]) * (GM + BM * np.tan(y[1]) ** 2 / 2)])
    _, xn, _ = cummins(M, Ai, C, x0, w, B, 3.0, more=arm)
    gamma = lambda q: 12 * np.sqrt(g * h) / 0.3 * np.clip((q - 0.3) / 0.3, 0, 1) ** 2
    tanks = []
    for label, n, damp in (("walls +-0.6 m, beaches, n 60", 60, gamma), ("walls +-0.6 m, beaches, n 120", 120, gamma), ("walls +-0.6 m, no beaches", 60, None)):
        mesh = Mesh([(lambda s: np.stack([b / 2 * s, -T + 0 * s], 1), n // 2, 1, 3), (lambda s: np.stack([b / 2 + 0 * s, -T + T * s], 1), n // 2, 3, 3)], h, 0.6, 2 * n, n // 2, 2)
        y = tank_decay(mesh, M, C, x0, rho, g, t, ["sway", "roll"], damp)
        tanks.append((label, y))
    for label, y in [("linear, open", x), ("exact righting arm, open", xn)] + tanks:
        c = crossings(t, y[:, 1])
        print("c", f"{label:32s}", "swings", np.round(np.degrees([v for _, v in extrema(t, y[:, 1])[:6]]), 3), "crossings", np.round(c[:5], 4), "period (4th - 1st)/1.5:", round((c[3] - c[0]) / 1.5, 4))
    held = decay("c roll alone", lambda n: box(b, T, h, n, 0.06), ["roll"], M[1:, 1:], C[1:, 1:], x0[1:], rho, g)
    print("c roll alone (sway locked): period", (lambda c: (c[3] - c[0]) / 1.5)(crossings(held[0], held[1][0][1][:, 0])))
    _, y33, _, _ = hv = decay("c heave", lambda n: box(b, T, h, n, 0.06), ["heave"], M[:1, :1], np.array([[rho * g * b]]), np.array([1.0]), rho, g)
    write("c_roll_decay.csv", ["Free roll of the ten-row box (0.2 m x 0.1 m, half as dense as water, half immersed), free in sway, heave and roll, released at rest at 8 degrees",
          "set-up: 2-D, depth 0.3 m, water 1000 kg/m3, g = 9.81 m/s2; angle positive from +x to +z; sway of the centre of mass",
          HOW.replace("n, 2n, 4n panels, n = 30", "30 and 60 panels a side") + "; Cummins' equation, time step 2 ms; frequency-domain synthesis agrees within 0.01 degree",
          "columns: linear, open on both sides; the same with the exact righting arm of a box (an estimate of the effect of 8 degrees); linear in the tank of the test (1.2 m, damping zones as a surface condition: approximate)",
          "error of the linear columns: 0.02 degree, 1 ms. No vortices: potential flow has hardly any roll damping; real and SPH water have more"],
          "t_s,roll_deg,sway_mm,roll_exact_arm_deg,roll_tank_deg", [(t[i], np.degrees(x[i, 1]), x[i, 0] * 1e3, np.degrees(xn[i, 1]), np.degrees(tanks[1][1][i, 1])) for i in range(0, len(t), 5)])


def item_d():
    rho, g, R, h = 998.2, 9.82, 0.15, 0.6
    ws = [6, 7, 8, 8.3, 9, 10, inf]
    make = lambda n: disc(R, h, n, 0.6, True)
    A, B, eA, eB = refined(make, ws, ["heave"], rho, g, 30)
    print("d checks: energy", checks(make, ws, ["heave"], rho, g, h, 30)[0])
    rows = [(w, A[i, 0, 0], B[i, 0, 0], max(eA[i, 0, 0], 1e-4 * A[i, 0, 0]), max(eB[i, 0, 0], 1e-4 * B[i, 0, 0])) for i, w in enumerate(ws)]
    for r in rows: print("d", *(f"{v:.5g}" for v in r))
    V = 2 / 3 * np.pi * R**3 * rho
    for Ka in (0.5, 1.0, 1.53):
        w = np.sqrt(Ka * g / R)
        a, b, _, _ = refined(lambda n: disc(R, 9.0, n, 0.6, True), [w], ["heave"], rho, g, 40)
        u = hulme_deep(R, w, rho, g)
        print("d depth 9 m, KR", Ka, "A/m, B/(m w)", a.item() / V, b.item() / V / w, "multipoles, deep", u[0] / V, u[1] / V / w)
    write("d_sphere_heave.csv", ["Forced heave of a half-immersed sphere: added mass A, damping B",
          "set-up: 3-D, radius 0.15 m, centre at the still level, depth 0.6 m, no side walls, water 998.2 kg/m3, g = 9.82 m/s2; F = -K z - A z'' - B z', K = 692.92 N/m",
          HOW.replace("panels;", "rings;"), "error: err_A, err_B; energy within 3e-4; in deep water multipoles (after Hulme 1982) agree: README"],
          "w_rad_per_s,A_kg,B_kg_per_s,err_A,err_B", rows)
    M, C = np.array([[rho * np.pi * R**3 * 2 / 3]]), np.array([[rho * g * np.pi * R * R]])
    free_heave("d", "sphere", make, M, C, [0.03], rho, g, lambda z: C[0, 0] * z**3 / 3 / R**2, "d_sphere_decay.csv",
               "half-immersed sphere, radius 0.15 m, half as dense as water, released at rest at a lift of R/5 = 0.03 m; depth 0.6 m, no side walls")


def free_heave(item, name, make, M, C, lifts, rho, g, more, path, what):
    t, runs, w, both = decay(f"{item} {name}", make, ["heave"], M, C, np.array([1.0]), rho, g)
    x = runs[0][1][:, 0]
    B, Ai = both[0][1], both[0][2]
    cols = []
    for H in lifts:
        _, y, _ = cummins(M, Ai, C, np.array([H]), w, B, 3.0, more=lambda z: more(z))
        cols.append(y[:, 0] / H)
        print(item, name, f"exact buoyancy, lift {H}:", "  ".join(f"{b:+.4f} at {a:.4f}" for a, b in extrema(t, cols[-1])[:4]))
    write(path, [f"Free heave decay: {what}", "set-up: water 998.2 kg/m3, g = 9.82 m/s2; heave over lift",
          HOW.replace("n, 2n, 4n panels, n = 30", "30 and 60 panels") + "; Cummins' equation, time step 2 ms; frequency-domain synthesis agrees within 2e-4",
          "linear: exact linear theory, the same at any lift, error 3e-4 (1 ms); others: with the exact buoyancy of the body at that lift, all else linear (an estimate of what the lift changes; the rest of second order left out)"],
          "t_s,linear," + ",".join(f"exact_buoyancy_{1000 * H:.0f}_mm" for H in lifts), [(t[i], x[i], *(c[i] for c in cols)) for i in range(0, len(t), 5)])


def item_e():
    rho, g, b, h = 998.2, 9.82, 0.3, 0.6
    ws, rows = [5, 7.2, 9.5, inf], []
    for T in (0.0, 0.02):
        make = lambda n: box(b, T, h, n, 0.1)
        A, B, eA, eB = refined(make, ws, ["heave"], rho, g, 30)
        print("e checks: energy, Haskind", checks(make, ws, ["heave"], rho, g, h, 30).ravel())
        for i, w in enumerate(ws):
            o = box_by_modes(b, T, h, w, rho, g, 0.0, 160)["heave", "heave"]
            rows.append((T, w, A[i, 0, 0], B[i, 0, 0], max(eA[i, 0, 0], 1e-4 * A[i, 0, 0]), max(eB[i, 0, 0], 1e-4 * B[i, 0, 0])))
            print("e", *(f"{v:.6g}" for v in rows[-1]), "modes", *(f"{v:.6g}" for v in o))
    write("e_plate.csv", ["Forced heave of a flat plate of breadth 0.3 m at the waterline: added mass A, damping B, per metre",
          "set-up: 2-D, depth 0.6 m, open on both sides, water 998.2 kg/m3, g = 9.82 m/s2; draft 0: a strip in the surface, wet from below; draft 0.02 m: a box of that draft, dry on top. F = -K z - A z'' - B z', K = rho g 0.3 m = 2940.7 N/m2",
          HOW, "error: err_A, err_B; eigenfunction matching (independent) agrees within 1e-4 (3e-4 for draft 0 at infinity); Haskind within 1e-4"], "draft_m,w_rad_per_s,A_kg_per_m,B_kg_per_m_s,err_A,err_B", rows)


def item_f():
    rho, g, R, h = 998.2, 9.82, 0.15, 0.6
    M, C = np.array([[rho * np.pi * R * R / 2]]), np.array([[rho * g * 2 * R]])
    def more(z):                                                  # exact section area below the level, less its linear part
        y = np.clip(z, -R, R)
        return C[0, 0] * z - rho * g * (y * np.sqrt(R * R - y * y) + R * R * np.arcsin(y / R))
    free_heave("f", "disc", lambda n: disc(R, h, n, 0.6), M, C, [0.01, 0.03], rho, g, more, "f_disc_decay.csv",
               "half-immersed disc, D = 0.3 m, half as dense as water, depth 0.6 m, 2-D, open on both sides, released at rest at a lift of 0.03 m or 0.01 m")


if __name__ == "__main__":
    import sys
    for item in sys.argv[1:] or "abcdef":
        globals()[f"item_{item}"]()

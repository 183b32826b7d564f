// What all shaders share. A place has 64 bits, in 2^-40 of the support: the middle 32 are what the pair loop sees. `hi.w` is the index of the particle on the host, boundary particles after the water; `lo.w` the solid.
struct Params {
    n: u32,          // particles, water first
    water: u32,      // water particles
    cells: u32,      // cells of one kind
    most: u32,       // room of a list
    size: vec4<i32>,   // cells along each axis
    origin: vec4<i32>, // where they begin, in 2^-8 of the support
};
struct Place { hi: vec4<i32>, lo: vec4<u32> };
struct Control {
    halt: u32,       // 0: runs; 1: paused; 2: a particle left the valid range; 3: no time step; 4: a list is too short
    rebuild: u32,
    dt: f32,
    span: f32,       // what a Verlet step integrates over
    ticks: u32,      // dt in 2^-24 of the unit of time
    euler: u32,
    time: vec2<u32>, // low and high word, ticks
    end: vec2<u32>,
    stop: vec2<u32>,
    limit: u32,      // the longest step that the host allows, ticks
    steps: u32,
    rebuilds: u32,
    since_euler: u32,
    foldings: f32,
    dt_before: f32,
    passes: u32,
    started: u32,    // whether a Verlet step has a step before
    moved2: atomic<u32>,
    force2: atomic<u32>,
    approach: atomic<u32>,
    fault: atomic<u32>,
    longest: atomic<u32>,
    age: u32,        // force passes since the gradients were corrected
    correct: u32,
    factor: f32,     // part of the step of the water that is taken, after a rollback
    pad: array<u32, 4>,
};
struct Solid {
    origin: Place,           // of its frame; hi.w: 1 if water beside it is not shifted
    centre: Place,           // about which it turns and torques are taken
    rotation: mat3x3<f32>,
    spin: mat3x3<f32>,       // velocity of an arm
    turning: mat3x3<f32>,    // acceleration of an arm
    velocity: vec4<f32>,     // w: 1 of a free solid
    acceleration: vec4<f32>, // w: promptness of its walls
};
const GROUP: u32 = 128u;
const ROW: u32 = 32768u;          // workgroups in a row
const NONE: u32 = 0xffffffffu;
const EXCESS: f32 = 4.6566128730773926e-10f;   // unit of the excess density, 2^-31
fn index(id: vec3<u32>) -> u32 { return id.x + id.y * (ROW * GROUP); }
fn group_index(id: vec3<u32>) -> u32 { return id.x + id.y * ROW; }
fn middle(p: Place) -> vec3<i32> {
    return (p.hi.xyz << vec3<u32>(16u)) | bitcast<vec3<i32>>(p.lo.xyz >> vec3<u32>(16u));
}
// The cell of a place. Two cells span the reach of the lists, so that all neighbours lie within two cells. The two cells at each
// rim stay empty: what lies outside counts to the last cells before them.
fn cell_of(hi: vec4<i32>) -> vec4<i32> {
    return clamp((hi - params.origin) / CELL, vec4<i32>(2), params.size - 3);
}
fn row_at(c: vec4<i32>, line: i32, layer: i32) -> u32 {
    let plane = select(c.z + layer, 0, LAYERS == 0);
    return u32((plane * params.size.y + c.y + line) * params.size.x + c.x - 2);
}
// a − b in 2^-24 of the support.
fn between(a: Place, b: Place) -> vec3<f32> {
    let low = a.lo.xyz - b.lo.xyz;
    let borrow = select(vec3<i32>(0), vec3<i32>(1), a.lo.xyz < b.lo.xyz);
    return vec3<f32>(a.hi.xyz - b.hi.xyz - borrow) * 65536.0f + vec3<f32>(low) / 65536.0f;
}
// A way in 2^-24 of the support, added to a place.
fn moved(was: Place, way: vec3<f32>) -> Place {
    let whole = floor(way);
    let rest = vec3<i32>((way - whole) * 65536.0f);
    let w = vec3<i32>(whole);
    let add_lo = bitcast<vec3<u32>>((w << vec3<u32>(16u)) | rest);
    let lo = was.lo.xyz + add_lo;
    let carry = select(vec3<i32>(0), vec3<i32>(1), lo < add_lo);
    return Place(vec4<i32>(was.hi.xyz + (w >> vec3<u32>(16u)) + carry, was.hi.w), vec4<u32>(lo, was.lo.w));
}
const VERLET: bool = false;
const RELAXED: bool = true;
const LAYERS: i32 = 2;
const CELL: i32 = 141;
const GAPS: bool = false;
const SUMS: u32 = 4u;
const REACH2: f32 = 281474980000000.0f;
const LOOK2: f32 = 340584730000000.0f;
const MARGIN2: u32 = 1394836274u;
const KEPT_ROWS: u32 = 0u;
const CORRECT_EVERY: u32 = 20u;
const MOVING: u32 = 0u;
const CHUNKS: u32 = 23u;
const GRAVITY: vec3<f32> = vec3<f32>(0.0f, 0.0f, -20971.52f);
const SMOOTHING: f32 = 8388608.0f;
const SOUND: f32 = 8388608.0f;
const COURANT: f32 = 0.4f;
const LONGEST: f32 = 0.9f;
const PER_CROSSING: f32 = 1.0f;
const EULER_EVERY: u32 = 1u;
const FOLDINGS: f32 = 3.5f;
const GROWTH: f32 = 0.0f;
const FASTEST2: u32 = 1434451968u;
const LEAST: i32 = -1073741824;
const MOST: i32 = 1073741824;
const DOMAIN_MIN: vec3<i32> = vec3<i32>(-2176, -2176, -2176);
const DOMAIN_MAX: vec3<i32> = vec3<i32>(3200, 2518, 2656);
// The sums over pairs. Every particle adds up its own neighbours, in the order of its list.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<uniform> first: vec4<u32>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> list: array<u32>;
@group(0) @binding(6) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read_write> sums: array<f32>;
@group(0) @binding(8) var<storage, read_write> walls: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read> places: array<Place>;
@group(0) @binding(10) var<storage, read> solids: array<Solid>;
@group(0) @binding(11) var<storage, read> depths: array<vec2<f32>>;
@group(0) @binding(12) var<storage, read_write> aways: array<vec4<f32>>;
@group(0) @binding(13) var<storage, read> rows: array<f32>;

var<workgroup> most_force: atomic<u32>;
var<workgroup> most_approach: atomic<u32>;

@compute @workgroup_size(128)
fn sweep_water(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let local = index(id);
    let k = first.x + local;
    if (control.halt == 0u && local < first.y && k < params.water) {
        let position = positions[k];
        let velocity = velocities[k];
        let a_compression = f32(position.w) * EXCESS;
        let a_volume = 1.0f / (1.0f + a_compression);
        let a_pressure = velocity.w;
        let span = min(spans[k], vec2<u32>(params.most));
        var approach = 0.0f;
        var sum0 = 0.0f;
        var sum1 = 0.0f;
        var sum2 = 0.0f;
        var sum3 = 0.0f;
        for (var m = 0u; m < span.x; m++) {
            let j = list[m * first.y + local];
            let other = positions[j];
            let other_velocity = velocities[j];
            let r = vec3<f32>(position.xyz - other.xyz);
            let v = velocity.xyz - other_velocity.xyz;
            let difference = f32(other.w - position.w) * EXCESS;
            let b_compression = f32(other.w) * EXCESS;
            let b_volume = 1.0f / (1.0f + b_compression);
            let b_pressure = other_velocity.w;
            let t6 = r.x * r.x;
            let t7 = fma(r.y, r.y, t6);
            let t8 = fma(r.z, r.z, t7);
            let t23 = sqrt(t8);
            let t26 = fma(t23, (-5.9604645e-8f), 1.0f);
            let t27 = max(0.0f, t26);
            let t29 = t27 * t27;
            let t30 = (-8.790164e-15f) * t29;
            let t31 = t27 * t30;
            let t39 = r.x * v.x;
            let t40 = fma(r.y, v.y, t39);
            let t41 = fma(r.z, v.z, t40);
            let t42 = t8 + 703687400000.0f;
            let t43 = a_compression + b_compression;
            let t45 = t43 + 2.0f;
            let t46 = t42 * t45;
            let t47 = 1.0f / t46;
            let t48 = t45 * t47;
            let t50 = a_pressure + b_pressure;
            let t51 = -t50;
            let t52 = a_volume * b_volume;
            let t53 = t51 * t52;
            let t54 = min(0.0f, t41);
            let t55 = t54 * t54;
            let t56 = t48 * t55;
            let t58 = t56 * 3.0f;
            let t60 = min(t58, 70368744000000.0f);
            let t61 = t53 - t60;
            let t62 = t31 * t61;
            let t63 = r.x * t62;
            let t64 = r.y * t62;
            let t65 = r.z * t62;
            let t66 = a_compression + 1.0f;
            let t67 = b_volume * t66;
            let t68 = t41 * t67;
            let t73 = r.z * (-2.9802322e-10f);
            let t75 = fma(t43, (-2.5f), 1.0f);
            let t77 = fma(t73, t75, difference);
            let t78 = 14073749000000.0f * t77;
            let t79 = -t78;
            let t80 = fma(b_volume, t79, t68);
            let t82 = abs(t41);
            let t83 = t48 * t82;
            let t84 = select(0.0f, t83, t8 < 281474980000000.0f);
            let t85 = sum0 + t63;
            let t87 = sum1 + t64;
            let t89 = sum2 + t65;
            let t91 = fma(t31, t80, sum3);
            let t94 = max(t84, approach);
            let out_approach = t94;
            let out_sum0 = t85;
            let out_sum1 = t87;
            let out_sum2 = t89;
            let out_sum3 = t91;
            approach = out_approach;
            sum0 = out_sum0;
            sum1 = out_sum1;
            sum2 = out_sum2;
            sum3 = out_sum3;
        }
        for (var m = span.x; m < span.y; m++) {
            let j = list[m * first.y + local];
            let other = positions[j];
            let other_velocity = velocities[j];
            let r = vec3<f32>(position.xyz - other.xyz);
            let v = velocity.xyz - other_velocity.xyz;
            let difference = f32(other.w - position.w) * EXCESS;
            let b_compression = f32(other.w) * EXCESS;
            let b_volume = 1.0f / (1.0f + b_compression);
            let b_pressure = other_velocity.w;
            let u6 = r.x * r.x;
            let u7 = fma(r.y, r.y, u6);
            let u8 = fma(r.z, r.z, u7);
            let u23 = sqrt(u8);
            let u26 = fma(u23, (-5.9604645e-8f), 1.0f);
            let u27 = max(0.0f, u26);
            let u29 = u27 * u27;
            let u30 = (-8.790164e-15f) * u29;
            let u31 = u27 * u30;
            let u39 = r.x * v.x;
            let u40 = fma(r.y, v.y, u39);
            let u41 = fma(r.z, v.z, u40);
            let u42 = u8 + 703687400000.0f;
            let u43 = a_compression + b_compression;
            let u45 = u43 + 2.0f;
            let u46 = u42 * u45;
            let u47 = 1.0f / u46;
            let u48 = u45 * u47;
            let u50 = a_pressure + b_pressure;
            let u51 = -u50;
            let u52 = a_volume * b_volume;
            let u53 = u51 * u52;
            let u55 = fma(u8, (-5.684342e-14f), 1.0f);
            let u56 = max(0.0f, u55);
            let u57 = u56 * u56;
            let u59 = fma(u57, (-764172460000000.0f), u53);
            let u63 = u31 * u59;
            let u64 = r.x * u63;
            let u65 = r.y * u63;
            let u66 = r.z * u63;
            let u67 = a_compression + 1.0f;
            let u68 = b_volume * u67;
            let u69 = u41 * u68;
            let u73 = abs(u41);
            let u74 = u48 * u73;
            let u75 = select(0.0f, u74, u8 < 281474980000000.0f);
            let u76 = sum0 + u64;
            let u78 = sum1 + u65;
            let u80 = sum2 + u66;
            let u82 = fma(u31, u69, sum3);
            let u85 = max(u75, approach);
            let out_approach = u85;
            let out_sum0 = u76;
            let out_sum1 = u78;
            let out_sum2 = u80;
            let out_sum3 = u82;
            approach = out_approach;
            sum0 = out_sum0;
            sum1 = out_sum1;
            sum2 = out_sum2;
            sum3 = out_sum3;
        }
        sums[0u * params.n + k] = sum0;
        sums[1u * params.n + k] = sum1;
        sums[2u * params.n + k] = sum2;
        sums[3u * params.n + k] = sum3;
        let force = vec3<f32>(sum0, sum1, sum2) + GRAVITY;
        atomicMax(&most_force, bitcast<u32>(dot(force, force)));
        atomicMax(&most_approach, bitcast<u32>(approach));
    }
    workgroupBarrier();
    if (l == 0u) {
        atomicMax(&control.force2, atomicLoad(&most_force));
        atomicMax(&control.approach, atomicLoad(&most_approach));
    }
}

@compute @workgroup_size(128)
fn sweep_boundary(@builtin(global_invocation_id) id: vec3<u32>) {
    let local = index(id);
    let k = first.x + local;
    if (control.halt != 0u || local >= first.y || k < params.water || k >= params.n) { return; }
    let end = min(spans[k].x, params.most);
    if (end > 0u) {
        let position = positions[k];
        let velocity = velocities[k];
        let a_compression = f32(position.w) * EXCESS;
        let a_volume = 1.0f / (1.0f + a_compression);
        let a_pressure = velocity.w;
        var approach = 0.0f;
        var sum0 = 0.0f;
        var sum1 = 0.0f;
        var sum2 = 0.0f;
        var sum3 = 0.0f;
        var fit0 = 0.0f;
        var fit1 = 0.0f;
        var fit2 = 0.0f;
        var fit3 = 0.0f;
        var fit4 = 0.0f;
        var fit5 = 0.0f;
        var fit6 = 0.0f;
        var fit7 = 0.0f;
        for (var m = 0u; m < end; m++) {
            let j = list[m * first.y + local];
            let other = positions[j];
            let other_velocity = velocities[j];
            let r = vec3<f32>(position.xyz - other.xyz);
            let v = velocity.xyz - other_velocity.xyz;
            let difference = f32(other.w - position.w) * EXCESS;
            let b_compression = f32(other.w) * EXCESS;
            let b_volume = 1.0f / (1.0f + b_compression);
            let b_pressure = other_velocity.w;
            {
            let u6 = r.x * r.x;
            let u7 = fma(r.y, r.y, u6);
            let u8 = fma(r.z, r.z, u7);
            let u23 = sqrt(u8);
            let u26 = fma(u23, (-5.9604645e-8f), 1.0f);
            let u27 = max(0.0f, u26);
            let u29 = u27 * u27;
            let u30 = (-8.790164e-15f) * u29;
            let u31 = u27 * u30;
            let u39 = r.x * v.x;
            let u40 = fma(r.y, v.y, u39);
            let u41 = fma(r.z, v.z, u40);
            let u42 = u8 + 703687400000.0f;
            let u43 = a_compression + b_compression;
            let u45 = u43 + 2.0f;
            let u46 = u42 * u45;
            let u47 = 1.0f / u46;
            let u48 = u45 * u47;
            let u50 = a_pressure + b_pressure;
            let u51 = -u50;
            let u52 = a_volume * b_volume;
            let u53 = u51 * u52;
            let u55 = fma(u8, (-5.684342e-14f), 1.0f);
            let u56 = max(0.0f, u55);
            let u57 = u56 * u56;
            let u59 = fma(u57, (-764172460000000.0f), u53);
            let u63 = u31 * u59;
            let u64 = r.x * u63;
            let u65 = r.y * u63;
            let u66 = r.z * u63;
            let u67 = a_compression + 1.0f;
            let u68 = b_volume * u67;
            let u69 = u41 * u68;
            let u73 = abs(u41);
            let u74 = u48 * u73;
            let u75 = select(0.0f, u74, u8 < 281474980000000.0f);
            let u76 = sum0 + u64;
            let u78 = sum1 + u65;
            let u80 = sum2 + u66;
            let u82 = fma(u31, u69, sum3);
            let u85 = max(u75, approach);
            let out_approach = u85;
            let out_sum0 = u76;
            let out_sum1 = u78;
            let out_sum2 = u80;
            let out_sum3 = u82;
            approach = out_approach;
            sum0 = out_sum0;
            sum1 = out_sum1;
            sum2 = out_sum2;
            sum3 = out_sum3;
            }
            {
            let f3 = r.x * r.x;
            let f4 = fma(r.y, r.y, f3);
            let f5 = fma(r.z, r.z, f4);
            let f6 = sqrt(f5);
            let f9 = fma(f6, (-5.9604645e-8f), 1.0f);
            let f11 = max(f9, 0.0f);
            let f12 = f11 * f11;
            let f14 = f12 * f12;
            let f15 = 0.123710565f * f14;
            let f18 = fma(f11, (-4.0f), 5.0f);
            let f19 = f15 * f18;
            let f30 = f19 * b_volume;
            let f31 = fit0 + f30;
            let f32 = fma(b_pressure, f30, fit1);
            let f33 = fma(r.x, f19, fit2);
            let f34 = fma(r.y, f19, fit3);
            let f35 = fma(r.z, f19, fit4);
            let f39 = fma(f30, other_velocity.x, fit5);
            let f40 = fma(f30, other_velocity.y, fit6);
            let f41 = fma(f30, other_velocity.z, fit7);
            let out_sum0 = f31;
            let out_sum1 = f32;
            let out_sum2 = f33;
            let out_sum3 = f34;
            let out_sum4 = f35;
            let out_sum5 = f39;
            let out_sum6 = f40;
            let out_sum7 = f41;
            fit0 = out_sum0;
            fit1 = out_sum1;
            fit2 = out_sum2;
            fit3 = out_sum3;
            fit4 = out_sum4;
            fit5 = out_sum5;
            fit6 = out_sum6;
            fit7 = out_sum7;
            }
        }
        sums[0u * params.n + k] = sum0;
        sums[1u * params.n + k] = sum1;
        sums[2u * params.n + k] = sum2;
        sums[3u * params.n + k] = sum3;
        let solid = solids[places[k].lo.w];
        let arm = between(places[k], solid.centre);
        let pull = GRAVITY - (solid.acceleration.xyz + solid.turning * arm);
        let promptness = solid.acceleration.w;
        let constants = depths[places[k].hi.w - i32(params.water)];
        let depth = constants.x;
        let full_weight = constants.y;
        let own = a_compression;
        let w15 = fit2 * fit2;
        let w16 = fma(fit3, fit3, w15);
        let w17 = fma(fit4, fit4, w16);
        let w20 = select(1.0f, w17, 0.0f < w17);
        let w21 = sqrt(w20);
        let w22 = fit2 / w21;
        let w23 = fit3 / w21;
        let w24 = fit4 / w21;
        let w25 = GRAVITY.x * w22;
        let w26 = fma(GRAVITY.y, w23, w25);
        let w27 = fma(GRAVITY.z, w24, w26);
        let w28 = depth * w27;
        let w29 = min(0.0f, w28);
        let w30 = fit2 * pull.x;
        let w31 = fma(fit3, pull.y, w30);
        let w32 = fma(fit4, pull.z, w31);
        let w33 = fit1 + w32;
        let w35 = select(fit0, 1.0f, fit0 < 1e-9f);
        let w36 = w33 / w35;
        let w37 = max(w29, w36);
        let w38 = select(w37, 0.0f, fit0 < 1e-9f);
        let w40 = fit0 / full_weight;
        let w42 = w38 * 1.4210855e-14f;
        let w44 = max(w42, (-0.12f));
        let w45 = 1.0f + w44;
        let w46 = w45 * w45;
        let w47 = w45 * w46;
        let w49 = w44 + 7.0f;
        let w51 = fma(w44, w49, 21.0f);
        let w53 = fma(w44, w51, 35.0f);
        let w54 = fma(w44, w53, 35.0f);
        let w55 = fma(w44, w54, 21.0f);
        let w56 = fma(w44, w55, 7.0f);
        let w58 = w44 * 0.14285715f;
        let w59 = w56 * w58;
        let w60 = w59 - w44;
        let w61 = w47 * w47;
        let w62 = w60 / w61;
        let w63 = w44 - w62;
        let w64 = 1.0f + w63;
        let w65 = w64 * w64;
        let w66 = w64 * w65;
        let w67 = 7.0f + w63;
        let w68 = fma(w63, w67, 21.0f);
        let w69 = fma(w63, w68, 35.0f);
        let w70 = fma(w63, w69, 35.0f);
        let w71 = fma(w63, w70, 21.0f);
        let w72 = fma(w63, w71, 7.0f);
        let w73 = 0.14285715f * w63;
        let w74 = w72 * w73;
        let w75 = w74 - w44;
        let w76 = w66 * w66;
        let w77 = w75 / w76;
        let w78 = w63 - w77;
        let w79 = 1.0f + w78;
        let w80 = w79 * w79;
        let w81 = w79 * w80;
        let w82 = 7.0f + w78;
        let w83 = fma(w78, w82, 21.0f);
        let w84 = fma(w78, w83, 35.0f);
        let w85 = fma(w78, w84, 35.0f);
        let w86 = fma(w78, w85, 21.0f);
        let w87 = fma(w78, w86, 7.0f);
        let w88 = 0.14285715f * w78;
        let w89 = w87 * w88;
        let w90 = w89 - w44;
        let w91 = w81 * w81;
        let w92 = w90 / w91;
        let w93 = w78 - w92;
        let w94 = 1.0f + w93;
        let w95 = w94 * w94;
        let w96 = w94 * w95;
        let w97 = 7.0f + w93;
        let w98 = fma(w93, w97, 21.0f);
        let w99 = fma(w93, w98, 35.0f);
        let w100 = fma(w93, w99, 35.0f);
        let w101 = fma(w93, w100, 21.0f);
        let w102 = fma(w93, w101, 7.0f);
        let w103 = 0.14285715f * w93;
        let w104 = w102 * w103;
        let w105 = w104 - w44;
        let w106 = w96 * w96;
        let w107 = w105 / w106;
        let w108 = w93 - w107;
        let w114 = fit5 / w35;
        let w115 = w114 - velocity.x;
        let w116 = fit6 / w35;
        let w117 = w116 - velocity.y;
        let w118 = fit7 / w35;
        let w119 = w118 - velocity.z;
        let w120 = w22 * w115;
        let w121 = fma(w23, w117, w120);
        let w122 = fma(w24, w119, w121);
        let w123 = max(0.0f, w122);
        let w124 = select(w123, 0.0f, fit0 < 1e-9f);
        let w126 = w124 / 8388608.0f;
        let w129 = w126 / 0.01f;
        let w130 = 2.0f - w129;
        let w131 = max(0.0f, w130);
        let w132 = min(1.0f, w131);
        let w134 = select(w132, 0.0f, 1.3f < w40);
        let w135 = promptness * w134;
        let w136 = w108 - own;
        let w137 = max(0.0f, w136);
        let w138 = w137 / 1.0f;
        let w140 = w138 / 0.0002f;
        let w141 = 2.0f - w140;
        let w142 = max(0.0f, w141);
        let w143 = min(1.0f, w142);
        let w145 = w40 - 0.8f;
        let w147 = w145 / 0.2f;
        let w148 = max(0.0f, w147);
        let w149 = min(1.0f, w148);
        let w150 = w149 * w149;
        let w152 = 2.0f * w149;
        let w153 = 3.0f - w152;
        let w154 = w150 * w153;
        let w155 = w135 * w143;
        let w156 = select(w22, 0.0f, fit0 < 1e-9f);
        let w157 = select(w23, 0.0f, fit0 < 1e-9f);
        let w158 = select(w24, 0.0f, fit0 < 1e-9f);
        let out_density = w108;
        let out_increase = w154;
        let out_prompt_decrease = w135;
        let out_prompt_increase = w155;
        let out_away0 = w156;
        let out_away1 = w157;
        let out_away2 = w158;
        walls[k - params.water] = vec4<f32>(out_density, out_increase, out_prompt_decrease, out_prompt_increase);
        if (GAPS) { aways[k - params.water] = vec4<f32>(out_away0, out_away1, out_away2, 0.0f); }
    }
}

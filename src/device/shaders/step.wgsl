// The length of a step, and the schemes. The state at the start of a step is in `places` and `motion` (velocity, excess density);
// `positions` and `velocities` hold what the pair loop reads: place and excess density, velocity and pressure.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> places: array<Place>;
@group(0) @binding(3) var<storage, read_write> motion: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> before: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> positions: array<vec4<i32>>;
@group(0) @binding(6) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> sums: array<f32>;
@group(0) @binding(8) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(9) var<storage, read> walls: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> built: array<vec4<i32>>;
@group(0) @binding(11) var<storage, read_write> slot: array<u32>;

const TICKS: f32 = 16777216.0f;

fn pressure(x: f32) -> f32 {
{{PRESSURE}}    return out_pressure;
}

// The change of a boundary particle of excess density `own`, by which it relaxes to its target.
fn wall_change(wall: vec4<f32>, own: f32, relaxation: f32) -> f32 {
{{CHANGE}}    return out_change;
}

// Whether a list is too short.
fn lacks_room() -> bool {
    return atomicLoad(&control.longest) > params.most || atomicLoad(&control.longest_of_boundary) > params.most_of_boundary;
}

fn acceleration(k: u32) -> vec3<f32> { return vec3<f32>({{FORCE}}) + gravity(); }

fn compression_rate(k: u32) -> f32 { return sums[{{RATE}}u * params.n + k]; }

// How a particle is shifted in a step `dt`.
fn shift(k: u32, speed: f32, dt: f32) -> vec3<f32> {
{{SHIFT}}}

// What sponge layers leave of a velocity in a step `dt`.
fn kept(place: Place, dt: f32) -> f32 {
    var rate = 0.0f;
{{SPONGE}}    return exp(-rate * dt);
}

// An excess density, or the change of one, as a whole number. A change beyond 0.4 stays there: no guard allows it.
fn whole(x: f32) -> i32 { return i32(round(clamp(x, -0.4f, 0.4f) * 2147483648.0f)); }

var<workgroup> furthest: atomic<u32>;

// Places a water particle, and makes what the pair loop reads of it.
fn set_water(k: u32, place: Place, v: vec3<f32>, excess: i32) {
    places[k] = place;
    positions[k] = vec4<i32>(middle(place), excess);
    velocities[k] = vec4<f32>(v, pressure(f32(excess) * EXCESS));
    let way = vec3<f32>(positions[k].xyz - built[k].xyz);
    atomicMax(&furthest, bitcast<u32>(dot(way, way)));
}

// What the pair loop reads of the density of a boundary particle.
fn set_boundary(k: u32, excess: i32) {
    positions[k].w = excess;
    velocities[k].w = pressure(f32(excess) * EXCESS);
}

// What the pair loop reads of a state that the host has written.
@compute @workgroup_size(128)
fn derive(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = index(id);
    if (k >= params.n) { return; }
    let x = bitcast<i32>(motion[k].w);
    positions[k] = vec4<i32>(middle(places[k]), x);
    velocities[k] = vec4<f32>(motion[k].xyz, pressure(f32(x) * EXCESS));
    built[k] = positions[k];
    slot[u32(places[k].hi.w)] = k;
}

// The step that the water allows, no longer than the host allows and not past the end.
@compute @workgroup_size(1)
fn limit() {
    if (control.halt != 0u) { return; }
    let force2 = atomicLoad(&control.force2);
    let approach = atomicLoad(&control.approach);
    if (lacks_room()) {
        control.halt = 4u;
        return;
    }
    let force = sqrt(bitcast<f32>(force2));
    let by_force = select(1e30f, sqrt(SMOOTHING / force), force > 0.0f);
    let by_sound = SMOOTHING / (SOUND + SMOOTHING * bitcast<f32>(approach));
    let allowed = min(COURANT * control.factor * min(by_force, by_sound), LONGEST);
    var ticks = min(u32(allowed * TICKS), control.limit);
    if (force2 >= 0x7f800000u || approach >= 0x7f800000u || ticks == 0u) {
        control.halt = 3u;
        return;
    }
    let left = vec2<u32>(control.end.x - control.time.x,
        control.end.y - control.time.y - select(0u, 1u, control.end.x < control.time.x));
    if (left.y == 0u && left.x <= ticks) {
        ticks = left.x;
    } else if (left.y == 0u) {
        // The last two steps have equal lengths.
        ticks = min(ticks, left.x / 2u);
    }
    if (ticks == 0u) {
        control.halt = 1u;
        return;
    }
    control.ticks = ticks;
    control.dt = f32(ticks) / TICKS;
    let euler = control.started == 0u || control.since_euler >= EULER_EVERY || control.foldings > FOLDINGS;
    if (euler) {
        control.since_euler = 0u;
        control.foldings = 0.0f;
    }
    control.euler = select(0u, 1u, euler);
    control.span = control.dt + select(control.dt_before, 0.0f, euler);
}

// The excess density of a boundary particle after `dt`, of which continuity alone makes `bare`.
fn relax(k: u32, bare: i32, dt: f32) -> i32 {
    if (!RELAXED) { return max(bare, 0); }
    let wall = walls[k - params.water];
    let own = max(bare, min(whole(wall.x), 0));
    return own + whole(wall_change(wall, f32(own) * EXCESS, 1.0f - exp(-dt / RELAXATION_TIME)));
}

@compute @workgroup_size(128)
fn first_half(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = index(id);
    if (control.halt == 0u && k < params.n && (k < params.water || spans[k].y > 0u)) {
        let step = 0.5f * control.dt;
        let start = motion[k];
        let bare = bitcast<i32>(start.w) + whole(compression_rate(k) * step);
        if (k < params.water) {
            set_water(k, moved(places[k], start.xyz * step), start.xyz + acceleration(k) * step, bare);
        } else {
            set_boundary(k, relax(k, bare, step));
        }
    }
    workgroupBarrier();
    if (l == 0u) { atomicMax(&control.moved2, atomicLoad(&furthest)); }
}

fn guard(k: u32, place: Place, v: vec3<f32>, x: i32) {
    // Whatever is not finite is greater, as whole numbers.
    let fast = bitcast<u32>(dot(v, v)) > FASTEST2;
    let outside = any(place.hi.xyz < DOMAIN_MIN) || any(place.hi.xyz > DOMAIN_MAX);
    if (REMOVES && outside) { atomicStore(&control.outside, 1u); }
    if (fast || x < LEAST || x > MOST || (outside && !REMOVES)) { atomicMin(&control.fault, u32(place.hi.w)); }
}

@compute @workgroup_size(128)
fn whole_step(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = index(id);
    let runs = control.halt == 0u && !lacks_room();
    if (runs && k < params.n && (k < params.water || spans[k].y > 0u)) {
        let start = motion[k];
        let start_excess = bitcast<i32>(start.w);
        // ρ (2 − ε)/(2 + ε) is ρ less 2 ε/(2 + ε) ρ.
        let epsilon = -control.dt * compression_rate(k) / (1.0f + f32(positions[k].w) * EXCESS);
        let bare = start_excess
            + whole(-2.0f * epsilon / (2.0f + epsilon) * (1.0f + f32(start_excess) * EXCESS));
        if (k < params.water) {
            let undamped = start.xyz + acceleration(k) * control.dt;
            let way = undamped * (0.5f * control.dt) + shift(k, length(velocities[k].xyz), control.dt);
            let place = moved(places[k], way);
            let v = undamped * kept(place, control.dt);
            motion[k] = vec4<f32>(v, bitcast<f32>(bare));
            set_water(k, place, v, bare);
            guard(k, place, v, bare);
        } else {
            let x = relax(k, bare, control.dt);
            motion[k].w = bitcast<f32>(x);
            set_boundary(k, x);
        }
    }
    workgroupBarrier();
    if (l == 0u) { atomicMax(&control.moved2, atomicLoad(&furthest)); }
}

@compute @workgroup_size(128)
fn verlet(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = index(id);
    if (control.halt == 0u && k < params.n && (k < params.water || spans[k].y > 0u)) {
        let dt = control.dt;
        let now = motion[k];
        let from_ = select(before[k], now, control.euler != 0u);
        before[k] = now;
        let bare = bitcast<i32>(from_.w) + whole(compression_rate(k) * control.span);
        if (k < params.water) {
            let a = acceleration(k);
            let way = now.xyz * dt + a * (0.5f * dt * dt) + shift(k, length(now.xyz), dt);
            let place = moved(places[k], way);
            let left = kept(place, dt);
            let v = (from_.xyz + a * control.span) * left;
            before[k] = vec4<f32>(now.xyz * left, now.w);
            motion[k] = vec4<f32>(v, bitcast<f32>(bare));
            set_water(k, place, v, bare);
            guard(k, place, v, bare);
        } else {
            let x = relax(k, bare, control.span);
            motion[k].w = bitcast<f32>(x);
            set_boundary(k, x);
        }
    }
    workgroupBarrier();
    if (l == 0u) { atomicMax(&control.moved2, atomicLoad(&furthest)); }
}

// Counts the step, and halts where the host waits.
@compute @workgroup_size(1)
fn finish() {
    if (control.halt != 0u) { return; }
    if (lacks_room()) {
        control.halt = 4u;
        return;
    }
    let low = control.time.x + control.ticks;
    control.time = vec2<u32>(low, control.time.y + select(0u, 1u, low < control.ticks));
    control.steps += 1u;
    control.started = 1u;
    control.since_euler += 1u;
    control.foldings += GROWTH * control.dt;
    control.dt_before = control.dt;
    let later = control.time.y > control.stop.y || (control.time.y == control.stop.y && control.time.x >= control.stop.x);
    if (later) { control.halt = 1u; }
    if (REMOVES) {
        // Water beyond the domain is removed when the lists are made anew, or were.
        let renewed = control.renewed != 0u || atomicLoad(&control.moved2) >= MARGIN2;
        if (renewed && atomicLoad(&control.outside) != 0u) { control.halt = 5u; }
        control.renewed = 0u;
        atomicStore(&control.outside, 0u);
    }
    if (atomicLoad(&control.fault) != NONE) { control.halt = 2u; }
}

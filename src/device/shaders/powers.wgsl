// The powers of the equations' terms on the water: `coupling/power_breakdown.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> places: array<Place>;
@group(0) @binding(3) var<storage, read> motion: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> sums: array<f32>;
@group(0) @binding(7) var<storage, read_write> parts: array<vec4<f32>>;

// How a particle is shifted in a step `dt`.
fn shift(k: u32, speed: f32, dt: f32) -> vec3<f32> {
{{SHIFT}}}

// What sponge layers leave of a velocity in a step `dt`.
fn kept(place: Place, dt: f32) -> f32 {
    var rate = 0.0f;
{{SPONGE}}    return exp(-rate * dt);
}

// Nothing acts on a boundary particle without water, which has no sums over pairs.
@compute @workgroup_size(128)
fn clear_sums(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = index(id);
    if (k >= params.n) { return; }
    for (var row = 0u; row <= {{RATE}}u; row++) { sums[row * params.n + k] = 0.0f; }
}

var<workgroup> part: array<vec4<f32>, 128>;

// Adds up what 128 water particles contribute, in a fixed tree.
fn add_up(group: vec3<u32>, l: u32, mine: vec4<f32>) {
    part[l] = mine;
    for (var step = 64u; step > 0u; step /= 2u) {
        workgroupBarrier();
        if (l < step) { part[l] += part[l + step]; }
    }
    workgroupBarrier();
    let chunk = group_index(group);
    if (l == 0u && chunk * GROUP < params.water) { parts[chunk] = part[0]; }
}

// The powers on the motion of the water, without its weight, and on its compression, by the sums over pairs.
@compute @workgroup_size(128)
fn add_gains(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = group_index(group) * GROUP + l;
    var mine = vec4<f32>(0.0f);
    if (k < params.water) {
        let volume = 1.0f / (1.0f + f32(positions[k].w) * EXCESS);
        let motion_gain = dot(velocities[k].xyz, vec3<f32>({{FORCE}}));
        mine = vec4<f32>(motion_gain, velocities[k].w * volume * volume * sums[{{RATE}}u * params.n + k], 0.0f, 0.0f);
    }
    add_up(group, l, mine);
}

// The velocities of the water in a force pass.
@compute @workgroup_size(128)
fn add_flow(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = group_index(group) * GROUP + l;
    var mine = vec4<f32>(0.0f);
    if (k < params.water) { mine = vec4<f32>(velocities[k].xyz, 0.0f); }
    add_up(group, l, mine);
}

// The ways by which the water is shifted.
@compute @workgroup_size(128)
fn add_shifts(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = group_index(group) * GROUP + l;
    var mine = vec4<f32>(0.0f);
    if (k < params.water) { mine = vec4<f32>(shift(k, length(velocities[k].xyz), control.dt), 0.0f); }
    add_up(group, l, mine);
}

// The kinetic energies that sponge layers absorb, after the step.
@compute @workgroup_size(128)
fn add_absorbed(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = group_index(group) * GROUP + l;
    var mine = vec4<f32>(0.0f);
    if (k < params.water) {
        let left = kept(places[k], control.dt);
        let v = motion[k].xyz;
        mine.x = 0.5f * dot(v, v) * ((1.0f - left) * (1.0f + left) / (left * left));
    }
    add_up(group, l, mine);
}

// The places of the water.
@compute @workgroup_size(128)
fn add_places(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let k = group_index(group) * GROUP + l;
    var mine = vec4<f32>(0.0f);
    if (k < params.water) {
        mine = vec4<f32>(between(places[k], Place(vec4<i32>(0), vec4<u32>(0u))), 0.0f);
    }
    add_up(group, l, mine);
}

// Images of the water across periodic sides, and the copies of solids that pass through them: `system/periodic.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> places: array<Place>;
@group(0) @binding(3) var<storage, read_write> motion: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> positions: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> start: array<u32>;
@group(0) @binding(7) var<storage, read> order: array<u32>;
@group(0) @binding(8) var<storage, read> slot: array<u32>;
@group(0) @binding(9) var<storage, read_write> rows: array<f32>;
// First copy of a boundary particle, particles of a copy, copies; or its mirror image, itself, the way to the image, and 1.
@group(0) @binding(10) var<storage, read> copied: array<vec4<u32>>;
@group(0) @binding(11) var<storage, read_write> flow: array<vec4<f32>>;

// The image with the thread `id`, if there is one; else NONE.
fn image(id: vec3<u32>) -> u32 {
    let k = params.n + index(id);
    return select(k, NONE, control.halt != 0u || k >= start[KINDS * params.cells]);
}

// Gives each image the state of its original.
@compute @workgroup_size(128)
fn place_images(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = image(id);
    if (k == NONE) { return; }
    let own = slot[order[k] / WAYS];
    let way = order[k] % WAYS;
    positions[k] = vec4<i32>(middle(away(places[own], way)), positions[own].w);
    velocities[k] = vec4<f32>(reflected(velocities[own].xyz, way), velocities[own].w);
}

// Gives each image the additional inputs of its original.
@compute @workgroup_size(128)
fn copy_rows(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = image(id);
    if (k == NONE) { return; }
    let own = slot[order[k] / WAYS];
    let way = order[k] % WAYS;
    for (var row = 0u; row < ROWS; row++) {
        rows[row * params.slots + k] = row_sign(row, way) * rows[row * params.slots + own];
    }
}

// Gives the copies of each boundary particle the density of the copy between the sides, and its mirror image its own.
@compute @workgroup_size(128)
fn update_copies(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = index(id);
    if (control.halt != 0u || i >= arrayLength(&copied)) { return; }
    let own = copied[i];
    if (own.w != 0u) {
        let j = slot[params.water + own.x];
        let k = slot[params.water + own.y];
        positions[j].w = positions[k].w;
        velocities[j].w = velocities[k].w;
        motion[j].w = motion[k].w;
{{MIRRORED_SLIP}}        return;
    }
    for (var copy = 0u; copy < own.z; copy++) {
        let k = slot[params.water + own.x + copy * own.y];
        if (!is_between_sides(places[k])) { continue; }
        for (var other = 0u; other < own.z; other++) {
            let j = slot[params.water + own.x + other * own.y];
            positions[j].w = positions[k].w;
            velocities[j].w = velocities[k].w;
            motion[j].w = motion[k].w;
{{SLIP}}        }
        return;
    }
}

var<workgroup> part: array<vec3<f32>, 128>;

// The sums of the velocities of 128 water particles each, in a fixed tree.
@compute @workgroup_size(128)
fn add_velocities(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let chunk = group_index(group);
    let k = chunk * GROUP + l;
    var mine = vec3<f32>(0.0f);
    if (k < params.water) { mine = velocities[k].xyz; }
    part[l] = mine;
    for (var step = 64u; step > 0u; step /= 2u) {
        workgroupBarrier();
        if (l < step) { part[l] += part[l + step]; }
    }
    workgroupBarrier();
    if (l == 0u && k < params.water) { flow[chunk] = vec4<f32>(part[0], 0.0f); }
}

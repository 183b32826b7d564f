// Boundary particles follow their solids, and the loads are added up.
struct Load { force: vec4<f32>, torque: vec4<f32> };
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> places: array<Place>;
@group(0) @binding(3) var<storage, read_write> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> motion: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> slot: array<u32>;
@group(0) @binding(7) var<storage, read> built: array<vec4<i32>>;
@group(0) @binding(8) var<storage, read> solids: array<Solid>;
@group(0) @binding(9) var<storage, read> local_positions: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read> chunks: array<u32>;
@group(0) @binding(11) var<storage, read> sums: array<f32>;
@group(0) @binding(12) var<storage, read_write> loads: array<Load>;

var<workgroup> furthest: atomic<u32>;

// Places the boundary particles of solids that move; `chunks` has them first.
@compute @workgroup_size(128)
fn place_moving(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let i = index(id);
    if (control.halt == 0u && i < MOVING && chunks[i] != NONE) {
        let b = chunks[i];
        let k = slot[params.water + b];
        let own = places[k];
        let solid = solids[own.lo.w];
        var place = moved(solid.origin, solid.rotation * local_positions[b].xyz);
        place.hi.w = own.hi.w;
        place.lo.w = own.lo.w;
        places[k] = place;
        let v = solid.velocity.xyz + solid.spin * between(place, solid.centre);
        positions[k] = vec4<i32>(middle(place), positions[k].w);
        velocities[k] = vec4<f32>(v, velocities[k].w);
        motion[k] = vec4<f32>(v, motion[k].w);
        let way = vec3<f32>(positions[k].xyz - built[k].xyz);
        atomicMax(&furthest, bitcast<u32>(dot(way, way)));
    }
    workgroupBarrier();
    if (l == 0u) { atomicMax(&control.moved2, atomicLoad(&furthest)); }
}

var<workgroup> part: array<Load, 128>;

// Force and torque on each chunk of 128 boundary particles of a solid, in a fixed tree.
@compute @workgroup_size(128)
fn add_loads(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let chunk = group_index(group);
    var mine = Load(vec4<f32>(0.0f), vec4<f32>(0.0f));
    if (chunk < CHUNKS) {
        let b = chunks[chunk * GROUP + l];
        if (b != NONE) {
            let k = slot[params.water + b];
            let place = places[k];
            // Beyond a periodic side the water is an image, and its load has been counted.
            if (!PERIODIC || is_between_sides(place)) {
                let arm = between(place, solids[place.lo.w].centre);
                let force = vec3<f32>({{FORCE}});
                mine = Load(vec4<f32>(force, 0.0f), vec4<f32>(cross(arm, force), 0.0f));
            }
        }
    }
    part[l] = mine;
    for (var step = 64u; step > 0u; step /= 2u) {
        workgroupBarrier();
        if (l < step) {
            part[l].force += part[l + step].force;
            part[l].torque += part[l + step].torque;
        }
    }
    workgroupBarrier();
    if (l == 0u && chunk < CHUNKS) { loads[chunk] = part[0]; }
}

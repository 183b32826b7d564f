// What the host reads of the water near places of its own and of the water around boundary particles, and what it adds to velocities.
struct Range { low: vec4<i32>, high: vec4<i32> };
struct Particle { place: Place, motion: vec4<f32> };
struct Change { velocity: vec3<f32>, particle: u32 };
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> places: array<Place>;
@group(0) @binding(3) var<storage, read_write> motion: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> before: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> slot: array<u32>;
@group(0) @binding(7) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read> aways: array<vec4<f32>>;
// The first is around all others; its low.w is their number.
@group(0) @binding(9) var<storage, read> ranges: array<Range>;
@group(0) @binding(10) var<storage, read_write> near: array<Particle>;
@group(0) @binding(11) var<storage, read> watched: array<u32>;
@group(0) @binding(12) var<storage, read_write> weights: array<f32>;
@group(0) @binding(13) var<storage, read> changes: array<Change>;
{{SUMS}}
fn holds(range: Range, hi: vec4<i32>) -> bool {
    return all(hi.xyz >= range.low.xyz) && all(hi.xyz <= range.high.xyz);
}

// Lists the water particles in the ranges, in any order: the host sorts them by their index there.
@compute @workgroup_size(128)
fn find_near(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = index(id);
    if (k >= params.water) { return; }
    let place = places[k];
    if (!holds(ranges[0], place.hi)) { return; }
    for (var n = 1; n <= ranges[0].low.w; n++) {
        if (holds(ranges[n], place.hi)) {
            let at = atomicAdd(&control.found, 1u);
            if (at < arrayLength(&near)) { near[at] = Particle(place, motion[k]); }
            return;
        }
    }
}

// The weights of the water around the boundary particles that the host watches, from the last force pass; then the weighted sums of the
// ways from this water to them, if the host reads them.
@compute @workgroup_size(128)
fn weigh(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = index(id);
    if (i >= arrayLength(&watched) || watched[i] == NONE) { return; }
    let k = slot[params.water + watched[i]];
    weights[i] = select(0.0f, aways[k - params.water].w, spans[k].x > 0u);
{{OFFSETS}}}

// Adds to the velocities of water particles; none comes twice.
@compute @workgroup_size(128)
fn change_velocities(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = index(id);
    if (i >= arrayLength(&changes) || changes[i].particle == NONE) { return; }
    let k = slot[changes[i].particle];
    let more = changes[i].velocity;
    motion[k] = vec4<f32>(motion[k].xyz + more, motion[k].w);
    velocities[k] = vec4<f32>(velocities[k].xyz + more, velocities[k].w);
    if (VERLET) { before[k] = vec4<f32>(before[k].xyz + more, before[k].w); }
}

// The neighbour lists: of each particle the water, then the boundary particles, within the reach of the lists. Boundary particles
// have water alone. Entry m of the k-th particle of a part is at m · part + k.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
// The first particle of the part, for how many there is room, the room of a list, and the particle after the part.
@group(0) @binding(2) var<uniform> first: vec4<u32>;
@group(0) @binding(3) var<storage, read> places: array<Place>;
@group(0) @binding(4) var<storage, read_write> positions: array<vec4<i32>>;
@group(0) @binding(5) var<storage, read> start: array<u32>;
@group(0) @binding(6) var<storage, read_write> list: array<u32>;
@group(0) @binding(7) var<storage, read_write> spans: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read_write> motion: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> velocities: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> sums: array<f32>;
@group(0) @binding(11) var<storage, read_write> before: array<vec4<f32>>;

@compute @workgroup_size(128)
fn list_pairs(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let local = index(id);
    let k = first.x + local;
    if (k >= first.w) { return; }
    let x = positions[k].xyz;
    let is_water = k < params.water;
    let c = cell_of(places[k].hi);
    var m = 0u;
    var middle = 0u;
    for (var turn = 0u; turn < select(KINDS - 1u, KINDS, is_water); turn++) {
        // The images follow the water.
        let kind = select(turn, (3u - turn) % 3u, PERIODIC);
        for (var layer = -LAYERS; layer <= LAYERS; layer++) {
            for (var line = -2; line <= 2; line++) {
                let row = row_at(c, line, layer) + kind * params.cells;
                let end = start[row + 5u];
                for (var j = start[row]; j < end; j++) {
                    let r = vec3<f32>(x - positions[j].xyz);
                    if (dot(r, r) < LOOK2 && j != k) {
                        if (m < first.z) { list[m * first.y + local] = j; }
                        m++;
                    }
                }
            }
        }
        middle = select(middle, m, turn == KINDS - 2u);
    }
    spans[k] = vec2<u32>(middle, m);
    if (is_water) { atomicMax(&control.longest, m); } else { atomicMax(&control.longest_of_boundary, m); }
    if (!is_water && m == 0u) {
        // A boundary particle without water rests at the reference density, and nothing acts on it.
        positions[k].w = 0;
        velocities[k].w = 0.0f;
        motion[k].w = bitcast<f32>(0i);
        if (VERLET) { before[k].w = bitcast<f32>(0i); }
        for (var row = 0u; row < SUMS; row++) { sums[row * params.n + k] = 0.0f; }
    }
}

// Pressure across the water in narrow gaps between a free solid and another: `system/gap_pressure.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> places: array<Place>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> start: array<u32>;
@group(0) @binding(6) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read> solids: array<Solid>;
@group(0) @binding(8) var<storage, read_write> gaps: array<u32>;
@group(0) @binding(9) var<storage, read> aways: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> sums: array<f32>;
@group(0) @binding(11) var<storage, read> built: array<vec4<i32>>;

fn slope(r2: f32) -> f32 {
{{SLOPE}}    return out_slope;
}

fn faces(a: u32, b: u32) -> bool {
    return {{APART}} && (solids[a].velocity.w + solids[b].velocity.w) > 0.5f;
}

fn gate(x: f32) -> f32 { return clamp(x, 0.0f, 1.0f); }

// Marks the boundary particles that may come within the support of one of another solid before the next lists.
@compute @workgroup_size(128)
fn find_gaps(@builtin(global_invocation_id) id: vec3<u32>) {
    if (control.rebuild == 0u) { return; }
    let k = params.water + index(id);
    if (k >= params.n) { return; }
    var found = 0u;
    if (spans[k].x > 0u) {
        let x = positions[k].xyz;
        let own = places[k].lo.w;
        let c = cell_of(places[k].hi);
        for (var layer = -LAYERS; layer <= LAYERS; layer++) {
            for (var line = -2; line <= 2; line++) {
                let row = row_at(c, line, layer) + params.cells;
                for (var j = start[row]; j < start[row + 5u]; j++) {
                    let r = vec3<f32>(x - positions[j].xyz);
                    if (dot(r, r) < LOOK2 && faces(own, places[j].lo.w)) { found = 1u; }
                }
            }
        }
    }
    gaps[k - params.water] = found;
}

@compute @workgroup_size(128)
fn add_gaps(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = params.water + index(id);
    if (control.halt != 0u || k >= params.n || gaps[k - params.water] == 0u) { return; }
    let x = positions[k].xyz;
    let away = aways[k - params.water].xyz;
    let own = places[k].lo.w;
    // The lists hold by the places at which they were built: so do the cells.
    let c = gap_cell(k);
    var sum = vec3<f32>(0.0f);
    for (var layer = -LAYERS; layer <= LAYERS; layer++) {
        for (var line = -2; line <= 2; line++) {
            let row = row_at(c, line, layer) + params.cells;
            for (var j = start[row]; j < start[row + 5u]; j++) {
                if (spans[j].x == 0u || !faces(own, places[j].lo.w)) { continue; }
                let arm = vec3<f32>(x - positions[j].xyz);
                let r2 = dot(arm, arm);
                if (r2 >= REACH2 || r2 == 0.0f) { continue; }
                let e = arm / sqrt(r2);
                let other = aways[j - params.water].xyz;
                let through = gate(3.0f * dot(away, e)) * gate(-3.0f * dot(other, e));
                let across = through * gate(-3.0f * dot(away, other));
                sum -= arm * ((velocities[k].w + velocities[j].w) * across * slope(r2));
            }
        }
    }
{{ADD}}}

// The cell of a boundary particle at the last lists. Of its place then the middle 32 bits are known, and it was near.
fn gap_cell(k: u32) -> vec4<i32> {
    let way = (built[k].xyz >> vec3<u32>(16u)) - (middle(places[k]) >> vec3<u32>(16u));
    // Whole numbers of 16 bits, with their sign.
    let short = (way << vec3<u32>(16u)) >> vec3<u32>(16u);
    return cell_of(vec4<i32>(places[k].hi.xyz + short, 0));
}

// Additional inputs of the pair loop: marks that suppress shifting, tensile repulsion, stress, corrected gradients.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> places: array<Place>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> rows: array<f32>;
@group(0) @binding(6) var<storage, read> sums: array<f32>;
@group(0) @binding(7) var<storage, read> solids: array<Solid>;

// Before the sums: what follows from the state.
@compute @workgroup_size(128)
fn fill_rows(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = index(id);
    if (control.halt != 0u || k >= params.n) { return; }
    let compression = f32(positions[k].w) * EXCESS;
    let volume = 1.0f / (1.0f + compression);
    let p = velocities[k].w;
{{FILL}}}

// After the sums: the stress of the water.
@compute @workgroup_size(128)
fn close_stress(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = index(id);
    if (control.halt != 0u || k >= params.water) { return; }
    let volume = 1.0f / (1.0f + f32(positions[k].w) * EXCESS);
{{STRESS}}}

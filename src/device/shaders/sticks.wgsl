// The velocities past their solids with which boundary particles act on water that sticks to faces: `sph/boundary/slip.rs`.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<uniform> first: vec4<u32>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> list: array<u32>;
@group(0) @binding(6) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read> places: array<Place>;
@group(0) @binding(8) var<storage, read> solids: array<Solid>;
@group(0) @binding(9) var<storage, read> depths: array<vec2<f32>>;
// Outward normals of the faces before boundary particles, in the frames of their solids.
@group(0) @binding(10) var<storage, read> normals: array<vec4<f32>>;
@group(0) @binding(11) var<storage, read_write> slips: array<vec4<f32>>;

@compute @workgroup_size(128)
fn find_slips(@builtin(global_invocation_id) id: vec3<u32>) {
    let local = index(id);
    let k = first.x + local;
    if (control.halt != 0u || k >= first.w) { return; }
    let position = positions[k];
    let velocity = velocities[k];
{{ZERO_FIT}}    let end = min(spans[k].x, first.z);
    for (var m = 0u; m < end; m++) {
        let j = list[m * first.y + local];
        let other = positions[j];
        let other_velocity = velocities[j];
        let r = vec3<f32>(position.xyz - other.xyz);
        let b_volume = 1.0f / (1.0f + f32(other.w) * EXCESS);
{{FIT}}    }
    let own = places[k];
    let b = own.hi.w - i32(params.water);
    let normal = solids[own.lo.w].rotation * normals[b].xyz;
    let depth = depths[b].x;
{{SLIP}}    slips[k - params.water] = -vec4<f32>(out_past0, out_past1, out_past2, 0.0f);
}

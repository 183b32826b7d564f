// Corrected gradients: the moments of the neighbours, and the corrections that follow from them.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<uniform> first: vec4<u32>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> list: array<u32>;
@group(0) @binding(6) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read_write> rows: array<f32>;

@compute @workgroup_size(128)
fn sweep_moments(@builtin(global_invocation_id) id: vec3<u32>) {
    let local = index(id);
    let k = first.x + local;
    if (control.halt != 0u || control.correct == 0u || k >= first.w) { return; }
    let position = positions[k];
    let velocity = velocities[k];
    let span = min(spans[k], vec2<u32>(first.z));
{{ZERO_SUMS}}    for (var m = 0u; m < span.y; m++) {
        let j = list[m * first.y + local];
        let other = positions[j];
        let r = vec3<f32>(position.xyz - other.xyz);
{{MOMENT}}    }
    let p = velocity.w;
{{CLOSE}}}

// The sums over pairs. Every particle adds up its own neighbours, in the order of its list.
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<uniform> first: vec4<u32>;
@group(0) @binding(3) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> velocities: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> list: array<u32>;
@group(0) @binding(6) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read_write> sums: array<f32>;
@group(0) @binding(8) var<storage, read_write> walls: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read> places: array<Place>;
@group(0) @binding(10) var<storage, read> solids: array<Solid>;
@group(0) @binding(11) var<storage, read> depths: array<vec2<f32>>;
@group(0) @binding(12) var<storage, read_write> aways: array<vec4<f32>>;
@group(0) @binding(13) var<storage, read> rows: array<f32>;

var<workgroup> most_force: atomic<u32>;
var<workgroup> most_approach: atomic<u32>;

@compute @workgroup_size(128)
fn sweep_water(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) l: u32) {
    let local = index(id);
    let k = first.x + local;
    if (control.halt == 0u && k < first.w) {
        let position = positions[k];
        let velocity = velocities[k];
        let a_compression = f32(position.w) * EXCESS;
        let a_volume = 1.0f / (1.0f + a_compression);
        let a_pressure = velocity.w;
        let span = min(spans[k], vec2<u32>(first.z));
        let slope = density_slope();
        var approach = 0.0f;
{{ZERO_SUMS}}        for (var m = 0u; m < span.x; m++) {
{{NEIGHBOUR}}{{FLUID}}        }
        for (var m = span.x; m < span.y; m++) {
{{NEIGHBOUR}}{{WALL}}        }
{{STORE}}        let force = vec3<f32>({{FORCE}}) + gravity();
        atomicMax(&most_force, bitcast<u32>(dot(force, force)));
        atomicMax(&most_approach, bitcast<u32>(approach));
    }
    workgroupBarrier();
    if (l == 0u) {
        atomicMax(&control.force2, atomicLoad(&most_force));
        atomicMax(&control.approach, atomicLoad(&most_approach));
    }
}

@compute @workgroup_size(128)
fn sweep_boundary(@builtin(global_invocation_id) id: vec3<u32>) {
    let local = index(id);
    let k = first.x + local;
    if (control.halt != 0u || k >= first.w) { return; }
    let end = min(spans[k].x, first.z);
    if (end > 0u) {
        let position = positions[k];
        let velocity = velocities[k];
        let a_compression = f32(position.w) * EXCESS;
        let a_volume = 1.0f / (1.0f + a_compression);
        let a_pressure = velocity.w;
        let slope = density_slope();
        var approach = 0.0f;
{{ZERO_SUMS}}{{ZERO_FIT}}        for (var m = 0u; m < end; m++) {
{{NEIGHBOUR}}{{BESIDE}}        }
{{STORE}}{{TARGET}}    }
}

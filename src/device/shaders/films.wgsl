// What the host reads of the boundary particles of films after a force pass: `system/film.rs`.
struct BoundaryWater {
    acceleration: vec4<f32>, // w: the excess density at the pressure that is extrapolated from the water
    away: vec4<f32>,         // unit vector from the water to the particle; w: 1 if water is near
};
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> slot: array<u32>;
@group(0) @binding(3) var<storage, read> spans: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> sums: array<f32>;
@group(0) @binding(5) var<storage, read> walls: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> aways: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> particles: array<u32>;
@group(0) @binding(8) var<storage, read_write> readings: array<BoundaryWater>;

@compute @workgroup_size(128)
fn read_boundary(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = index(id);
    if (i >= arrayLength(&particles) || particles[i] == NONE) { return; }
    let k = slot[params.water + particles[i]];
    let b = k - params.water;
    let is_near = select(0.0f, 1.0f, spans[k].x > 0u);
    readings[i] = BoundaryWater(vec4<f32>({{FORCE}}, walls[b].x), vec4<f32>(aways[b].xyz, is_near));
}

// What all shaders share. A place has 64 bits, in 2^-40 of the support: the upper 24 are the cell, the middle 32 are what the pair
// loop sees. `hi.w` is the index of the particle on the host, boundary particles after the water; `lo.w` the solid.
struct Params {
    n: u32,          // particles, water first
    water: u32,      // water particles
    cells: u32,      // cells of one kind
    most: u32,       // room of a list
    size: vec4<i32>,
    origin: vec4<i32>,
};
struct Place { hi: vec4<i32>, lo: vec4<u32> };
struct Control {
    halt: u32,       // 0: runs; 1: paused; 2: a particle left the valid range; 3: no time step; 4: a list is too short
    rebuild: u32,
    dt: f32,
    span: f32,       // what a Verlet step integrates over
    ticks: u32,      // dt in 2^-24 of the unit of time
    euler: u32,
    time: vec2<u32>, // low and high word, ticks
    end: vec2<u32>,
    stop: vec2<u32>,
    limit: u32,      // the longest step that the host allows, ticks
    steps: u32,
    rebuilds: u32,
    since_euler: u32,
    foldings: f32,
    dt_before: f32,
    passes: u32,
    started: u32,    // whether a Verlet step has a step before
    moved2: atomic<u32>,
    force2: atomic<u32>,
    approach: atomic<u32>,
    fault: atomic<u32>,
    longest: atomic<u32>,
    pad: array<u32, 7>,
};
const GROUP: u32 = 128u;
const ROW: u32 = 32768u;          // workgroups in a row
const NONE: u32 = 0xffffffffu;
const EXCESS: f32 = 4.6566128730773926e-10f;   // unit of the excess density, 2^-31
fn index(id: vec3<u32>) -> u32 { return id.x + id.y * (ROW * GROUP); }
fn group_index(id: vec3<u32>) -> u32 { return id.x + id.y * ROW; }
fn middle(p: Place) -> vec3<i32> {
    return (p.hi.xyz << vec3<u32>(16u)) | bitcast<vec3<i32>>(p.lo.xyz >> vec3<u32>(16u));
}

// What all shaders share. A place has 64 bits, in 2^-40 of the support: the middle 32 are what the pair loop sees. `hi.w` is the
// index of the particle on the host, boundary particles after the water; `lo.w` the solid.
struct Params {
    n: u32,          // particles, water first
    water: u32,      // water particles
    cells: u32,      // cells of one kind
    most: u32,       // room of a list of a water particle
    size: vec4<i32>,   // cells along each axis
    origin: vec4<i32>, // where they begin, in 2^-8 of the support
    slots: u32,      // particles and room for the images across periodic sides
    most_of_boundary: u32, // room of a list of a boundary particle
};
struct Place { hi: vec4<i32>, lo: vec4<u32> };
struct Control {
    halt: u32,       // 0: runs; 1: paused; 2: a particle left the valid range; 3: no time step; 4: a list is too short; 5: water is to be removed
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
    age: u32,        // force passes since the gradients were corrected
    correct: u32,
    factor: f32,     // part of the step of the water that is taken, after a rollback
    found: atomic<u32>,   // water particles that the host asked for
    outside: atomic<u32>, // whether water has left the domain in this step
    renewed: u32,         // whether there were new lists in this step
    longest_of_boundary: atomic<u32>,
    pad: u32,
    gravity: vec4<f32>,   // where it changes
};
struct Solid {
    origin: Place,           // of its frame; hi.w: 1 if water beside it is not shifted
    centre: Place,           // about which it turns and torques are taken; hi.w: number of the solid, and of its images beyond planes
    rotation: mat3x3<f32>,
    spin: mat3x3<f32>,       // velocity of an arm
    turning: mat3x3<f32>,    // acceleration of an arm
    velocity: vec4<f32>,     // w: 1 of a free solid
    acceleration: vec4<f32>, // w: promptness of its walls
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
// The cell of a place. Two cells span the reach of the lists, so that all neighbours lie within two cells. The two cells at each
// rim stay empty: what lies outside counts to the last cells before them.
fn cell_of(hi: vec4<i32>) -> vec4<i32> {
    return clamp((hi - params.origin) / CELL, vec4<i32>(2), params.size - 3);
}
fn row_at(c: vec4<i32>, line: i32, layer: i32) -> u32 {
    let plane = select(c.z + layer, 0, LAYERS == 0);
    return u32((plane * params.size.y + c.y + line) * params.size.x + c.x - 2);
}
// a − b in 2^-24 of the support.
fn between(a: Place, b: Place) -> vec3<f32> {
    let low = a.lo.xyz - b.lo.xyz;
    let borrow = select(vec3<i32>(0), vec3<i32>(1), a.lo.xyz < b.lo.xyz);
    return vec3<f32>(a.hi.xyz - b.hi.xyz - borrow) * 65536.0f + vec3<f32>(low) / 65536.0f;
}
// A way in 2^-24 of the support, added to a place.
fn moved(was: Place, way: vec3<f32>) -> Place {
    let whole = floor(way);
    let rest = vec3<i32>((way - whole) * 65536.0f);
    let w = vec3<i32>(whole);
    let add_lo = bitcast<vec3<u32>>((w << vec3<u32>(16u)) | rest);
    let lo = was.lo.xyz + add_lo;
    let carry = select(vec3<i32>(0), vec3<i32>(1), lo < add_lo);
    return Place(vec4<i32>(was.hi.xyz + (w >> vec3<u32>(16u)) + carry, was.hi.w), vec4<u32>(lo, was.lo.w));
}

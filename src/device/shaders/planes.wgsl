// Symmetry planes. A way is a number of three bits: the axes along which an image is reflected.
const WAYS: u32 = 8u;
const REFLECTS: bool = true;
fn flips(way: u32) -> vec3<bool> { return (vec3<u32>(way) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u); }
fn below(a: vec3<i32>, a_lo: vec3<u32>, b: Place) -> vec3<bool> {
    return (a < b.hi.xyz) | ((a == b.hi.xyz) & (a_lo < b.lo.xyz));
}
// The image of a place by a way.
fn away(place: Place, way: u32) -> Place {
    let is_flipped = flips(way);
    let lo = TWICE_PLANES.lo.xyz - place.lo.xyz;
    let borrow = select(vec3<i32>(0), vec3<i32>(1), TWICE_PLANES.lo.xyz < place.lo.xyz);
    let hi = TWICE_PLANES.hi.xyz - place.hi.xyz - borrow;
    return Place(vec4<i32>(select(place.hi.xyz, hi, is_flipped), place.hi.w),
        vec4<u32>(select(place.lo.xyz, lo, is_flipped), place.lo.w));
}
fn is_between_sides(place: Place) -> bool { return true; }
// The way by which a place beyond planes comes to the computed side.
fn way_in(place: Place) -> u32 {
    let up = UPPER & below(place.hi.xyz, place.lo.xyz, PLANES);
    let down = LOWER & below(PLANES.hi.xyz, PLANES.lo.xyz, place);
    return dot(vec3<u32>(up | down), vec3<u32>(1u, 2u, 4u));
}
// Whether a place on the computed side has an image by a way.
fn has_image(place: Place, way: u32) -> bool {
    let near = (UPPER & (place.hi.xyz < PLANES.hi.xyz + WIDTH)) | (LOWER & (place.hi.xyz >= PLANES.hi.xyz - WIDTH));
    return way != 0u && all(near | !flips(way));
}
// A vector of an image by a way.
fn reflected(v: vec3<f32>, way: u32) -> vec3<f32> { return select(v, -v, flips(way)); }

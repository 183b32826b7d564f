// Periodic sides and symmetry planes. A way is a number of three digits to the base 3, one for each axis: 0 none, 1 one period on or
// reflected, 2 one period back.
const WAYS: u32 = 27u;
fn digits(way: u32) -> vec3<u32> { return vec3<u32>(way % 3u, way / 3u % 3u, way / 9u); }
fn way_of(first: vec3<bool>, second: vec3<bool>) -> u32 {
    return dot(vec3<u32>(first) + 2u * vec3<u32>(second), vec3<u32>(1u, 3u, 9u));
}
fn flips(way: u32) -> vec3<bool> { return (UPPER | LOWER) & (digits(way) == vec3<u32>(1u)); }
fn below(a: vec3<i32>, a_lo: vec3<u32>, b: Place) -> vec3<bool> {
    return (a < b.hi.xyz) | ((a == b.hi.xyz) & (a_lo < b.lo.xyz));
}
// A place moved by a way.
fn away(place: Place, way: u32) -> Place {
    let d = digits(way);
    let hi = select(select(vec3<i32>(0), PERIOD.hi.xyz, d == vec3<u32>(1u)), MINUS_PERIOD.hi.xyz, d == vec3<u32>(2u));
    let lo = select(select(vec3<u32>(0u), PERIOD.lo.xyz, d == vec3<u32>(1u)), MINUS_PERIOD.lo.xyz, d == vec3<u32>(2u));
    let sum = place.lo.xyz + lo;
    let carry = select(vec3<i32>(0), vec3<i32>(1), sum < lo);
    let borrow = select(vec3<i32>(0), vec3<i32>(1), TWICE_PLANES.lo.xyz < place.lo.xyz);
    let is_flipped = flips(way);
    return Place(
        vec4<i32>(select(place.hi.xyz + hi + carry, TWICE_PLANES.hi.xyz - place.hi.xyz - borrow, is_flipped), place.hi.w),
        vec4<u32>(select(sum, TWICE_PLANES.lo.xyz - place.lo.xyz, is_flipped), place.lo.w));
}
// Whether a place is between the periodic sides.
fn is_between_sides(place: Place) -> bool {
    let outside = below(place.hi.xyz, place.lo.xyz, FROM) | !below(place.hi.xyz, place.lo.xyz, TO);
    return !any(outside & AXES);
}
// The way by which a place that has left through a side comes in at the other, and one beyond planes comes to the computed side.
fn way_in(place: Place) -> u32 {
    let on = AXES & below(place.hi.xyz, place.lo.xyz, FROM);
    let back = AXES & !below(place.hi.xyz, place.lo.xyz, TO);
    let up = UPPER & below(place.hi.xyz, place.lo.xyz, PLANES);
    let down = LOWER & below(PLANES.hi.xyz, PLANES.lo.xyz, place);
    return way_of(on | up | down, back);
}
// Whether a place between the sides, on the computed side of planes, has an image by a way.
fn has_image(place: Place, way: u32) -> bool {
    let d = digits(way);
    let near_plane = (UPPER & (place.hi.xyz < PLANES.hi.xyz + WIDTH)) | (LOWER & (place.hi.xyz >= PLANES.hi.xyz - WIDTH));
    let low = near_plane | (AXES & (place.hi.xyz < FROM.hi.xyz + WIDTH));
    let high = AXES & (place.hi.xyz >= TO.hi.xyz - WIDTH);
    return way != 0u && all((low | (d != vec3<u32>(1u))) & (high | (d != vec3<u32>(2u))));
}
// A vector of an image by a way.
fn reflected(v: vec3<f32>, way: u32) -> vec3<f32> { return select(v, -v, flips(way)); }

// Periodic sides. A way is a number of three digits to the base 3, the periods along each axis: 0 none, 1 one, 2 minus one.
const WAYS: u32 = 27u;
const REFLECTS: bool = false;
fn digits(way: u32) -> vec3<u32> { return vec3<u32>(way % 3u, way / 3u % 3u, way / 9u); }
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
    return Place(vec4<i32>(place.hi.xyz + hi + carry, place.hi.w), vec4<u32>(sum, place.lo.w));
}
fn is_between_sides(place: Place) -> bool {
    let outside = below(place.hi.xyz, place.lo.xyz, FROM) | !below(place.hi.xyz, place.lo.xyz, TO);
    return !any(outside & AXES);
}
// The way by which a place that has left through a side comes in at the other.
fn way_in(place: Place) -> u32 {
    let up = vec3<u32>(AXES & below(place.hi.xyz, place.lo.xyz, FROM));
    let down = vec3<u32>(AXES & !below(place.hi.xyz, place.lo.xyz, TO));
    return dot(up + 2u * down, vec3<u32>(1u, 3u, 9u));
}
// Whether a place between the sides has an image by a way.
fn has_image(place: Place, way: u32) -> bool {
    let d = digits(way);
    let low = AXES & (place.hi.xyz < FROM.hi.xyz + WIDTH);
    let high = AXES & (place.hi.xyz >= TO.hi.xyz - WIDTH);
    return way != 0u && all((low | (d != vec3<u32>(1u))) & (high | (d != vec3<u32>(2u))));
}
// A vector of an image by a way: that of its original.
fn reflected(v: vec3<f32>, way: u32) -> vec3<f32> { return v; }

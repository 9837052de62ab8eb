//! provides  shadow: how much of the sun a point of the ground sees past the ground sunward of it
//! hook      visibility
//! reads     vsm.moments (vsm.cpp draws it): mean [m], above vsm_rise's zero, and variance [m^2] of the
//!           height of the ground that the sun's rays meet first
//! writes    factor
//! source    W. Donnelly, A. Lauritzen, Variance Shadow Maps, I3D 2006

//@ include lib/surface.glsl

uniform int vsm_size = 2048;      //@ range(256, 8192) unit(px) label("Size of a map") description("Texels along each side")
uniform int vsm_maps = 3;         //@ range(1, 3) label("Maps") description("Largest number of maps: one of all visible ground, and nearer ones where it is too coarse")
uniform float vsm_blur = 0.08;    //@ range(0, 0.6) label("Blur") description("Weight of a texel's neighbours in each direction")
uniform float vsm_bleed = 0.2;    //@ range(0, 0.9) label("Light bleed cut") description("Light below this value counts as none: reduces light bleeding where shadows overlap")
uniform float vsm_bias = 0.5;     //@ range(0, 4) label("Bias") description("Depth below the map without a shadow, in standard deviations")
uniform float vsm_softness = 0.8; //@ range(0, 8) label("Softness") description("Smallest standard deviation of the heights in a texel, relative to the height of its row")
uniform bool vsm_penumbra = false; //@ static label("Penumbra") description("Penumbra grows with the distance of the occluder, as for the sun's half degree")
uniform float vsm_sun_diameter = 0.533;  //@ range(0, 10) angle unit(deg) label("Sun's diameter")

uniform bool vsm_keep = true;     //@ label("Keep the map") description("Keep maps until the sun or the visible ground changes. Off: drawn for every frame")

uniform vec4 vsm_across = vec4(0.0);   //@ host
uniform vec4 vsm_along = vec4(0.0);    //@ host
uniform vec4 vsm_rise = vec4(0.0);     //@ host
uniform vec4 vsm_nearer = vec4(0.0);   //@ host
uniform vec4 vsm_nearest = vec4(0.0);  //@ host
uniform vec4 vsm_row_m = vec4(0.0);    //@ host description("Height of a row of each map")
uniform vec4 vsm_reach = vec4(0.0);    //@ host
uniform vec4 vsm_texel_m = vec4(0.0);  //@ host description("Horizontal and vertical, of the map of all visible ground")

uniform sampler2DArray vsm_moments;

const float vsm_rounding_m = 1.0;  // deviation that floats, and levels of the ground, make
const float vsm_mesh_px = 2.0;  // by which triangles lie below the ground at most, and their skirt hangs down
const int vsm_taps = 16;

/// Upper bound on the share of the ground in a texel that is no higher than a height.
/// @param moments  mean and variance of the heights
/// source: Chebyshev's one-sided inequality, Donnelly and Lauritzen, equation 5
float vsm_chebyshev(in vec2 moments, in float height) {
    float above = max(moments.x - height, 0.0);
    return moments.y / (moments.y + above * above);
}

/// Cuts off the lower end of the bound, where light bleeds through, and stretches the rest.
/// source: A. Lauritzen, Summed-Area Variance Shadow Maps, GPU Gems 3, 2007, section 8.4.3
float vsm_cut(in float bound, in float bleed) {
    return clamp((bound - bleed) / (1.0 - bleed), 0.0, 1.0);
}

/// The finest map that a point is in.
/// @param first  its place in the first map
/// @returns place in that map, and its number
vec3 vsm_place(in vec2 first) {
    vec3 place = vec3(first, 0.0);
    vec2 at = first * vsm_nearer.xy + vsm_nearer.zw;
    place = at == clamp(at, vec2(0.004), vec2(0.996)) ? vec3(at, 1.0) : place;
    at = first * vsm_nearest.xy + vsm_nearest.zw;
    return at == clamp(at, vec2(0.004), vec2(0.996)) ? vec3(at, 2.0) : place;
}

/// Share of the sun that is seen from a height above a place of a map.
/// @param rough_m  deviation of that height
float vsm_lit(in vec3 place, in float height, in float rough_m) {
    vec2 moments = textureLod(vsm_moments, place, 0.0).rg;
    float row_m = place.z < 0.5 ? vsm_row_m.x : place.z < 1.5 ? vsm_row_m.y : vsm_row_m.z;
    float least = vsm_softness * row_m + rough_m;
    moments.y = max(moments.y, least * least);
    return vsm_cut(vsm_chebyshev(moments, height + vsm_bias * sqrt(moments.y)), vsm_bleed);
}

/// Points evenly over the unit disc, after H. Vogel, Mathematical Biosciences 44, 1979.
vec2 vsm_disc(in int tap) {
    float angle = 2.39996323 * float(tap);
    return sqrt((float(tap) + 0.5) / float(vsm_taps)) * vec2(cos(angle), sin(angle));
}

/// The same over the sun's disc: how much higher the ground in its way lies tells how far it is.
/// source: R. Fernando, Percentage-Closer Soft Shadows, SIGGRAPH 2005 sketches
float vsm_lit_by_disc(in vec2 first, in float height, in float rough_m) {
    float half_sun = tan(0.5 * vsm_sun_diameter);
    // Nothing in the way is farther than where the ray leaves the highest ground behind.
    vec2 search = half_sun * vsm_reach.xy * max(vsm_reach.z - height, 0.0);
    // The receiver's own ground is found too, hardly above it: what is higher counts for more.
    float above = 0.0, squares = 0.0;
    for (int tap = 0; tap < vsm_taps; ++tap) {
        float here = textureLod(vsm_moments, vsm_place(first + search * vsm_disc(tap)), 0.0).r - height;
        above += max(here, 0.0);
        squares += max(here, 0.0) * max(here, 0.0);
    }
    vec2 spread = half_sun * vsm_reach.xy * squares / max(above, 1e-3);
    float lit = 0.0;
    for (int tap = 0; tap < vsm_taps; ++tap)
        lit += vsm_lit(vsm_place(first + spread * vsm_disc(tap)), height, rough_m);
    return lit / float(vsm_taps);
}

void vsm_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    vec4 point = vec4(surface_point(s), 1.0);
    vec2 first = vec2(dot(vsm_across, point), dot(vsm_along, point));
    float height = dot(vsm_rise, point);
    float rough_m = vsm_rounding_m;
#ifdef TERRAIN_NORMAL_VERTEX
    // There is no other ground than the picture's triangles.
    float mesh_m = vsm_mesh_px * length(frame.pixel_ray_dx.xyz) * s.distance_m;
    rough_m += 0.5 * mesh_m;
    height += mesh_m;
#endif
    if (vsm_penumbra)
        factor *= vsm_lit_by_disc(first, height, rough_m);
    else
        factor *= vsm_lit(vsm_place(first), height, rough_m);
}

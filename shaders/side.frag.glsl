//! provides  the light that a cut side of a DEM seen from outside sends to the eye
//! hook      side
//! writes    as terrain.frag.glsl

//@ include lib/exposed.glsl
//@ include lib/finite.glsl
//@ include lib/ground.glsl
//@ include lib/pixel.glsl
//@ include lib/shown.glsl
//@ include lib/tangent.glsl

in vec3 side_position_m;
in float side_height_m;
in float side_ground_m;
in float side_depth;
in vec3 side_outwards;

layout(location = 0) out vec4 light_out;
#ifdef DISPLAY_OVERLAY
layout(location = 1) out vec4 overlay_out;
#endif
#ifdef SURFACE_OUTPUT
layout(location = SURFACE_OUTPUT) out vec4 surface_out;
#endif
#ifdef ALBEDO_OUTPUT
layout(location = ALBEDO_OUTPUT) out vec4 albedo_out;
#endif
#ifdef WALLS_OUTPUT
layout(location = WALLS_OUTPUT) out float walls_out;  // lib/edge_depth.glsl
#endif

void main() {
    Surface s;
    s.position_m = side_position_m;
    s.height_m = side_height_m;
    s.height_unit = height_unit_of(s.height_m);
    s.up = up_at(s.position_m);
    s.ground_m = ground_at(s.position_m, s.up, s.height_m);
    s.anchored_m = ground_anchored_at(s.position_m, s.up, s.height_m);
    s.distance_m = length(s.position_m);
    vec3 across = cross(dFdx(s.position_m), dFdy(s.position_m));
    float area = length(across);
    // A sliver's steps are all one: what faces the eye is as good.
    s.geometric_normal = area > 0.0 ? across / area : -s.position_m / s.distance_m;
    s.geometric_normal *= dot(s.geometric_normal, s.position_m) > 0.0 ? -1.0 : 1.0;
    s.normal = s.ground_normal =
        dot(side_outwards, side_outwards) > 0.25 ? normalize(side_outwards) : s.geometric_normal;
    s.tangent = normalize(cross(s.up, s.normal) + 1e-6 * s.up);
    s.bitangent = cross(s.normal, s.tangent);
    s.ground_dx_m = s.ground_dy_m = vec3(0.0);
    // Of a DEM that lies along the compass; of another one near to it.
    vec2 share = (s.ground_m.xy - frame.ground_extent.xy) * frame.ground_extent.zw;
    s.post = clamp(vec2(share.x, 1.0 - share.y), 0.0, 1.0) * (frame.posts.xy - 1.0);
    s.pixel_posts = max(length(dFdx(s.post)), length(dFdy(s.post)));
    s.texture_at = s.texture_dx = s.texture_dy = vec2(0.0);
    s.height_dx_m = s.height_dy_m = s.dem_step_m = 0.0;
    s.dem_height_m = s.height_m;
    s.above_ground_m = side_height_m - side_ground_m;
    s.gloss = 1.0;
    s.forest = -1.0;
    s.material = ivec2(0);
    s.material_weight = vec2(1.0, 0.0);
    s.diffuse = s.ambient = vec3(0.3);
    s.specular = s.emissive = vec3(0.0);
    s.shininess = 8.0;
    vec3 radiance = hook_side(s, side_depth);
    float numbers = finite(vec4(radiance, 0.0));
    radiance = exposed(radiance);
#ifdef SHOWN
    light_out = shown(pixel_with(s.distance_m), radiance, vec4(0.0), numbers);
#else
    light_out = vec4(radiance, numbers);
#endif
#ifdef DISPLAY_OVERLAY
    overlay_out = vec4(0.0);
#endif
#ifdef SURFACE_OUTPUT
    surface_out = vec4(0.0);
#endif
#ifdef ALBEDO_OUTPUT
    albedo_out = vec4(0.0);
#endif
#ifdef WALLS_OUTPUT
    walls_out = clamp(0.5 + 0.25 * s.normal.x + 0.125 * s.normal.y, 0.1, 1.0);
#endif
}

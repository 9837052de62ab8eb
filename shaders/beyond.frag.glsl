//! provides  the ground that is made up around a DEM seen from the air, in the colours that effects give to ground
//! reads     depth, of the picture
//! writes    radiance, exposed, and 1 where it is seen; each texel is BEYOND_PX pixels wide

//@ include lib/beyond_relief.glsl
//@ include lib/exposed.glsl
//@ include lib/footprint.glsl
//@ include lib/ground.glsl
//@ include lib/pixel.glsl
//@ include lib/tangent.glsl

uniform sampler2D depth;

layout(location = 0) out vec4 beyond_out;

/// Ground at a point, as hooks of `albedo` get it: level, since they would take rough hills for rock.
/// @param ray  of the pixel, at view depth 1
Surface beyond_surface(in vec3 ray, in vec3 position_m, in float distance_m) {
    Surface s;
    s.position_m = position_m;
    s.distance_m = distance_m;
    s.height_m = s.dem_height_m = frame.beyond_m;
    s.height_unit = height_unit_of(s.height_m);
    s.up = s.geometric_normal = s.ground_normal = s.normal = up_at(position_m);
    s.ground_m = ground_at(position_m, s.up, s.height_m);
    s.anchored_m = ground_anchored_at(position_m, s.up, s.height_m);
    s.tangent = tangent_of(s.up);
    s.bitangent = cross(s.up, s.tangent);
    vec3 dx = footprint(position_m, s.up, ray, 0.5 * BEYOND_PX * frame.pixel_ray_dx.xyz);
    vec3 dy = footprint(position_m, s.up, ray, 0.5 * BEYOND_PX * frame.pixel_ray_dy.xyz);
    float longest = max(length(dx), length(dy)), shortest = min(length(dx), length(dy));
    float most = max(shortest * frame.footprint_limit, 1e-6);
    s.ground_dx_m = dx * min(1.0, most / length(dx));
    s.ground_dy_m = dy * min(1.0, most / length(dy));
    s.pixel_posts = min(sqrt(longest * shortest), most) * frame.normal_texels_per_m;
    s.post = surround_post(s.ground_m.xy);
    s.height_dx_m = s.height_dy_m = s.dem_step_m = s.above_ground_m = 0.0;
    s.texture_at = s.ground_m.xy;
    s.texture_dx = s.ground_dx_m.xy;
    s.texture_dy = s.ground_dy_m.xy;
    s.material = ivec2(0);
    s.material_weight = vec2(1.0, 0.0);
    s.diffuse = s.ambient = vec3(0.3);
    s.specular = s.emissive = vec3(0.0);
    s.gloss = 1.0;
    s.forest = -1.0;
    s.shininess = 8.0;
    return s;
}

/// Whether any of the pixels that are drawn from this texel shows no ground.
bool beyond_is_seen(in vec2 at_px) {
    bool seen = false;
    for (int i = 0; i < 9; ++i) {
        vec2 aside = vec2(i % 3 - 1, i / 3 - 1) * (0.9 * BEYOND_PX);
        seen = seen || textureLod(depth, (at_px + aside) * frame.viewport.zw, 0.0).r == 0.0;
    }
    return seen;
}

void main() {
    vec2 at_px = gl_FragCoord.xy * BEYOND_PX;
    if (frame.beyond == 0.0 || !beyond_is_seen(at_px)) discard;
    vec3 ray = pixel_ray_at(at_px), view = normalize(ray);
    float distance_m = beyond_distance_m(view);
    // Texels above the horizon are for pixels just below it.
    if (distance_m < 0.0) distance_m = beyond_horizon_m();
    float pixel = BEYOND_PX * length(frame.pixel_ray_dx.xyz);
    distance_m = beyond_met_m(view, distance_m, pixel * distance_m);
    Surface s = beyond_surface(ray, distance_m * view, distance_m);
    float finest_m = pixel * distance_m * inversesqrt(max(-dot(view, s.up), 0.02));
    float relief_m;
    vec3 normal = beyond_normal(s.ground_m.xy, s.up, finest_m, relief_m);
    s.height_m += 0.6 * max(relief_m, 0.0);  // snow would show how little is known of the highest hills
    s.height_unit = height_unit_of(s.height_m);
    s.geometric_normal = s.ground_normal = s.normal = normal;
    hook_albedo(s);
    beyond_out = vec4(exposed(hook_beyond(s, view)), 1.0);  // halves do not hold the light of a night
}

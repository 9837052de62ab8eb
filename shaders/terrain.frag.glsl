//! provides  the light that a visible point of the terrain sends to the eye
//! reads     gbuffer (geometry.frag.glsl), normal pages
//! writes    with SURFACE_OUTPUT the normal and the visible part of the sun, for passes of plugins;
//!           with ALBEDO_OUTPUT the diffuse colour, linear;
//!           with AUDITED what the point is and how much of the sun is drawn there (render::SunSeen);
//!           with SHOWN colour: sRGB; else radiance, linear, exposed, and overlay, premultiplied sRGB; in
//!           alpha of either 0 where effects made what is no number, or infinite

//@ include lib/overlay.glsl
//@ include lib/exposed.glsl
//@ include lib/filtered.glsl
//@ include lib/finite.glsl
//@ include lib/footprint.glsl
//@ include lib/ground.glsl
//@ include lib/instance_shadows.glsl
//@ include lib/octahedral.glsl
//@ include lib/moved.glsl
//@ include lib/pages.glsl
//@ include lib/pixel.glsl
//@ include lib/shown.glsl
//@ include lib/srgb.glsl
//@ include lib/tangent.glsl

uniform sampler2D height_steps;  // from geometry.frag.glsl, where a hook reads heights that change from pixel to pixel
uniform sampler2D instance_look;  // from instance.frag.glsl, where a plugin has instances
uniform sampler2D ground_place;  // from geometry.frag.glsl, of a map
uniform sampler2DArray normal_pages;  // rg: east and north part of the unit normal

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
#ifdef AUDITED
layout(location = AUDITED) out vec4 audit_out;
#endif

#ifdef ORTHOGRAPHIC
/// The step to the neighbouring pixel of a map on level ground.
/// @param step_m  what it is in the middle of the map
vec3 ground_map_step(in ivec2 pixel, in ivec2 axis, in vec3 here, in vec3 up, in vec3 step_m) {
    ivec2 last = ivec2(frame.viewport.xy) - 1;
    vec4 after = texelFetch(ground_place, min(pixel + axis, last), 0);
    vec4 before = texelFetch(ground_place, max(pixel - axis, ivec2(0)), 0);
    vec3 found = after.a > 0.0 && pixel + axis == min(pixel + axis, last) ? after.xyz - here
                 : before.a > 0.0 && pixel - axis == max(pixel - axis, ivec2(0)) ? here - before.xyz
                                                                                : step_m;
    return found - dot(found, up) * up;
}

/// The same on the plane of the point, which parallel rays meet.
vec3 ground_map_footprint(in vec3 level_m, in vec3 normal, in vec3 up) {
    return level_m - up * (dot(level_m, normal) / max(dot(up, normal), 0.02));
}
#endif

/// East and north part of the normal at a post, as a level of the pyramid has it.
vec2 slope_at(in vec2 post, in int level) {
    PagePlace at = page_place(post, level);
    return filtered(normal_pages, vec3((at.node + 1.5) / kNormalPage_px, float(at.layer))).rg;
}

#ifdef INSTANCES
/// Makes the point that of an instance, which stands on the ground where the light is found.
/// @param sunlight  share of the sun's light that passes instances
/// @returns whether the pixel shows one
bool instance_as_surface(inout Surface s, in ivec2 pixel, inout float sunlight) {
    vec4 look = texelFetch(instance_look, pixel, 0);
    vec4 colour = unpackUnorm4x8(packUnorm2x16(look.rg));
    if (colour.a == 0.0) return false;
    s.normal = normal_from_octahedral(2.0 * look.ba - 1.0);
    s.geometric_normal = s.normal;
    s.diffuse = s.ambient = colour.rgb * colour.rgb;
    s.specular = s.emissive = vec3(0.0);
    sunlight = colour.a;
    return true;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 what = texelFetch(gbuffer, pixel, 0);
    float depth = uintBitsToFloat(what.w);
    vec3 ray = pixel_ray_at(gl_FragCoord.xy);

    Surface s;
#ifdef ORTHOGRAPHIC
    s.position_m = texelFetch(ground_place, pixel, 0).xyz;
#else
    s.position_m = ray * depth;
#endif
    s.height_m = uintBitsToFloat(what.z);
    s.height_unit = height_unit_of(s.height_m);
    s.up = up_at(s.position_m);
    s.ground_m = ground_at(s.position_m, s.up, s.height_m);
    s.anchored_m = ground_anchored_at(s.position_m, s.up, s.height_m);
    s.distance_m = length(s.position_m);
    vec3 east = east_at(s.up);
    vec3 north = cross(s.up, east);

#ifdef ORTHOGRAPHIC
    float pixel_m = sqrt(length(frame.pixel_ray_dx.xyz) * length(frame.pixel_ray_dy.xyz)) * depth;
    float across = pixel_m * frame.normal_texels_per_m;
#else
    float across = length(frame.pixel_ray_dx.xyz) * depth * frame.normal_texels_per_m;
#endif
#ifdef TERRAIN_NORMAL_VERTEX
    s.post = unpackUnorm2x16(what.y) * frame.posts.xy;
    s.geometric_normal = normal_from_octahedral(unpackSnorm2x16(what.x));
    float upright = dot(s.geometric_normal, s.up);
    s.ground_normal =
        normalize(s.geometric_normal + (frame.height_range.z - 1.0) * upright * s.up);
#else
    s.post = uintBitsToFloat(what.xy);
    // A pixel's size on the ground, across the view, decides how fine the normals are read.
    float level = clamp(log2(across), 0.0, frame.normal_levels - 1.0);
    vec2 slope = mix(slope_at(s.post, int(level)),
                     slope_at(s.post, min(int(level) + 1, int(frame.normal_levels) - 1)), fract(level));
    float rise = sqrt(max(1.0 - dot(slope, slope), 0.0025));
    s.ground_normal = normalize(slope.x * east + slope.y * north + rise * s.up);
    slope *= frame.height_range.z;
    s.geometric_normal = normalize(slope.x * east + slope.y * north + rise * s.up);
#endif
    s.tangent = tangent_of(s.geometric_normal);
    s.bitangent = cross(s.geometric_normal, s.tangent);
    s.normal = s.geometric_normal;

#ifdef ORTHOGRAPHIC
    vec3 level_x = ground_map_step(pixel, ivec2(1, 0), s.position_m, s.up, depth * frame.pixel_ray_dx.xyz);
    vec3 level_y = ground_map_step(pixel, ivec2(0, 1), s.position_m, s.up, depth * frame.pixel_ray_dy.xyz);
    vec3 dx = ground_map_footprint(level_x, s.geometric_normal, s.up);
    vec3 dy = ground_map_footprint(level_y, s.geometric_normal, s.up);
#else
    vec3 dx = footprint(s.position_m, s.geometric_normal, ray, frame.pixel_ray_dx.xyz);
    vec3 dy = footprint(s.position_m, s.geometric_normal, ray, frame.pixel_ray_dy.xyz);
#endif
    float longest = max(length(dx), length(dy));
    float shortest = min(length(dx), length(dy));
    float most = max(shortest * frame.footprint_limit, 1e-6);
    s.ground_dx_m = footprint_on_dem(dx * min(1.0, most / length(dx)), s.up);
    s.ground_dy_m = footprint_on_dem(dy * min(1.0, most / length(dy)), s.up);
    // Between the pixel's sides across the view and along it, which a slant makes longer.
    s.pixel_posts = across * sqrt(min(longest / shortest, frame.footprint_limit));
    s.height_dx_m = s.height_dy_m = s.dem_step_m = 0.0;
    s.dem_height_m = s.height_m;
    s.above_ground_m = 0.0;
#ifdef HEIGHT_STEPS
    vec4 steps = texelFetch(height_steps, pixel, 0);
    s.height_dx_m = steps.x;
    s.height_dy_m = steps.y;
    s.dem_height_m = steps.z;
    s.dem_step_m = steps.w;
#endif

    s.texture_at = s.ground_m.xy;
    s.texture_dx = s.ground_dx_m.xy;
    s.texture_dy = s.ground_dy_m.xy;
    s.gloss = 1.0;
    s.forest = -1.0;
    s.material = ivec2(0);
    s.material_weight = vec2(1.0, 0.0);
    s.diffuse = vec3(0.3);
    s.specular = vec3(0.0);
    s.ambient = vec3(0.3);
    s.emissive = vec3(0.0);
    s.shininess = 8.0;

    load_varyings(pixel);
#ifdef OVERLAY_RASTER
    overlay_here = overlay_colour(s.post, across);
    overlay_beneath = vec4(0.0);
#endif
    hook_albedo(s);
    hook_normal(s);
    hook_material(s);
    float sunlight = 1.0;
#ifdef INSTANCES
    bool is_instance = instance_as_surface(s, pixel, sunlight);
#else
    const bool is_instance = false;
#endif
#ifdef INSTANCE_SHADOWS
    sunlight *= instance_sunlight(s.position_m, s.distance_m, is_instance);
#endif

    vec3 to_sun;
    vec3 irradiance = sun_light_at(s.height_m, s.up, to_sun);
#ifdef ORTHOGRAPHIC
    vec3 view = -s.up;
#else
    vec3 view = s.position_m / s.distance_m;
#endif
    float lit = 1.0;
    hook_facing(s, to_sun, lit);
#ifdef AUDITED
    float seen = 1.0;
    hook_visibility(s, to_sun, seen);
    bool faces = dot(s.geometric_normal, to_sun) > 0.0;
    bool is_ground = !is_instance && surface_moved_up_m(s) == 0.0;
    // The audit is of the terrain's shadows: not where instances stand or their shadows lie.
    float audited = !is_ground ? -1.0 : sunlight < 1.0 ? -2.0 : seen;
    audit_out = vec4(s.post, audited, faces ? s.pixel_posts : -s.pixel_posts);
#endif
#ifdef ALBEDO_OUTPUT
    albedo_out = vec4(s.diffuse, 1.0);
#endif
#ifdef SURFACE_OUTPUT
    float visible = 1.0;
    hook_visibility(s, to_sun, visible);
    surface_out = vec4(s.normal, visible * sunlight);
#endif
    hook_visibility(s, to_sun, lit);
    lit *= sunlight;
    // The part of the sky that a slope sees, of the light on level ground.
    vec3 sky = light_of_sky_at(s.height_m, s.up) * (0.5 + 0.5 * dot(s.normal, s.up));
    hook_ambient(s, sky);
    vec3 radiance = s.emissive + irradiance * lit * hook_brdf(s, to_sun, -view) + s.ambient * sky;
    hook_lit(s, radiance);
    hook_atmosphere(s, view, radiance);
    vec4 over = vec4(0.0);
    hook_display(s, over);
#ifdef OVERLAY_RASTER
    over += overlay_beneath * (1.0 - over.a);
#endif
#ifdef INSTANCES
    over *= is_instance ? 0.0 : 1.0;  // instances hide what lies on the ground
#endif
    // What is stored may be clamped to a number.
    float numbers = finite(vec4(radiance, s.height_m)) * finite(over);
    radiance = exposed(radiance);
#ifdef SHOWN
    light_out = shown(pixel_with(s.distance_m), radiance, over, numbers);
#else
    light_out = vec4(radiance, numbers);
#endif
#ifdef DISPLAY_OVERLAY
    overlay_out = over;
#endif
}

//! provides  what a pixel shows, from a texture of stored depths: core.depth in the passes of plugins

//@ include lib/pixel.glsl

const float kNear_m = 0.5;  // render/frame_block.h: stored depths are kNear_m / view depth

/// Depth along the optical axis [m]; kSky_m where there is no ground.
float screen_depth(in sampler2D depths, in ivec2 pixel) {
    float stored = texelFetch(depths, pixel, 0).r;
    return stored > 0.0 ? kNear_m / stored : kSky_m;
}

/// Position relative to the eye, x east, y north, z up at the DEM's centre [m].
vec3 screen_position(in sampler2D depths, in ivec2 pixel) {
    return pixel_ray_at(vec2(pixel) + 0.5) * screen_depth(depths, pixel);
}

/// The shorter of two steps to neighbouring pixels, both in the same sense. One is 0 at the picture's
/// edge.
vec3 screen_step(in vec3 before, in vec3 here, in vec3 after) {
    vec3 back = here - before, on = after - here;
    float back2 = dot(back, back), on2 = dot(on, on);
    return on2 == 0.0 || (back2 > 0.0 && back2 < on2) ? back : on;
}

/// Unit normal of the drawn surface towards the eye, from the nearer neighbours of each pixel; towards
/// the eye in the sky.
vec3 screen_normal(in sampler2D depths, in ivec2 pixel) {
    ivec2 last = textureSize(depths, 0) - 1;
    vec3 here = screen_position(depths, pixel);
    vec3 dx = screen_step(screen_position(depths, ivec2(max(pixel.x - 1, 0), pixel.y)), here,
                          screen_position(depths, ivec2(min(pixel.x + 1, last.x), pixel.y)));
    vec3 dy = screen_step(screen_position(depths, ivec2(pixel.x, max(pixel.y - 1, 0))), here,
                          screen_position(depths, ivec2(pixel.x, min(pixel.y + 1, last.y))));
    vec3 across = cross(dx, dy);
    float area = length(across);
    vec3 to_eye = normalize(-here);
    if (area == 0.0 || screen_depth(depths, pixel) == kSky_m) return to_eye;
    return across * (sign(dot(across, to_eye)) / area);
}

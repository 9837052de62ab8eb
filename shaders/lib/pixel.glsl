//! provides  pixels of full-screen programs: their rays, and what hooks get of them

const float kSky_m = 1e9;  // distance of what shows no ground

/// The ray through a point of the picture [px], in the local frame, at view depth 1.
vec3 pixel_ray_at(in vec2 at_px) {
    return frame.pixel_ray.xyz + at_px.x * frame.pixel_ray_dx.xyz + at_px.y * frame.pixel_ray_dy.xyz;
}

/// On a map: columns and rows of the DEM to the next pixel right, [0], and up, [1]. They are the same everywhere.
mat2 pixel_step_on_map() {
    return inverse(mat2(frame.map_x.x, frame.map_y.x, frame.map_x.y, frame.map_y.y)) *
           mat2(2.0 * frame.viewport.z, 0.0, 0.0, 2.0 * frame.viewport.w);
}

/// Of this pixel, from the lower left corner of the whole picture, of which a frame may be a tile.
vec2 picture_px() {
    return gl_FragCoord.xy + vec2(frame.part_left, frame.part_below);
}

/// A number of a pixel, 0..1, even over its neighbours: interleaved gradient noise.
/// source: J. Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH 2014
/// course, slide 123
float pixel_noise(in vec2 at_px) {
    return fract(52.9829189 * fract(dot(at_px, vec2(0.06711056, 0.00583715))));
}

/// This pixel. @param distance_m  from the eye to what it shows, or kSky_m
Pixel pixel_with(in float distance_m) {
    return Pixel(gl_FragCoord.xy, gl_FragCoord.xy * frame.viewport.zw, normalize(pixel_ray_at(gl_FragCoord.xy)),
                 distance_m, picture_px() * frame.picture.zw);
}

//! provides  height_mean: the DEM's ground, generalised, and its slope; height_mean_level: how far for a pixel;
//!           height_mean_linear: the same height with less work and corners
//! reads     height_means: render/height_means.h makes it, where a program reads it

//@ include lib/pixel.glsl

uniform sampler2D height_means;  // r: height [m]; level k has means of 2^k x 2^k texels of level 0, and is on its right

/// Corner of a level in the texture, and its last texel from there.
ivec4 height_mean_place(in int level) {
    ivec2 size = textureSize(height_means, 0);
    size.x -= size.x / 3;  // of level 0
    return ivec4(level > 0 ? ivec2(size.x, size.y - (size.y >> (level - 1))) : ivec2(0), (size >> level) - 1);
}

/// The level that is one texel wide or high.
int height_mean_coarsest() {
    ivec2 last = height_mean_place(0).zw;
    return findMSB(min(last.x, last.y) + 1);
}

/// Height of the texel of level 0 that a post is in [m].
float height_of_texel(in vec2 post) {
    ivec2 texel = ivec2(floor((post + 0.5) * frame.light_grid.z));
    return texelFetch(height_means, clamp(texel, ivec2(0), height_mean_place(0).zw), 0).r;
}

/// Heights of a level, smoothed by a cubic B-spline: about a Gaussian whose standard deviation is 0.65 texels.
/// @param post  column and row of the DEM
/// @returns x: height [m], yz: its change a column and a row [m]
vec3 height_mean(in vec2 post, in int level) {
    level = clamp(level, 0, height_mean_coarsest());
    ivec4 place = height_mean_place(level);
    ivec2 corner = place.xy, last = place.zw;
    float texels_per_post = frame.light_grid.z * exp2(-float(level));
    vec2 at = clamp((post + 0.5) * texels_per_post - 0.5, vec2(0.0), vec2(last));
    ivec2 first = ivec2(floor(at)) - 1;
    vec2 t = at - floor(at), u = 1.0 - t, t2 = t * t, u2 = u * u;
    vec2 weights[4] = vec2[](u * u2 / 6.0, (3.0 * t - 6.0) * t2 / 6.0 + 2.0 / 3.0,
                             (3.0 * u - 6.0) * u2 / 6.0 + 2.0 / 3.0, t * t2 / 6.0);
    vec2 changes[4] = vec2[](-0.5 * u2, (1.5 * t - 2.0) * t, (2.0 - 1.5 * u) * u, 0.5 * t2);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < 4; ++y) {
        vec2 row = vec2(0.0);  // height and its change along the row
        for (int x = 0; x < 4; ++x) {
            float height = texelFetch(height_means, corner + clamp(first + ivec2(x, y), ivec2(0), last), 0).r;
            row += height * vec2(weights[x].x, changes[x].x);
        }
        sum += vec3(row.x * weights[y].y, row.y * weights[y].y, row.x * changes[y].y);
    }
    return vec3(sum.x, sum.yz * texels_per_post);
}

/// Height between the four texels around a post [m].
float height_between(in vec2 post, in int level) {
    ivec4 place = height_mean_place(level);
    vec2 at = clamp((post + 0.5) * frame.light_grid.z * exp2(-float(level)) - 0.5, vec2(0.0), vec2(place.zw));
    ivec2 first = ivec2(at), next = min(first + 1, place.zw);
    ivec4 x = place.x + ivec4(first.x, next.x, first.x, next.x), y = place.y + ivec4(first.yy, next.yy);
    vec4 heights;
    for (int i = 0; i < 4; ++i)
        heights[i] = texelFetch(height_means, ivec2(x[i], y[i]), 0).r;
    vec2 t = at - vec2(first);
    vec2 rows = mix(heights.xz, heights.yw, t.x);
    return mix(rows.x, rows.y, t.y);
}

/// Height that is linear between texels and between levels [m]. @param level  whole ones and shares, from 0 on
float height_mean_linear(in vec2 post, in float level) {
    level = clamp(level, 0.0, float(height_mean_coarsest()));
    int lower = int(level);
    return mix(height_between(post, lower), height_between(post, int(ceil(level))), level - float(lower));
}

/// A slope to the east and to the north, of changes a column and a row.
vec2 height_mean_slope(in vec2 change) {
    return vec2(dot(change, frame.light_axes.xy), dot(change, frame.light_axes.zw));
}

/// The level whose texels are as wide as a pixel on level ground; below 0 where pixels are finer than the DEM.
float height_mean_level(in Surface s) {
    float posts = frame.map_x == vec4(0.0) ? length(frame.pixel_ray_dx.xyz) * s.distance_m * frame.normal_texels_per_m
                                           : sqrt(abs(determinant(pixel_step_on_map())));
    return log2(posts * frame.light_grid.z);
}

/// Side of a texel of level 0 [m].
float height_mean_texel_m() { return 1.0 / (frame.light_grid.z * frame.normal_texels_per_m); }

/// How much maps exaggerate slopes, 1 to 6: gentle DEMs more than steep ones.
float height_mean_exaggeration() { return clamp(pow(0.5 / max(frame.light_map.y, 1e-3), 0.9), 1.0, 6.0); }

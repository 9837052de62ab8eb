//! provides  surface_point: where the DEM itself has the point that a pixel shows; surface_height; surface_of_water
//! reads     gbuffer, surface pages: heights at full resolution, in the layers of the normal pages

//@ include lib/pages.glsl

uniform sampler2DArray surface_pages;  // r: height [m]

/// Heights of the four posts around a pixel's point, as textureGather orders them [m].
/// @param t  of the point between them
vec4 surface_posts(out vec2 t) {
    vec2 post = uintBitsToFloat(texelFetch(gbuffer, ivec2(gl_FragCoord.xy), 0).xy);
    PagePlace at = page_place(post, 0);
    vec2 node = at.node + 1.0;
    vec2 quad = floor(node);
    t = node - quad;
    return textureGather(surface_pages, vec3((quad + 1.0) / kNormalPage_px, float(at.layer)));
}

/// Relative to the eye [m]. The ground is drawn as coarsely as the picture allows, by up to two
/// pixels off; what asks whether a ray meets the ground has to start from the ground. On the finest
/// pages that are there, on the same two triangles a quad as the terrain's.
vec3 surface_point(in Surface s) {
#ifdef TERRAIN_NORMAL_VERTEX
    return s.position_m;
#else
    vec2 t;
    vec4 h = surface_posts(t);
    float before = h.w + t.x * (h.z - h.w) + t.y * (h.x - h.w);
    float behind = h.y + (1.0 - t.x) * (h.x - h.y) + (1.0 - t.y) * (h.z - h.y);
    float height = t.x + t.y <= 1.0 ? before : behind;
    return s.position_m + (height - s.height_m) * frame.height_range.z * s.up;
#endif
}

/// Height and its change a column and a row, on the nodes of a level [m].
/// Cells are split along the diagonal whose ends differ less, so that edges of level ground are smooth.
vec3 surface_plane(in vec2 post, in vec2 rounding, in int level) {
    PagePlace at = page_place(post, level);
    vec2 node = at.node - rounding * at.nodes_per_post + 1.0;
    vec2 quad = floor(node);
    vec2 t = node - quad;
    vec4 h = textureGather(surface_pages, vec3((quad + 1.0) / kNormalPage_px, float(at.layer)));
    bool falls = abs(h.x - h.z) <= abs(h.w - h.y);
    bool above = falls ? t.x + t.y <= 1.0 : t.x > t.y;
    vec2 slope = vec2(above ? h.z - h.w : h.y - h.x, above == falls ? h.x - h.w : h.y - h.z);
    float height = falls && !above ? h.y + dot(slope, t - 1.0) : h.w + dot(slope, t);
    return vec3(height, slope * at.nodes_per_post);
}

/// Height of the DEM at a point, and how it changes over a pixel [m]: of the posts, or of means that are about a pixel apart.
/// @param rounding     of the post: what it is too large by
/// @param column, row  how they change from pixel to pixel, right and up
vec2 surface_height(in vec2 post, in vec2 rounding, in vec2 column, in vec2 row) {
    float posts_a_pixel = sqrt(abs(determinant(mat2(column, row))));
    float level = clamp(log2(max(posts_a_pixel, 1.0)), 0.0, frame.normal_levels - 1.0);
    vec3 plane = mix(surface_plane(post, rounding, int(level)),
                     surface_plane(post, rounding, min(int(level) + 1, int(frame.normal_levels) - 1)), fract(level));
    return vec2(plane.x, length(plane.y * column + plane.z * row));
}

/// Levels a height to that of water. @param step_m  how it changes over a pixel
/// @param level  share of the pixel that is water of that height
/// @returns factor on the step
float surface_levelled(inout float height_m, in float step_m, in float level_m, in float level) {
    float level_step = sqrt(2.0 * min(level, 1.0 - level));  // over a pixel, as water_covered() blends shores
    float land_m = level > 0.0 ? level_m + clamp(height_m - level_m, -step_m, step_m) : height_m;
    height_m = mix(land_m, level_m, level);
    return 1.0 - level + (step_m > 0.0 ? level_step * abs(land_m - level_m) / step_m : 0.0);
}

/// Puts a point onto water, for hooks of `material`.
/// @param height_m  of the DEM at the point
/// @param share     of the pixel that is water
/// @param known     1 where the DEM has the water's floor
void surface_of_water(inout Surface s, in float height_m, in float share, in float known) {
#if defined(HEIGHT_STEPS) && !defined(TERRAIN_NORMAL_VERTEX)
    // Contours need heights and steps of one surface: the drawn floor, or the water's level up to its shore, where the
    // DEM climbs already and coarse ground may lie anywhere. From there land climbs as steeply as the ground does.
    vec2 t;
    vec4 h = surface_posts(t);
    float level_m = min(min(h.x, h.y), min(h.z, h.w));
    float level = share * (1.0 - known);
    float kept = surface_levelled(s.height_m, length(vec2(s.height_dx_m, s.height_dy_m)), level_m, level);
    s.height_dx_m *= kept;
    s.height_dy_m *= kept;
    s.dem_step_m *= surface_levelled(s.dem_height_m, s.dem_step_m, level_m, level);
#else
    s.height_m = mix(s.height_m, height_m, share);
#endif
}

//! provides  surface_point: where the DEM itself has the point that a pixel shows; surface_of_water
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
    float level_step = sqrt(2.0 * min(level, 1.0 - level));  // over a pixel, as water_covered() blends shores
    float steep = length(vec2(s.height_dx_m, s.height_dy_m));
    float land_m = level > 0.0 ? level_m + clamp(s.height_m - level_m, -steep, steep) : s.height_m;
    float kept = 1.0 - level + (steep > 0.0 ? level_step * abs(land_m - level_m) / steep : 0.0);
    s.height_dx_m *= kept;
    s.height_dy_m *= kept;
    s.height_m = mix(land_m, level_m, level);
#else
    s.height_m = mix(s.height_m, height_m, share);
#endif
}

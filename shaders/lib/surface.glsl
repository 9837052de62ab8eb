//! provides  surface_point: where the DEM itself has the point that a pixel shows
//! reads     gbuffer, surface pages: heights at full resolution, in the layers of the normal pages

//@ include lib/pages.glsl

uniform sampler2DArray surface_pages;  // r: height [m]

/// Relative to the eye [m]. The ground is drawn as coarsely as the picture allows, by up to two
/// pixels off; what asks whether a ray meets the ground has to start from the ground. On the finest
/// pages that are there, on the same two triangles a quad as the terrain's.
vec3 surface_point(in Surface s) {
#ifdef TERRAIN_NORMAL_VERTEX
    return s.position_m;
#else
    vec2 post = uintBitsToFloat(texelFetch(gbuffer, ivec2(gl_FragCoord.xy), 0).xy);
    PagePlace at = page_place(post, 0);
    vec2 node = at.node + 1.0;
    vec2 quad = floor(node);
    vec2 t = node - quad;
    vec4 h = textureGather(surface_pages, vec3((quad + 1.0) / kNormalPage_px, float(at.layer)));
    float before = h.w + t.x * (h.z - h.w) + t.y * (h.x - h.w);
    float behind = h.y + (1.0 - t.x) * (h.x - h.y) + (1.0 - t.y) * (h.z - h.y);
    float height = t.x + t.y <= 1.0 ? before : behind;
    return s.position_m + (height - s.height_m) * frame.height_range.z * s.up;
#endif
}

//! provides  the geometry pass: what is where, for terrain.frag.glsl to shade each visible pixel once
//! writes    gbuffer: column and row of the post, height [m], view depth [m]; with HEIGHT_STEPS, the number
//!           of an output, also how the height changes from pixel to pixel [m/px], the DEM's own height and its
//!           change [m]; with ORTHOGRAPHIC, another one, its position [m, relative to the eye], and 1
//!
//! Shading is deferred because small triangles cost a software renderer a whole block of 4 x 4
//! pixels each, and a GPU a block of 2 x 2: this way that block runs these few lines only.

//@ include lib/finite.glsl
//@ include lib/octahedral.glsl
//@ include lib/surface.glsl

flat in vec4 post_limits;
in vec2 post_of_tile;
in float height_m;
in float height_in_tile_m;
in vec3 vertex_normal;
in vec3 place_m;

layout(location = 0) out uvec4 gbuffer_out;
#ifdef HEIGHT_STEPS
layout(location = HEIGHT_STEPS) out vec4 height_steps_out;

/// How a varying changes from this pixel to the next one right and up, on this triangle.
/// Varyings divided by the depth are linear in the picture, as is 1 / depth: their differences are
/// those of the whole triangle's plane, also where the triangle ends between two pixels.
vec2 steps_of(in float varying_here) {
    float near = gl_FragCoord.w;
    float scaled = varying_here * near;
    return (vec2(dFdx(scaled), dFdy(scaled)) - varying_here * vec2(dFdx(near), dFdy(near))) / near;
}

/// Of the height [m/px]: 0 on level ground, where the differences are those of rounding: up to 64 of a float's steps,
/// but for slivers.
vec2 height_steps() {
    const float rounding = 4e-6;
    vec2 steps = steps_of(height_in_tile_m);
    return length(steps) > rounding * abs(height_in_tile_m) ? steps : vec2(0.0);
}
#endif

#ifdef ORTHOGRAPHIC
layout(location = ORTHOGRAPHIC) out vec4 ground_place_out;
#endif

void main() {
    vec2 post = post_limits.xy + min(post_of_tile, post_limits.zw);
#ifdef ORTHOGRAPHIC
    ground_place_out = vec4(place_m, 1.0);
#endif
#ifdef TERRAIN_NORMAL_VERTEX
    vec3 n = normalize(vertex_normal);
    uvec2 normal_source = uvec2(packSnorm2x16(normal_octahedral(n)), packUnorm2x16(post * frame.posts.zw));
#else
    uvec2 normal_source = floatBitsToUint(post);
#endif
#ifdef HEIGHT_STEPS
    precise vec2 rounding = (post - post_limits.xy) - post_of_tile;  // of large columns and rows
    height_steps_out = vec4(height_steps(), surface_height(post, rounding, steps_of(post_of_tile.x), steps_of(post_of_tile.y)));
#endif
#ifdef NAN_SLIVERS
    // A sliver that the near plane has cut to nothing has NaN for its inputs in llvmpipe; its neighbours
    // cover the pixel. On GPUs a discard costs the early depth test.
    if (isnan(height_m)) discard;
#endif
    uint height = floatBitsToUint(height_m);
#ifdef DISPLACED
    const uint no_number = 0x7fc00000u;
    height = abs(height_m) > 1e-5 * kNowhere_m ? no_number : height;
#endif
    gbuffer_out = uvec4(normal_source, height, floatBitsToUint(1.0 / gl_FragCoord.w));
    store_varyings();
}

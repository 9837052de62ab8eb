//! provides  the geometry pass: what is where, for terrain.frag.glsl to shade each visible pixel once
//! writes    place: column and row of the post, height [m], view depth [m]
//!
//! Shading is deferred because small triangles cost a software renderer a whole block of 4 x 4
//! pixels each, and a GPU a block of 2 x 2: this way that block runs these few lines only.

in vec2 post;
in float height_m;
in vec3 vertex_normal;

layout(location = 0) out uvec4 place_out;

void main() {
#ifdef TERRAIN_NORMAL_VERTEX
    vec3 n = normalize(vertex_normal);
    uvec2 normal_source = uvec2(packSnorm2x16(n.xy), packSnorm2x16(n.zz));
#else
    uvec2 normal_source = floatBitsToUint(post);
#endif
    // A sliver that the near plane has cut to nothing has no coordinates in llvmpipe; its neighbours
    // cover the pixel.
    if (isnan(height_m)) discard;
    place_out = uvec4(normal_source, floatBitsToUint(height_m), floatBitsToUint(1.0 / gl_FragCoord.w));
    store_varyings();
}

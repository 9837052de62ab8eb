//! provides  edge_depth: the depth by which silhouettes are found, with steps at the corners of a block too
//! reads     depth, reversed; with WALLS which way the walls of a block face (side.frag.glsl)

uniform sampler2D depth;
uniform sampler2D walls;  // 0 where there is none

/// A wall and the ground above it meet at the same depth, and so do two walls: each direction has a factor
/// of its own, at least 0.05 from those at right angles to it.
float edge_depth(in ivec2 pixel) {
    float at = texelFetch(depth, pixel, 0).r;
#ifdef WALLS
    at *= 1.0 - 0.4 * texelFetch(walls, pixel, 0).r;
#endif
    return at;
}

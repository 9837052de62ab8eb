//! provides  where silhouettes are: marks their pixels in the stencil for antialias.frag.glsl
//! reads     depth, reversed: proportional to 1 / view depth, which is linear across a plane in the
//!           picture, so that a step in it is an edge and a slant, however steep, is none

uniform sampler2D depth;

const float kEdge = 0.03;  // smallest step that is an edge, as a share of the depth

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(frame.viewport.xy) - 1;
    float here = texelFetch(depth, pixel, 0).r;
    float right = texelFetch(depth, min(pixel + ivec2(1, 0), last), 0).r;
    float above = texelFetch(depth, min(pixel + ivec2(0, 1), last), 0).r;
    float left = texelFetch(depth, max(pixel - ivec2(1, 0), ivec2(0)), 0).r;
    float below = texelFetch(depth, max(pixel - ivec2(0, 1), ivec2(0)), 0).r;
    vec2 bend = abs(vec2(right + left, above + below) - 2.0 * here);
    if (max(bend.x, bend.y) <= kEdge * max(here, max(max(right, left), max(above, below)))) discard;
}

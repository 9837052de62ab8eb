//! provides  where silhouettes are: marks their pixels in the stencil for antialias.frag.glsl
//! reads     edge_depth, reversed: proportional to 1 / view depth, which is linear across a plane in the
//!           picture, so that a step in it is an edge and a slant, however steep, is none

//@ include lib/edge_depth.glsl

const float kEdge = 0.03;  // smallest step that is an edge, as a share of the depth

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(frame.viewport.xy) - 1;
    float here = edge_depth(min(pixel, last));
    // Of the four neighbours two lie in the same block of 2 x 2 pixels, which derivatives reach
    // without a read.
    ivec2 odd = pixel & 1;
    ivec2 outwards = 2 * odd - 1;
    vec2 outer = vec2(edge_depth(ivec2(clamp(pixel.x + outwards.x, 0, last.x), pixel.y)),
                      edge_depth(ivec2(pixel.x, clamp(pixel.y + outwards.y, 0, last.y))));
    vec2 inner = here - vec2(outwards) * vec2(dFdxFine(here), dFdyFine(here));
    vec2 bend = abs(outer + inner - 2.0 * here);
    if (max(bend.x, bend.y) <= kEdge * max(here, max(max(outer.x, outer.y), max(inner.x, inner.y)))) discard;
}

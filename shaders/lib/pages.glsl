//! provides  page_place: the slice and the node at which tile pages have a post; sizes of the pages, which
//!           render/pages.h has too

const int kNormalNodesLog2 = 8;  // nodes that a normal page covers along a side: 256
const float kNormalPage_px = 258.0;  // they and a border of one
const uint kNoPage = 0xffffu;  // in the page table: no page covers this ground

uniform usampler2D gbuffer;  // of the pixels, from geometry.frag.glsl
uniform usampler2D page_table;  // r: layer of the finest normal page that covers this one; g: its level

/// A post in a tile page, which is a slice of each array texture.
struct PagePlace {
    vec2 node;             // its column and row among the page's nodes, with fractions; node 0 is texel 1
    uint layer;            // the slice; kNoPage where the page table has none
    float nodes_per_post;  // 1 on the finest level, 0.5 on the next one
};

/// Finds a post in the finest resident page of a level or a coarser one.
/// @param post   column and row of the DEM
/// @param level  of the pyramid; level 0 has a node a post
PagePlace page_place(in vec2 post, in int level) {
    uvec2 page = texelFetch(page_table, ivec2(post) >> (kNormalNodesLog2 + level), level).rg;
    int shift = kNormalNodesLog2 + int(page.g);
    vec2 first = vec2((ivec2(post) >> shift) << shift);
    float nodes_per_post = exp2(-float(page.g));
    return PagePlace((post - first) * nodes_per_post, page.r, nodes_per_post);
}

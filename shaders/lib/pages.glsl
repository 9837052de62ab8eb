//! provides  sizes of the elevation's pages on the device; render/pages.h is their mirror

const int kNormalNodesLog2 = 8;  // nodes that a normal page covers along a side: 256
const float kNormalPage_px = 258.0;  // they and a border of one

uniform usampler2D gbuffer;  // of the pixels, from geometry.frag.glsl
uniform usampler2D page_table;  // r: layer of the finest normal page that covers this one; g: its level

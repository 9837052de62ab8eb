//! provides  sizes of the elevation's pages on the device; render/pages.h is their mirror

const int kNormalNodesLog2 = 8;  // nodes that a normal page covers along a side: 256
const float kNormalPage_px = 258.0;  // they and a border of one

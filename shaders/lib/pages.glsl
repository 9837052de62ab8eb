//! provides  sizes of the elevation's pages on the device; render/pages.h is their mirror

const float kNormalPage_px = 272.0;  // side of a normal page: 256 and a border of 8 on each side

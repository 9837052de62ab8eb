//! provides  ground_repeats, ground_cell: where a point of the ground is in a pattern that repeats, or in a grid of
//!           cells, to less than a millimetre of fine ones however far it is from the DEM's centre
//!
//! 650 km from the centre a float has steps of 6 cm, so that ground_m alone shows fine patterns as blocks. A point is
//! anchored_m, which is short near the eye, from frame.eye_anchor, whole steps of 2048 m from the centre. Of the
//! repeats in a step only the fraction counts, and a number of steps times that fraction is exact in integers, which
//! overflow at whole repeats. The pattern is that of ground_m: the same at a place from every eye.

const float kGroundAnchor_m = 2048.0;  // render/frame_block.h: kEyeAnchor_m
const float kGroundUnits = 1073741824.0;  // integers to a repeat: 2^30

/// Repeats in a step of the anchor but for whole ones, in integers.
ivec2 ground_step(in vec2 per_m) {
    return ivec2(fract(kGroundAnchor_m * per_m) * kGroundUnits);
}

/// Coordinates in a pattern that repeats at every whole number, such as those of a texture: per_m * ground_m.xy but
/// for a whole number, which is the same all over a frame.
/// @param anchored_m  of Surface or VertexFrame
/// @param per_m       repeats a metre along east and north: 1.0 / period_m
vec2 ground_repeats(in vec2 anchored_m, in vec2 per_m) {
    ivec2 units = ivec2(frame.eye_anchor.xy) * ground_step(per_m);
    return per_m * anchored_m + vec2(units) / kGroundUnits;
}

/// The same for a pattern that is turned or sheared.
/// @param per_m  from metres east and north to repeats: turn / period_m
vec2 ground_repeats(in vec2 anchored_m, in mat2 per_m) {
    ivec2 anchor = ivec2(frame.eye_anchor.xy);
    ivec2 units = anchor.x * ground_step(per_m[0]) + anchor.y * ground_step(per_m[1]);
    return per_m * anchored_m + vec2(units) / kGroundUnits;
}

/// The cell of a grid without end, for noise that is made of the numbers of cells. Off by less than 0.00003 of a cell
/// within 650 km of the centre, 0.0004 on the whole Earth.
/// @param per_m   from metres east and north to cells
/// @param within  place in the cell, 0 to 1
ivec2 ground_cell(in vec2 anchored_m, in mat2 per_m, out vec2 within) {
    vec2 east = kGroundAnchor_m * per_m[0], north = kGroundAnchor_m * per_m[1];
    vec2 whole_east = floor(east), whole_north = floor(north);
    vec2 whole = frame.eye_anchor.x * whole_east + frame.eye_anchor.y * whole_north;
    vec2 rest = frame.eye_anchor.x * (east - whole_east) + frame.eye_anchor.y * (north - whole_north);
    vec2 cell = floor(rest);
    vec2 at = per_m * anchored_m + (rest - cell);
    vec2 further = floor(at);
    within = at - further;
    return ivec2(whole + cell + further);
}

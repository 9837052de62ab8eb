//! provides  floor_shade: how much the ground above hides of the sky over the floor that a DEM stands on
//!           when it is seen from outside
//! reads     floor_ground: where there is ground, as seen from above, blurred

uniform sampler2D floor_ground;  // r: blurred by a little of the DEM's width, g: by a lot of it

/// @param direction  from the eye
/// @returns  0 to 1, close to the ground and far around it; 0 where the floor is not seen
vec2 floor_shade(in vec3 direction) {
    float way = (frame.block.y - frame.eye_m.z) / direction.z;
    if (!(way > 0.0) || frame.block.z <= 0.0) return vec2(0.0);
    vec2 at = (frame.eye_m.xy + way * direction.xy - frame.footprint_area.xy) * frame.footprint_area.zw;
    vec2 inside = step(vec2(0.0), at) * step(at, vec2(1.0));
    return textureLod(floor_ground, at, 0.0).rg * inside.x * inside.y;
}

//! provides  a DEM seen from outside as a block: the material of its cut sides, and a calm backdrop with the
//!           block's own shade on the floor below it
//! hook      side, backdrop
//! reads     the sun, the sky's light, where the DEM has ground
//! writes    radiance

//@ include lib/floor.glsl
//@ include lib/ground.glsl

uniform vec3 block_side = vec3(0.34, 0.31, 0.28); //@ colour label("Sides") description("Reflectance of the cut sides")
uniform float block_sun = 0.45; //@ range(0, 2) label("Sun on the sides") description("Factor on the sunlight on the cut sides: below 1 the ground stays brighter")
uniform float block_sky = 1.8; //@ range(0, 10) label("Ambient light") description("Ambient light on the sides, relative to the light of the sky")
uniform vec3 block_water = vec3(0.03, 0.12, 0.20); //@ colour label("Water") description("Reflectance of the cut water of a sea whose floor the DEM has, or of a flood")
uniform vec3 block_above = vec3(0.60, 0.62, 0.64); //@ colour label("Backdrop above") description("Colour at the upper edge of the picture, by day")
uniform vec3 block_below = vec3(0.43, 0.43, 0.42); //@ colour label("Backdrop below") description("Colour at the lower edge of the picture, by day")
uniform vec3 block_space = vec3(0.012, 0.014, 0.018); //@ colour label("Behind a globe") description("Backdrop of a DEM of the whole Earth")
uniform float block_shade = 0.55; //@ range(0, 1) label("Shade") description("Darkness of the block's shade on the floor")

float block_luminance(in vec3 light) {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

/// What turns a colour of the picture by day into radiance: the backdrop is no part of the landscape, and as
/// bright whatever the exposure, but a night is dark all over.
float block_scale() {
    float light = block_luminance(frame.sky_irradiance.rgb + max(sin(frame.sun_direction.w), 0.25) * frame.sun_light[0].rgb);
    return min(2.0 * light, 1.0 / frame.exposure);
}

vec3 block_on_side(in Surface s, in float down) {
    vec3 to_sun;
    vec3 sun = sun_light(s.up, to_sun) * max(dot(s.normal, to_sun), 0.0);
    vec3 sky = block_sky * vec3(block_luminance(frame.sky_irradiance.rgb)) * (0.75 + 0.25 * dot(s.normal, s.up));
    // Near the floor less of the surroundings is seen.
    float edge_m = 0.7 * length(frame.pixel_ray_dy.xyz) * max(s.distance_m, 1e-3);
    vec3 cut = mix(block_side, block_water, smoothstep(-edge_m, edge_m, s.above_ground_m - edge_m));
    return cut * (block_sun * sun + sky) * (1.0 - 0.35 * down * down);
}

vec3 block_on_backdrop(in vec3 direction, in vec2 at) {
    if (frame.block.z <= 0.0) return block_space * block_scale();
    vec2 shade = floor_shade(direction);
    float left = (1.0 - 0.6 * block_shade * shade.x) * (1.0 - block_shade * shade.y);
    return mix(block_below, block_above, smoothstep(0.0, 1.0, at.y)) * left * block_scale();
}

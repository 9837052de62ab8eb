//! provides  shadow: how much of the sun's disc a point of the ground sees past the ground sunward of it
//! hook      visibility
//! reads     shadow clearances of all posts (core/render/ground_light.h)
//! writes    factor

//@ include lib/sun_share.glsl

void shadows_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    factor *= sun_share(s, to_sun);
}

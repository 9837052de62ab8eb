//! provides  shown: from radiance to the colours of the picture
//! hook      image, tonemap, finish, overlay

//@ include lib/finite.glsl
//@ include lib/pixel.glsl
//@ include lib/srgb.glsl

/// Rounds to 8 bits up or down by where the pixel is, so that a sky's gradient does not end in steps. Colours of 8 bits
/// stay what they are also on GPUs that convert by half floats, which is off by up to 0.06 of a step.
vec3 dithered(in vec3 colour) {
#ifdef DEEP
    return colour;  // stored with 16 bits
#else
    const float width = 0.8;  // of a step; sample_sum.cpp has it, too
    return colour + width * (pixel_noise(picture_px()) - 0.5) / 255.0;
#endif
}

/// @param pixel     for hooks
/// @param radiance  linear, exposed
/// @param over      premultiplied sRGB that lies over the picture
/// @param numbers   1 where both were numbers, 0 else
/// @returns sRGB, and in alpha whether all were numbers up to here
vec4 shown(in Pixel pixel, in vec3 radiance, in vec4 over, in float numbers) {
    vec3 colour = radiance;
    hook_image(pixel, colour);
    hook_tonemap(colour);
    hook_finish(pixel, colour);
    hook_overlay(pixel, over);
    numbers *= finite(vec4(colour, 0.0)) * finite(over);
    colour = srgb_encoded(colour) * (1.0 - over.a) + over.rgb;
    return vec4(dithered(colour), numbers);
}

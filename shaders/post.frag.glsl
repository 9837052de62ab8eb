//! provides  from linear radiance to the colours of the picture
//! reads     radiance, linear, exposed
//! writes    colour: sRGB

//@ include lib/srgb.glsl

uniform sampler2D radiance;
uniform sampler2D overlay;  // premultiplied sRGB, where an effect has the hook display

layout(location = 0) out vec4 colour_out;

/// Rounds to 8 bits up or down by where the pixel is, so that a sky's gradient does not end in steps.
/// source: J. Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH 2014
/// course, slide 123: interleaved gradient noise
vec3 dithered(in vec3 colour) {
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    return colour + (noise - 0.5) / 255.0;
}

void main() {
    vec3 colour = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb;
    hook_tonemap(colour);
    colour = srgb_encoded(colour);
#ifdef DISPLAY_OVERLAY
    vec4 over = texelFetch(overlay, ivec2(gl_FragCoord.xy), 0);
    colour = colour * (1.0 - over.a) + over.rgb;
#endif
    colour_out = vec4(dithered(colour), 1.0);
}

//! provides  from linear radiance to the colours of the picture, where the radiance itself is wanted too
//! reads     radiance, linear, exposed; overlay
//! writes    colour: sRGB

//@ include lib/shown.glsl

uniform sampler2D radiance;
uniform sampler2D overlay;  // premultiplied sRGB, where an effect has the hook display

layout(location = 0) out vec4 colour_out;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 over = vec4(0.0);
#ifdef DISPLAY_OVERLAY
    over = texelFetch(overlay, pixel, 0);
#endif
    vec4 light = texelFetch(radiance, pixel, 0);
    colour_out = shown(light.rgb, over, light.a);
}

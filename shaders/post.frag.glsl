//! provides  from linear radiance to the colours of the picture
//! reads     radiance, linear, exposed
//! writes    colour: sRGB

//@ include lib/srgb.glsl

uniform sampler2D radiance;

layout(location = 0) out vec4 colour_out;

void main() {
    vec3 colour = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb;
    hook_tonemap(colour);
    colour_out = vec4(srgb_encoded(colour), 1.0);
}

//! provides  from linear radiance to the colours of the picture, where the radiance itself is wanted too
//! reads     radiance, linear, exposed; overlay
//! writes    colour: sRGB

//@ include lib/screen.glsl
//@ include lib/shown.glsl

uniform sampler2D radiance;
uniform sampler2D depth;    // where effects have hooks that get a Pixel
uniform sampler2D overlay;  // premultiplied sRGB, where an effect has the hook display

layout(location = 0) out vec4 colour_out;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 over = vec4(0.0);
#ifdef DISPLAY_OVERLAY
    over = texelFetch(overlay, pixel, 0);
#endif
    float distance_m = kSky_m;
#ifdef PIXEL_HOOKS
    float depth_m = screen_depth(depth, pixel);
    if (depth_m < kSky_m) distance_m = depth_m * length(pixel_ray_at(gl_FragCoord.xy));
#endif
    vec4 light = texelFetch(radiance, pixel, 0);
    colour_out = shown(pixel_with(distance_m), light.rgb, over, light.a);
}

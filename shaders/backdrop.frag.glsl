//! provides  what lies behind a DEM that is seen from outside
//! hook      backdrop
//! writes    as terrain.frag.glsl

//@ include lib/exposed.glsl
//@ include lib/finite.glsl
//@ include lib/pixel.glsl
//@ include lib/shown.glsl

layout(location = 0) out vec4 light_out;

void main() {
    vec3 radiance = hook_backdrop(normalize(pixel_ray_at(gl_FragCoord.xy)), picture_px() * frame.picture.zw);
    float numbers = finite(vec4(radiance, 0.0));
    radiance = exposed(radiance);
#ifdef SHOWN
    light_out = shown(pixel_with(kSky_m), radiance, vec4(0.0), numbers);
#else
    light_out = vec4(radiance, numbers);
#endif
}

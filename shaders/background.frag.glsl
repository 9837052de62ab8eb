//! provides  the sky where there is no terrain
//! writes    as terrain.frag.glsl

//@ include lib/exposed.glsl
//@ include lib/shown.glsl

layout(location = 0) out vec4 light_out;

void main() {
    vec3 ray = frame.pixel_ray.xyz + gl_FragCoord.x * frame.pixel_ray_dx.xyz +
               gl_FragCoord.y * frame.pixel_ray_dy.xyz;
    vec3 radiance = exposed(background_radiance(normalize(ray), true));
#ifdef SHOWN
    light_out = shown(radiance, vec4(0.0));
#else
    light_out = vec4(radiance, 1.0);
#endif
}

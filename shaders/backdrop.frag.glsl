//! provides  what lies behind a DEM that is seen from outside
//! hook      backdrop
//! writes    as terrain.frag.glsl

//@ include lib/exposed.glsl
//@ include lib/finite.glsl
//@ include lib/shown.glsl

layout(location = 0) out vec4 light_out;

void main() {
    vec3 ray = frame.pixel_ray.xyz + gl_FragCoord.x * frame.pixel_ray_dx.xyz +
               gl_FragCoord.y * frame.pixel_ray_dy.xyz;
    vec3 radiance = hook_backdrop(normalize(ray), gl_FragCoord.xy * frame.viewport.zw);
    float numbers = finite(vec4(radiance, 0.0));
    radiance = exposed(radiance);
#ifdef SHOWN
    light_out = shown(radiance, vec4(0.0), numbers);
#else
    light_out = vec4(radiance, numbers);
#endif
}

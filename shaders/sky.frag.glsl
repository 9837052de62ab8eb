//! provides  the sky where there is no terrain
//! writes    radiance, linear, exposed

//@ include lib/exposed.glsl

layout(location = 0) out vec4 radiance_out;

void main() {
    vec3 ray = frame.pixel_ray.xyz + gl_FragCoord.x * frame.pixel_ray_dx.xyz +
               gl_FragCoord.y * frame.pixel_ray_dy.xyz;
    radiance_out = vec4(exposed(background_radiance(normalize(ray), true)), 1.0);
}

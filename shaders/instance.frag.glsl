//! provides  what is where, for pixels that show an instance of a plugin's mesh; terrain.frag.glsl shades them
//! writes    gbuffer: column and row of the post and height [m] of the ground below the instance's foot, view depth [m];
//!           instance_colour: square root of the reflectance, 1 in alpha; instance_direction: its normal

//@ include lib/octahedral.glsl

in vec2 post;
in float height_m;
in vec3 instance_normal;
in vec3 instance_reflectance;

layout(location = 0) out uvec4 gbuffer_out;
layout(location = 1) out vec4 instance_colour_out;
layout(location = 2) out vec2 instance_direction_out;

void main() {
#ifdef NAN_SLIVERS
    if (isnan(height_m)) discard;  // as in geometry.frag.glsl
#endif
    vec2 direction = normal_octahedral(normalize(instance_normal));
#ifdef TERRAIN_NORMAL_VERTEX
    uvec2 ground = uvec2(packSnorm2x16(direction), packUnorm2x16(post * frame.posts.zw));
#else
    uvec2 ground = floatBitsToUint(post);
#endif
    gbuffer_out = uvec4(ground, floatBitsToUint(height_m), floatBitsToUint(1.0 / gl_FragCoord.w));
    instance_colour_out = vec4(sqrt(instance_reflectance), 1.0);
    instance_direction_out = 0.5 + 0.5 * direction;
}

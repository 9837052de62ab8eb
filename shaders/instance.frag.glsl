//! provides  what is where, for pixels that show an instance of a plugin's mesh; terrain.frag.glsl shades them
//! writes    gbuffer: column and row of the post and height [m] of the ground below the instance's foot, view depth [m];
//!           instance_look: in rg four numbers of 8 bits, square root of the reflectance and the share of the sun's light,
//!           above 0; in ba the normal

//@ include lib/octahedral.glsl
//@ include lib/pixel.glsl

flat in vec2 post;
in float height_m;
in vec3 instance_normal;
in vec4 instance_reflectance;
in vec4 instance_shape;
flat in float instance_half_width_m;

layout(location = 0) out uvec4 gbuffer_out;
layout(location = INSTANCE_LOOK) out vec4 instance_look_out;

#ifdef SPRITES
/// Shapes a point to a crown, which is rounded towards the eye and darker below.
/// @returns how far its surface is in front of its middle [m]
float instance_shaped(inout vec3 normal, inout vec3 reflectance) {
    vec2 at = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * instance_shape.xy;
    float top = 0.5 + 0.5 * at.y;
    float side = mix(sqrt(max(1.0 - at.y * at.y, 0.0)), 1.0 - top, instance_shape.z);
    if (abs(at.x) > side || abs(at.y) > 1.0) discard;
    float across = at.x / max(side, 0.05);
    vec3 ahead = normalize(pixel_ray_at(gl_FragCoord.xy));
    vec3 right = normalize(cross(ahead, frame.pixel_ray_dy.xyz)), up = cross(right, ahead);
    float rise = mix(at.y, 0.2, instance_shape.z);
    vec3 rounded = across * right + rise * up + sqrt(max(1.05 - across * across, 0.05)) * -ahead;
    normal = normalize(mix(normalize(rounded), normal, instance_shape.w));
    reflectance *= 0.75 + 0.5 * top;
    return instance_half_width_m * sqrt(max(side * side - at.x * at.x, 0.0));
}
#endif

void main() {
#ifdef NAN_SLIVERS
    if (isnan(height_m)) discard;  // as in geometry.frag.glsl
#endif
    vec3 normal = normalize(instance_normal), reflectance = instance_reflectance.rgb;
    float depth_m = 1.0 / gl_FragCoord.w;
#ifdef SPRITES
    depth_m -= min(instance_shaped(normal, reflectance), 0.5 * depth_m);
#endif
    vec2 direction = normal_octahedral(normal);
#ifdef TERRAIN_NORMAL_VERTEX
    uvec2 ground = uvec2(packSnorm2x16(direction), packUnorm2x16(post * frame.posts.zw));
#else
    uvec2 ground = floatBitsToUint(post);
#endif
    gbuffer_out = uvec4(ground, floatBitsToUint(height_m), floatBitsToUint(depth_m));
    vec4 colour = vec4(sqrt(clamp(reflectance, 0.0, 1.0)), clamp(instance_reflectance.a, 1.0 / 255.0, 1.0));
    instance_look_out = vec4(unpackUnorm2x16(packUnorm4x8(colour)), 0.5 + 0.5 * direction);
    store_varyings();
}

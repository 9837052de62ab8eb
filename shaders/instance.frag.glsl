//! provides  what is where, for pixels that show an instance of a plugin's mesh; terrain.frag.glsl shades them
//! writes    gbuffer: column and row of the post and height [m] of the ground below the instance's foot, view depth [m];
//!           instance_look: in rg four numbers of 8 bits, square root of the reflectance and the share of the sun's light,
//!           above 0; in ba the normal

//@ include lib/instances.glsl
//@ include lib/octahedral.glsl
//@ include lib/pixel.glsl

flat in vec2 post;
in float height_m;
in vec3 instance_normal;
in vec4 instance_reflectance;
in vec4 instance_shape;
flat in float instance_half_width_m;
flat in vec4 instance_clumps;
in vec3 instance_within;

layout(location = 0) out uvec4 gbuffer_out;
layout(location = INSTANCE_LOOK) out vec4 instance_look_out;

const float kRagged = 0.12;  // share of the width by which sprites have clumps beyond their edge, or gaps
const float kClump_m = 1.1;  // a clump of leaves

/// Clumps of leaves shade each other and face all ways, where they are larger than pixels.
/// @param within  place in the crown, as shares of half its width and height
void instance_clumped(in vec3 within, in float depth_m, inout vec3 normal, inout vec3 reflectance) {
    float size = instance_half_width_m / kClump_m, pixel_m = depth_m * length(frame.pixel_ray_dx.xyz);
    float strength = instance_clumps.z * (1.0 - smoothstep(0.3, 1.6, pixel_m / kClump_m));
    if (strength <= 0.0) return;
    vec3 p = size * within + 64.0 * vec3(instance_clumps.xy, instance_clumps.x + instance_clumps.y) + 256.0;
    ivec3 low = ivec3(floor(p - 0.5));
    vec4 clump = vec4(0.0);
    vec3 off = vec3(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 cell = low + ivec3(i & 1, i >> 1 & 1, i >> 2);
        vec3 chance = instances_random(cell.xy, uint(cell.z)).xyz;
        vec3 from = p - vec3(cell) - 0.5 - 0.8 * (chance.yzx - 0.5);
        float weight = exp2(-9.0 * dot(from, from));
        clump += weight * vec4(chance - 0.5, 1.0);
        off += weight * from;
    }
    clump.xyz /= clump.w + 1e-4;
    ivec3 leaf = ivec3(9.0 * p);
    vec3 leaves = instances_random(leaf.xy, uint(leaf.z)).xyz - 0.5;
    float leafy = smoothstep(0.01, 0.04, pixel_m / kClump_m) * (1.0 - smoothstep(0.04, 0.2, pixel_m / kClump_m));
    normal = normalize(normal + strength * (1.5 * clump.xyz + off / (clump.w + 0.1) + 0.9 * leafy * leaves));
    reflectance *= 1.0 + strength * (0.8 * clump.y + 0.25 * (min(clump.w, 0.8) - 0.5) + 0.6 * leafy * leaves.x);
}

#ifdef SPRITES
/// How far a crown reaches beyond its mean edge in a direction of the picture, -1..1 of mean 0; tiers of a conifer's boughs.
float instance_edge(in vec2 at) {
    vec2 way = at * inversesqrt(max(dot(at, at), 1e-4)), chance = 40.0 * instance_clumps.xy;
    float round = 0.6 * sin(4.0 * way.x + chance.x + 2.0 * sin(3.0 * way.y + chance.y)) + 0.4 * sin(13.0 * way.y + chance.y + 7.0 * way.x);
    return mix(round, sin(17.0 * at.y + chance.x) + 0.3 * round, 0.75 * instance_clumps.w);
}

/// Shapes a point to a crown, which is rounded towards the eye and darker below.
/// @returns how far its surface is in front of its middle [m]
float instance_shaped(inout vec3 normal, inout vec3 reflectance) {
    vec2 at = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0) * instance_shape.xy;
    float top = 0.5 + 0.5 * at.y;
    at /= 1.0 + kRagged * instance_clumps.z * instance_edge(at);
    float side = mix(sqrt(max(1.0 - at.y * at.y, 0.0)), 1.0 - top, instance_shape.z);
    if (abs(at.x) > side || abs(at.y) > 1.0) discard;
    float across = at.x / max(side, 0.05);
    vec3 ahead = normalize(pixel_ray_at(gl_FragCoord.xy));
    vec3 right = normalize(cross(ahead, frame.pixel_ray_dy.xyz)), up = cross(right, ahead);
    float rise = mix(at.y, 0.2, instance_shape.z);
    vec3 rounded = across * right + rise * up + sqrt(max(1.05 - across * across, 0.05)) * -ahead;
    vec3 ground = normal;
    normal = normalize(rounded);
    instance_clumped(vec3(at, sqrt(max(1.05 - dot(at, at), 0.0))), 1.0 / gl_FragCoord.w, normal, reflectance);
    normal = normalize(mix(normal, ground, instance_shape.w));
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
#else
    // Leaves stand out over the edge of a mesh, with gaps between them.
    float facing = abs(dot(normal, normalize(pixel_ray_at(gl_FragCoord.xy))));
    ivec3 leaf = ivec3(2.5 * instance_half_width_m * instance_within + 512.0 + 64.0 * instance_clumps.xyx);
    if (facing < 0.5 * instance_clumps.z * instances_random(leaf.xy, uint(leaf.z)).x) discard;
    instance_clumped(instance_within, depth_m, normal, reflectance);
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

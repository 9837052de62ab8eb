//! provides  instances_share: how many instances of a plugin are drawn as meshes at a distance; instances_random
//! source    M. Jarzynski, M. Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020: pcg4d

const float kInstance_px = 4.0;        // lowest instances that are drawn; render/instance_blocks.h: kLowest_px
const float kInstanceCells = 240.0;    // most cells from the eye; render/instance_blocks.h: kMostCells
const float kInstanceFade = 0.6;       // share of the range from which on they become fewer

/// Distance up to which instances are drawn [m]. @param height_m, spacing_m  of plugin.json
float instances_range_m(in float height_m, in float spacing_m) {
    float pixel = length(frame.pixel_ray_dx.xyz);
    return min(height_m / (kInstance_px * pixel), kInstanceCells * spacing_m);
}

/// Share of the instances that are drawn at a distance, 0..1. The plugin's cover of the ground shows the others.
float instances_share(in float distance_m, in float range_m) {
    return clamp((1.0 - distance_m / range_m) / (1.0 - kInstanceFade), 0.0, 1.0);
}

const int kInstanceMaps = 3;               // render/instance_shadows.h: kMaps
const float kInstanceMapEdge = 0.88;       // share of a map's half side up to which it is read

/// A point along the axes of the shadow maps, from the eye [m].
vec3 instances_shadow_along(in vec3 position_m) {
    return vec3(dot(frame.instance_shadow_axes[0].xyz, position_m), dot(frame.instance_shadow_axes[1].xyz, position_m),
                dot(frame.instance_shadow_axes[2].xyz, position_m));
}

/// A place in a shadow map: -1..1 over its sides, and 0..1 its depth. Receivers have all of that; what casts shadows may
/// lie beyond.
/// @param along  of instances_shadow_along()
/// @param map    of frame.instance_shadow_maps
vec3 instances_shadow_place(in vec3 along, in vec4 map) {
    vec3 at = (along + map.xyz) * map.w;
    return vec3(at.xy, 0.5 + 0.3 * at.z);
}

/// Weight of the drawn shadows towards the edge of the last map, 0..1.
float instances_shadow_weight(in vec3 position_m) {
    vec2 at = abs(instances_shadow_place(instances_shadow_along(position_m), frame.instance_shadow_maps[kInstanceMaps - 1]).xy);
    return frame.instance_shadow_weight * (1.0 - smoothstep(0.7, kInstanceMapEdge, max(at.x, at.y)));
}

/// Share of the instances whose shadows are drawn, 0..1. The plugin darkens ground and cover by the others in the mean.
/// @param position_m  relative to the eye
float instances_shadow_share(in vec3 position_m, in float range_m) {
    float distance_m = length(position_m - frame.instance_shadow_eye.xyz);
    return instances_shadow_weight(position_m) * instances_share(distance_m, range_m);
}

/// Four numbers of a cell of the grid of sites, 0..1. @param stream  other numbers of the same cell
vec4 instances_random(in ivec2 cell, in uint stream) {
    uvec4 v = uvec4(uvec2(cell), stream, 0x9e3779b9u) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return vec4(v >> 8u) / 16777216.0;
}

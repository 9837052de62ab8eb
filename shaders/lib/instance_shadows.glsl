//! provides  instance_sunlight: the share of the sun's light that instances of plugins let through to a point
//! reads     instance_shadows: three maps, one above the other, of what the sun sees of the instances
//! source    W. Reeves, D. Salesin, R. Cook, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH 1987:
//!           percentage-closer filtering

//@ include lib/instances.glsl

uniform sampler2D instance_shadows;  // of the crown nearest to the sun: 16 bits of depth, 8 of the light it lets through

const float kInstanceDepths = 65536.0;  // steps

/// By how much an instance has to lie behind another to be shaded by it: a little more than how far meshes differ from the
/// maps' crowns, and depths from texel to texel [m].
float instance_shadow_bias_m(in float texel_m) {
    return 0.4 + 1.5 * texel_m;
}

/// The finest map that has a place, and is not finer than pixels.
/// @param along   of instances_shadow_along()
/// @param number  of the map
vec4 instance_shadow_map(in vec3 along, in float distance_m, out float number) {
    number = float(kInstanceMaps - 1);
    vec4 map = frame.instance_shadow_maps[kInstanceMaps - 1];
    for (int finer = kInstanceMaps - 2; finer >= 0; --finer) {
        vec4 other = frame.instance_shadow_maps[finer];
        vec2 at = abs(along.xy + other.xy);
        bool inside = max(at.x, at.y) * other.w < kInstanceMapEdge && distance_m * other.w < 1.5;
        map = inside ? other : map;
        number = inside ? float(finer) : number;
    }
    return map;
}

/// Share of the sun's light, 0..1.
/// @param position_m  relative to the eye
float instance_sunlight(in vec3 position_m, in float distance_m, in bool is_instance) {
    float number, side = frame.instance_shadow_px;
    vec3 along = instances_shadow_along(position_m);
    vec4 map = instance_shadow_map(along, distance_m, number);
    along.z += is_instance ? instance_shadow_bias_m(2.0 / (map.w * side)) : 0.0;
    vec3 at = instances_shadow_place(along, map);

    vec2 texel = clamp((0.5 + 0.5 * at.xy) * side, vec2(1.0), vec2(side - 1.0)) - 0.5;
    vec2 corner = floor(texel), way = texel - corner;
    vec2 size = vec2(side, side * float(kInstanceMaps));
    vec4 stored = textureGather(instance_shadows, (corner + vec2(1.0, 1.0 + side * number)) / size) * kInstanceDepths;
    vec4 depth = floor(stored), light = (stored - depth) * (256.0 / 255.0);
    vec4 lit = mix(vec4(1.0), light, greaterThan(depth, vec4(at.z * kInstanceDepths)));
    float below = mix(lit.w, lit.z, way.x), above = mix(lit.x, lit.y, way.x);
    return mix(1.0, mix(below, above, way.y), instances_shadow_weight(position_m));
}

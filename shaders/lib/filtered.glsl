//! provides  filtered: linear filtering of level 0 of a texture that clamps, with weights of 32 bits
//!
//! Filters of GPUs have weights of 8 bits, which show as steps of light where a texel covers hundreds of pixels. Those of
//! software renderers (EXACT_FILTERS) have 32, and are faster there than four or eight reads.

#ifdef EXACT_FILTERS

vec4 filtered(in sampler2DArray from, in vec3 at) { return textureLod(from, at, 0.0); }
vec4 filtered(in sampler3D from, in vec3 at) { return textureLod(from, at, 0.0); }

#else

/// @param at  columns and rows from 0 to 1, and the layer
vec4 filtered(in sampler2DArray from, in vec3 at) {
    ivec3 size = textureSize(from, 0);
    vec2 texel = at.xy * vec2(size.xy) - 0.5;
    vec2 weight = fract(texel);
    int layer = int(at.z + 0.5);
    ivec2 last = size.xy - 1;
    ivec2 a = clamp(ivec2(floor(texel)), ivec2(0), last);
    ivec2 b = clamp(ivec2(floor(texel)) + 1, ivec2(0), last);
    vec4 low = mix(texelFetch(from, ivec3(a.x, a.y, layer), 0), texelFetch(from, ivec3(b.x, a.y, layer), 0), weight.x);
    vec4 high = mix(texelFetch(from, ivec3(a.x, b.y, layer), 0), texelFetch(from, ivec3(b.x, b.y, layer), 0), weight.x);
    return mix(low, high, weight.y);
}

/// @param at  columns, rows and slices from 0 to 1
vec4 filtered(in sampler3D from, in vec3 at) {
    ivec3 size = textureSize(from, 0);
    vec3 texel = at * vec3(size) - 0.5;
    vec3 weight = fract(texel);
    ivec3 last = size - 1;
    ivec3 a = clamp(ivec3(floor(texel)), ivec3(0), last);
    ivec3 b = clamp(ivec3(floor(texel)) + 1, ivec3(0), last);
    vec4 slices[2];
    for (int k = 0; k < 2; ++k) {
        int z = k == 0 ? a.z : b.z;
        vec4 low = mix(texelFetch(from, ivec3(a.x, a.y, z), 0), texelFetch(from, ivec3(b.x, a.y, z), 0), weight.x);
        vec4 high = mix(texelFetch(from, ivec3(a.x, b.y, z), 0), texelFetch(from, ivec3(b.x, b.y, z), 0), weight.x);
        slices[k] = mix(low, high, weight.y);
    }
    return mix(slices[0], slices[1], weight.z);
}

#endif

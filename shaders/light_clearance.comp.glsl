#version 450 core
//! computes  light_clearance and the first level of light_fraction from the shadows of the sun's limbs and centre: each
//!           invocation computes the 2 x 2 posts of a texel of light_fraction
//! figures   those of core/light/raster/clearance.h, post_loops.cpp (straighten) and core/render/shadow_texels.cpp

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer Heights { float heights[]; };
layout(std430, binding = 1) readonly buffer Upper { float upper[]; };
layout(std430, binding = 2) readonly buffer Middle { float middle[]; };
layout(std430, binding = 3) readonly buffer Lower { float lower[]; };
layout(binding = 0, rg16ui) writeonly uniform uimage2D clearances;  // bits of half floats
layout(binding = 1, rg8) writeonly uniform image2D fractions;

layout(location = 0) uniform int columns;
layout(location = 1) uniform int rows;
layout(location = 2) uniform int heights_pitch;
layout(location = 3) uniform int heights_column;  // of the first post

const float kNoGround = -1e20;
const float kMaxClearance_m = 60000.0;
const uint kVoid = 0x7bffu;  // GroundLight::kVoidClearance

/// As height_of_disc(): x, y and z are the clearances of the upper limb, the centre and the lower limb.
float height_of_disc(in vec3 clearance) {
    const float kAhead = 0.35;
    precise float up = max(clearance.x - clearance.y, 1e-6);
    precise float down = max(clearance.y - clearance.z, 1e-6);
    precise float line = -clearance.y / (clearance.y > 0.0 ? down : up);
    precise float other = max(-clearance.y / (clearance.y > 0.0 ? up : down), -1.0);
    precise float at = line + kAhead * (min(other, line) - line);
    precise float height = 0.5 - 0.5 * at;
    return min(max(height, 1e-4), 1.0);
}

/// As straighten(): the lower limb's clearance.
float straight_lower(in vec3 clearance) {
    if (!(clearance.x > 0.0 && clearance.z < 0.0)) return clearance.z;
    precise float straight = clearance.x - clearance.x / height_of_disc(clearance);
    return straight;
}

uint to_half(in float value) {
    uint bits = floatBitsToUint(value), size = bits & 0x7fffffffu;
    uint rounded = (size - (112u << 23) + 0x1000u) >> 13;
    return (bits >> 16 & 0x8000u) | (size < (113u << 23) ? 0u : rounded);
}

float share_of_disc(in float height) {
    float x = height < 0.5 ? height : 1.0 - height;
    precise float part = x * sqrt(x) * (1.6977 - 0.567 * x);
    return height < 0.5 ? part : 1.0 - part;
}

/// Stores the clearances of a post. @returns visible fraction of the disc, and coverage, 0 to 255
ivec2 make_post(in ivec2 post) {
    float height_m = heights[post.y * heights_pitch + post.x + heights_column];
    if (height_m < kNoGround) {
        imageStore(clearances, post, uvec4(kVoid, kVoid, 0u, 0u));
        return ivec2(0);
    }
    int at = post.y * columns + post.x;
    precise vec3 clearance = height_m - vec3(upper[at], middle[at], lower[at]);
    float upper_m = clamp(clearance.x, -kMaxClearance_m, kMaxClearance_m);
    float lower_m = clamp(straight_lower(clearance), -kMaxClearance_m, kMaxClearance_m);
    imageStore(clearances, post, uvec4(to_half(upper_m), to_half(lower_m), 0u, 0u));
    precise float height = clamp(upper_m / max(upper_m - lower_m, 1e-3), 0.0, 1.0);
    precise float seen = 255.0 * (lower_m >= 0.0 ? 1.0 : share_of_disc(height)) + 0.5;
    return ivec2(int(seen), 255);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), first = 2 * texel;
    if (first.x >= columns || first.y >= rows) return;
    ivec2 next = min(first + 1, ivec2(columns, rows) - 1);
    ivec2 sum = make_post(first) + make_post(ivec2(next.x, first.y)) + make_post(ivec2(first.x, next.y)) +
                make_post(next);
    imageStore(fractions, texel, vec4(vec2((sum + 2) / 4) / 255.0, 0.0, 0.0));
}

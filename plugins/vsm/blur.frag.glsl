// Blurs mean and variance of height along columns; see moments.frag.glsl.
//
// values[0]: x: weight of the texel, y: of each neighbour; they add up to 1
layout(binding = 0) uniform sampler2D rows;

layout(location = 0) out vec2 moments;

vec2 moments_at(ivec2 texel) {
    return texelFetch(rows, ivec2(texel.x, clamp(texel.y, 0, textureSize(rows, 0).y - 1)), 0).rg;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec2 before = moments_at(texel - ivec2(0, 1)), here = moments_at(texel);
    vec2 behind = moments_at(texel + ivec2(0, 1));
    vec2 mean = values[0].x * here + values[0].y * (before + behind);
    float slope = 0.5 * (behind.x - before.x);
    vec3 off = vec3(before.x + slope, here.x, behind.x - slope) - mean.x;
    moments = vec2(mean.x, mean.y + dot(values[0].yxy, off * off));
}

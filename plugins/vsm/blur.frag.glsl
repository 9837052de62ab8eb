// Blurs along columns.
// values[0]: x: layer that is read
// values[1]: weights of the texel, its neighbours, and theirs; they add up to 1 over all five
layout(binding = 0) uniform sampler2D rows;

layout(location = 0) out vec2 moments;

vec2 moments_at(ivec2 texel) {
    return texelFetch(rows, ivec2(texel.x, clamp(texel.y, 0, textureSize(rows, 0).y - 1)), 0).rg;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec2 before = moments_at(texel - ivec2(0, 1)), here = moments_at(texel);
    vec2 behind = moments_at(texel + ivec2(0, 1));
    vec2 mean = values[1].x * here + values[1].y * (before + behind);
    float slope = 0.5 * (behind.x - before.x);
    vec3 off = vec3(before.x + slope, here.x, behind.x - slope) - mean.x;
    moments = vec2(mean.x, mean.y + dot(values[1].yxy, off * off));
}

// Blurs mean and variance of height along columns; see moments.frag.glsl.
//
// values[0]: x: weight of the texel, y: of each neighbour; they add up to 1
// values[1]: yz: 1 / columns and 1 / rows
layout(binding = 0) uniform sampler2D rows;

layout(location = 0) out vec2 moments;

vec2 moments_at(float row) {
    return textureLod(rows, vec2(gl_FragCoord.x, row) * values[1].yz, 0.0).rg;
}

void main() {
    vec2 before = moments_at(gl_FragCoord.y - 1.0), here = moments_at(gl_FragCoord.y);
    vec2 behind = moments_at(gl_FragCoord.y + 1.0);
    vec2 mean = values[0].x * here + values[0].y * (before + behind);
    float slope = 0.5 * (behind.x - before.x);
    vec3 off = vec3(before.x + slope, here.x, behind.x - slope) - mean.x;
    moments = vec2(mean.x, mean.y + dot(values[0].yxy, off * off));
}

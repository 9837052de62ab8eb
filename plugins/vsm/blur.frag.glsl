// Blurs along columns.
// values[0]: x: layer that is read
// values[1]: weights of the texel, its neighbours, and theirs; they add up to 1 over all five
layout(binding = 0) uniform sampler2D rows;

layout(location = 0) out vec2 moments;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    moments = vec2(0.0);
    for (int i = -2; i <= 2; ++i) {
        ivec2 at = ivec2(texel.x, clamp(texel.y + i, 0, textureSize(rows, 0).y - 1));
        moments += values[1][abs(i)] * texelFetch(rows, at, 0).rg;
    }
}

#version 450 core
//! computes  a level of light_fraction: the means of 2 x 2 texels of the finer one

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rg8) readonly uniform image2D fine;
layout(binding = 1, rg8) writeonly uniform image2D coarse;

ivec2 whole(in ivec2 texel) {
    return ivec2(255.0 * imageLoad(fine, texel).rg + 0.5);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), first = 2 * texel;
    if (any(greaterThanEqual(texel, imageSize(coarse)))) return;
    ivec2 sum = whole(first) + whole(first + ivec2(1, 0)) + whole(first + ivec2(0, 1)) + whole(first + 1);
    imageStore(coarse, texel, vec4(vec2((sum + 2) / 4) / 255.0, 0.0, 0.0));
}

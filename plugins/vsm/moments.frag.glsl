// From depth to mean and variance of height, blurred along rows.
//
// The variance is about the line through a texel's neighbours: a slope has none, an edge and a crease
// do. Variance about the mean would take every slope for an edge and hide shadows as shallow as a
// texel is tall.
//
// values[0]: height = x * column + y * row + z * depth + w, column and row of the texel's middle
// values[1]: x: the height where there is no ground [m], yz: 1 / columns and 1 / rows
// values[2]: x: weight of the texel, y: of each neighbour; they add up to 1
layout(binding = 0) uniform sampler2D depth;

layout(location = 0) out vec2 moments;

float height_at(float column) {
    float d = textureLod(depth, vec2(column, gl_FragCoord.y) * values[1].yz, 0.0).r;
    float height = dot(values[0], vec4(column, gl_FragCoord.y, d, 1.0));
    return d > 0.0 ? height : values[1].x;
}

void main() {
    float before = height_at(gl_FragCoord.x - 1.0), here = height_at(gl_FragCoord.x);
    float behind = height_at(gl_FragCoord.x + 1.0);
    float mean = values[2].x * here + values[2].y * (before + behind);
    float slope = 0.5 * (behind - before);
    vec3 off = vec3(before + slope, here, behind - slope) - mean;
    moments = vec2(mean, dot(values[2].yxy, off * off));
}

//! provides  smooth silhouettes, drawn where edges.frag.glsl has marked them
//! reads     colour: sRGB; edge_depth, reversed
//! writes    colour: sRGB
//! source    after T. Lottes, FXAA (NVIDIA white paper, 2009): find the edge, walk to its two ends, and
//!           move the sample across it by how near the closer end is
//!
//! Edges are steps of depth, not of brightness: ground textures are filtered already and stay sharp. The
//! filter is a tent as wide as two pixels, so that an edge between two pixels blends both a little, too: of
//! a box, long edges that are nearly level would keep their steps.

//@ include lib/edge_depth.glsl

uniform sampler2D colour;

layout(location = 0) out vec4 colour_out;

const int kSteps = 12;  // how far an edge is followed each way [px]

float depth_at(in ivec2 pixel) {
    return edge_depth(clamp(pixel, ivec2(0), ivec2(frame.viewport.xy) - 1));
}

/// Steps from `pixel` along an edge until the mean of its two sides is no longer `middle`.
/// @param miss  by how much it differs there; within the tolerance where no end was found
int steps_to_end(in ivec2 pixel, in ivec2 along, in ivec2 across, in float middle, in float tolerance,
                 out float miss) {
    int steps = 0;
    miss = 0.0;
    while (steps < kSteps && abs(miss) <= tolerance) {
        ++steps;
        ivec2 at = pixel + along * steps;
        miss = 0.5 * (depth_at(at) + depth_at(at + across)) - middle;
    }
    return steps;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float here = depth_at(pixel);
    vec2 next = vec2(depth_at(pixel + ivec2(1, 0)), depth_at(pixel + ivec2(0, 1)));
    vec2 back = vec2(depth_at(pixel - ivec2(1, 0)), depth_at(pixel - ivec2(0, 1)));
    vec2 bend = abs(next + back - 2.0 * here);
    bool horizontal = bend.y >= bend.x;  // the edge runs along x
    ivec2 along = horizontal ? ivec2(1, 0) : ivec2(0, 1);
    ivec2 across = along.yx;
    float beyond = horizontal ? next.y : next.x;
    float behind = horizontal ? back.y : back.x;
    if (abs(beyond - here) < abs(behind - here)) {
        across = -across;
        beyond = behind;
    }
    float middle = 0.5 * (here + beyond);
    float tolerance = 0.25 * abs(beyond - here);
    float miss_back, miss_on;
    int back_steps = steps_to_end(pixel, -along, across, middle, tolerance, miss_back);
    int on_steps = steps_to_end(pixel, along, across, middle, tolerance, miss_on);
    float miss = back_steps < on_steps ? miss_back : miss_on;
    // At its nearer end the edge moves by half a pixel to one side, in its middle by nothing.
    float moves = abs(miss) > tolerance
                      ? 0.5 - float(min(back_steps, on_steps)) / float(back_steps + on_steps)
                      : 0.0;
    bool moves_here = (miss > 0.0) == (beyond > here);
    float away = 0.5 + (moves_here ? -moves : moves);  // from the pixel's centre to the edge [px]
    float amount = 0.5 * (1.0 - away) * (1.0 - away);
    vec2 at = gl_FragCoord.xy + amount * vec2(across);
    colour_out = textureLod(colour, at * frame.viewport.zw, 0.0);
}

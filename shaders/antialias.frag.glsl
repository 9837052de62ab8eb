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

/// An end of an edge: how far it is [px], and which way the edge moves there.
struct End {
    int steps;
    int moves;  // 1 to this side of it, -1 to the other one; 0 where no end was found
};

/// Follows an edge until its step is gone: both pixels then show the side that the edge moves away from.
/// Depths may change along the edge as they like.
End end_of_edge(in ivec2 pixel, in ivec2 along, in ivec2 across, in float here, in float beyond) {
    float least = 0.5 * abs(beyond - here);
    bool up = beyond > here;
    End end = End(0, 0);
    while (end.steps < kSteps && end.moves == 0) {
        ++end.steps;
        ivec2 at = pixel + along * end.steps;
        float a = depth_at(at), b = depth_at(at + across);
        if (abs(b - a) < least || (b > a) != up)
            end.moves = abs(a - beyond) + abs(b - beyond) < abs(a - here) + abs(b - here) ? 1 : -1;
        else {
            here = a;
            beyond = b;
        }
    }
    return end;
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
    End before = end_of_edge(pixel, -along, across, here, beyond);
    End after = end_of_edge(pixel, along, across, here, beyond);
    // At its nearer end the edge is half a pixel to one side, in its middle between the pixels.
    int moves = before.steps < after.steps ? before.moves : after.moves;
    float share = float(min(before.steps, after.steps)) / float(before.steps + after.steps);
    float away = 0.5 - float(moves) * (0.5 - share);  // from the pixel's centre to the edge [px]
    float amount = 0.5 * (1.0 - away) * (1.0 - away);
    vec2 at = gl_FragCoord.xy + amount * vec2(across);
    colour_out = textureLod(colour, at * frame.viewport.zw, 0.0);
}

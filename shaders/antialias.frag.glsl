//! provides  smooth silhouettes
//! reads     colour: sRGB; place (geometry.frag.glsl) for depth
//! writes    colour: sRGB
//! source    after T. Lottes, FXAA (NVIDIA white paper, 2009): find the edge, walk to its two ends, and
//!           move the sample across it by how near the closer end is
//!
//! Edges are steps of depth, not of brightness: ground textures are filtered already and stay sharp.

uniform sampler2D colour;
uniform usampler2D place;

layout(location = 0) out vec4 colour_out;

const int kSteps = 12;         // how far an edge is followed each way [px]
const float kEdge = 0.04;      // smallest step of log2 depth that is an edge, 3 %
const float kSky = 24.0;       // log2 of the depth that the sky counts as

float log_depth(in ivec2 pixel) {
    uint bits = texelFetch(place, clamp(pixel, ivec2(0), ivec2(frame.viewport.xy) - 1), 0).w;
    return bits == 0u ? kSky : log2(uintBitsToFloat(bits));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float here = log_depth(pixel);
    float right = log_depth(pixel + ivec2(1, 0));
    float left = log_depth(pixel - ivec2(1, 0));
    float above = log_depth(pixel + ivec2(0, 1));
    float below = log_depth(pixel - ivec2(0, 1));
    // The second difference: a plane seen at a slant has none, a silhouette has.
    vec2 step_along = vec2(abs(right - here), abs(above - here));
    vec2 step_back = vec2(abs(here - left), abs(here - below));
    vec2 bend = abs(vec2(right + left, above + below) - 2.0 * here);
    vec2 offset = vec2(0.0);

    // A loop of no or one turn: unlike an `if`, a software renderer skips it where no pixel of a
    // block needs it.
    for (int needed = int(max(bend.x, bend.y) > kEdge); needed > 0; --needed) {
        bool horizontal = bend.y >= bend.x;  // the edge runs along x
        ivec2 along = horizontal ? ivec2(1, 0) : ivec2(0, 1);
        ivec2 across = horizontal ? ivec2(0, 1) : ivec2(1, 0);
        float ahead = horizontal ? above : right;
        float behind = horizontal ? below : left;
        bool forward = abs(ahead - here) >= abs(behind - here);
        if (!forward) across = -across;
        float other = forward ? ahead : behind;
        float middle = 0.5 * (here + other);
        float tolerance = 0.25 * abs(other - here);

        // Walk along the edge until the mean of its two sides is no longer that of this place.
        int ends[2];
        float misses[2];
        for (int way = 0; way < 2; ++way) {
            ivec2 walk = way == 0 ? -along : along;
            int distance = 0;
            float miss = 0.0;
            while (distance < kSteps && abs(miss) <= tolerance) {
                ++distance;
                ivec2 at = pixel + walk * distance;
                miss = 0.5 * (log_depth(at) + log_depth(at + across)) - middle;
            }
            ends[way] = distance;
            misses[way] = miss;
        }
        int nearer = ends[0] < ends[1] ? 0 : 1;
        // Only the pixels on the side that the edge moves to at its nearer end are blended.
        bool moves_here = (misses[nearer] > 0.0) == (other > here);
        float length_px = float(ends[0] + ends[1]);
        float amount = 0.5 - float(ends[nearer]) / length_px;
        if (moves_here && abs(misses[nearer]) > tolerance) offset = vec2(across) * max(amount, 0.0);
    }
    colour_out = vec4(textureLod(colour, (gl_FragCoord.xy + offset) * frame.viewport.zw, 0.0).rgb, 1.0);
}

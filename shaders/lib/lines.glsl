//! provides  lines_near: the nearest line of a texture of kind `lines`, on the ground and in the picture
//! reads     gbuffer: depths of the pixels around
//! source    core/render/line_index.h has the layout of the texture, and how exact it is
//!
//! A sampler of such a texture is the first argument: `uniform sampler2D tracks_way;`.

//@ include lib/ground.glsl
//@ include lib/pages.glsl
//@ include lib/pixel.glsl

const float lines_none = 1e9;         // distance where no line is known
const float lines_no_value = -1e30;   // attribute of a line that has none
const int lines_most = 1023;           // segments of a cell

/// The lines around a point. Distances up to the reach that was asked for are exact; greater ones only
/// say that they are greater.
struct LineHit {
    float pixels;   // to the line that is nearest in the picture [px]
    float along_m;  // of the nearest point of that line, from its start [m]
    float value;    // its attribute, or lines_no_value
    int line;       // its number in the file, from 0; -1: none
    float metres;   // to the line that is nearest on the ground [m]
    float step_m;   // how `metres` changes over a pixel [m/px]
    float along_step_m;  // how `along_m` changes over a pixel [m/px]
};

/// A place on the DEM, exact also where posts are many metres wide.
struct LinesPlace {
    vec2 whole;  // column and row [posts], whole parts
    vec2 rest;   // what is missing of them
};

vec4 lines_texel(in sampler2D lines, in int address) {
    return texelFetch(lines, ivec2(address & 4095, address >> 12), 0);
}

/// East and north parts of a step, at the height of the ellipsoid.
vec2 lines_level(in vec3 step_m, in vec3 up, in float height_m) {
    const float earth_m = 6371000.0;
    vec3 east = east_at(up);
    return vec2(dot(step_m, east), dot(step_m, cross(up, east))) * (earth_m / (earth_m + height_m));
}

/// Height above the ellipsoid as drawn [m].
float lines_height(in Surface s) {
    return frame.eye_m.w + dot(s.position_m, frame.eye_up.xyz);
}

/// Near the eye a point has its place from there: floats of posts are too coarse for its pixels.
LinesPlace lines_place(in Surface s) {
    const float near_m = 2000.0;    // on flat axes: off by 0.3 m at the end, where a pixel is larger
    const float ulps = 64.0;        // of a post, less than a pixel
    LinesPlace place = LinesPlace(floor(s.post), fract(s.post));
    bool known = dot(frame.eye_axes, frame.eye_axes) > 0.0;
    if (known && s.distance_m < near_m && s.pixel_posts < ulps * 1.2e-7 * max(s.post.x, s.post.y)) {
        vec2 level = lines_level(s.position_m, frame.eye_up.xyz, lines_height(s));
        place.whole = frame.eye_post.xy;
        place.rest = frame.eye_post.zw + level.x * frame.eye_axes.xy + level.y * frame.eye_axes.zw;
    }
    return place;
}

/// 1 / depth of a pixel [1/m]; 0 where it shows no ground.
float lines_near_at(in ivec2 pixel) {
    float depth = uintBitsToFloat(texelFetch(gbuffer, pixel, 0).w);
    return depth > 0.0 ? 1.0 / depth : 0.0;
}

/// How 1 / depth changes to the next pixel of an axis. It is linear over a plane in the picture. Of both
/// sides the one that changes less is on the same ground, unless that is a pixel wide.
/// @param limit  lines_depth_limit()
float lines_depth_step(in ivec2 pixel, in ivec2 axis, in float here, in float limit) {
    ivec2 last = ivec2(frame.viewport.xy) - 1;
    ivec2 before = max(pixel - axis, ivec2(0)), after = min(pixel + axis, last);
    float down = here - lines_near_at(before), up = lines_near_at(after) - here;
    if (before == pixel) down = up;  // at the edge of the picture
    if (after == pixel) up = down;
    return clamp(abs(up) < abs(down) ? up : down, -limit, limit);
}

/// The most that 1 / depth changes to the next pixel right and up, by the DEM's normal, which is less exact.
vec2 lines_depth_limit(in Surface s, in float here) {
    const float most = 4.0;  // times what the normal gives
    vec3 normal = s.geometric_normal / min(dot(s.geometric_normal, s.position_m), -1e-3 * s.distance_m);
    vec2 plane = vec2(dot(normal, frame.pixel_ray_dx.xyz), dot(normal, frame.pixel_ray_dy.xyz));
    return most * (abs(plane) + here * length(frame.pixel_ray_dx.xyz));
}

/// The ground around a pixel as a plane. A point d pixels away is step_m d / (1 + horizon . d) metres away.
struct LinesPixel {
    mat2 step_m;   // steps on the ground to the next pixel right and up, east and north [m/px]
    vec2 horizon;  // how the depth's inverse changes to these, as shares of it
};

#ifdef ORTHOGRAPHIC
/// Of a map: rays are parallel. @param metres  from columns and rows to metres east and north
LinesPixel lines_pixel(in mat2 metres) {
    return LinesPixel(metres * pixel_step_on_map(), vec2(0.0));
}
#else
LinesPixel lines_pixel(in Surface s) {
    vec3 ray = pixel_ray_at(gl_FragCoord.xy);
    float depth = s.distance_m / length(ray);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 limit = lines_depth_limit(s, 1.0 / depth);
    float right = lines_depth_step(pixel, ivec2(1, 0), 1.0 / depth, limit.x);
    float up = lines_depth_step(pixel, ivec2(0, 1), 1.0 / depth, limit.y);
    float height_m = lines_height(s);
    mat2 step_m = mat2(lines_level(depth * (frame.pixel_ray_dx.xyz - ray * depth * right), s.up, height_m),
                       lines_level(depth * (frame.pixel_ray_dy.xyz - ray * depth * up), s.up, height_m));
    return LinesPixel(step_m, depth * vec2(right, up));
}
#endif

/// Both steps together [m/px].
float lines_longest(in mat2 step_m) {
    return sqrt(dot(step_m[0], step_m[0]) + dot(step_m[1], step_m[1]));
}

/// Inverse of a step, large where the ground is seen from its edge.
mat2 lines_to_pixels(in mat2 step_m) {
    float area = step_m[0].x * step_m[1].y - step_m[0].y * step_m[1].x;
    float least = 1e-6 * dot(step_m[0], step_m[0]) + 1e-6 * dot(step_m[1], step_m[1]) + 1e-20;
    area = area < 0.0 ? min(area, -least) : max(area, least);
    return mat2(step_m[1].y, -step_m[0].y, -step_m[1].x, step_m[0].x) * (1.0 / area);
}

/// Place relative to a corner that is stored as whole parts and fractions [posts].
vec2 lines_from(in LinesPlace place, in vec4 corner) {
    return (place.whole - corner.xy) + (place.rest - corner.zw);
}

/// Address of the node whose cell is as wide as a level asks for, or wider; 0: no lines.
int lines_node(in sampler2D lines, in LinesPlace place, in int level) {
    vec4 head = lines_texel(lines, 0);
    int top = int(head.x), base = int(head.y);
    int table = clamp(level, base, top);
    vec4 corner = lines_texel(lines, 1 + 2 * (top - table));
    vec4 size = lines_texel(lines, 2 + 2 * (top - table));
    vec2 cell = floor(lines_from(place, corner) * exp2(-float(table)));
    if (any(lessThan(cell, vec2(0.0))) || any(greaterThanEqual(cell, size.xy))) return 0;
    int node = int(lines_texel(lines, int(size.z) + int(cell.y) * int(size.x) + int(cell.x)).x);
    const int most = 40;  // levels
    for (int i = level < base && node != 0 ? 0 : most; i < most; ++i) {
        vec4 about = lines_texel(lines, node);
        if (node == 0 || about.y > 0.0 || int(about.z) <= level) break;
        vec2 half_cell = lines_from(place, lines_texel(lines, node + 1)) * exp2(1.0 - about.z);
        vec4 finer = lines_texel(lines, node + 3);
        vec2 row = half_cell.y < 1.0 ? finer.xy : finer.zw;
        node = int(half_cell.x < 1.0 ? row.x : row.y);
    }
    return node;
}

/// From the origin to the nearest point of a segment.
vec2 lines_segment(in vec2 a, in vec2 b) {
    vec2 along = b - a;
    return a + clamp(-dot(a, along) / max(dot(along, along), 1e-30), 0.0, 1.0) * along;
}

/// The same in the picture [px]. @param a, b  ends, in pixels if the depth were that of the origin
vec2 lines_drawn(in vec2 a, in vec2 b, in vec2 horizon) {
    const float nearest = 0.05;  // depth, as a share of the origin's: what is nearer is cut
    float at_a = 1.0 - dot(horizon, a), at_b = 1.0 - dot(horizon, b);
    if (max(at_a, at_b) < nearest) return vec2(lines_none);
    float cut = (nearest - at_a) / (abs(at_b - at_a) > 1e-12 ? at_b - at_a : 1e-12);
    vec2 at_cut = mix(a, b, cut);
    if (at_a < nearest) return lines_segment(at_cut / nearest, b / at_b);
    if (at_b < nearest) return lines_segment(a / at_a, at_cut / nearest);
    return lines_segment(a / at_a, b / at_b);
}

/// The lines of a node around a place.
LineHit lines_in_node(in sampler2D lines, in int node, in LinesPlace place, in LinesPixel pixel) {
    vec4 metric = lines_texel(lines, node + 2);
    mat2 metres = mat2(metric.xy, metric.zw);
#ifdef ORTHOGRAPHIC
    pixel = lines_pixel(metres);
#endif
    mat2 to_pixels = lines_to_pixels(pixel.step_m);
    vec2 here = lines_from(place, lines_texel(lines, node + 1));
    int count = int(lines_texel(lines, node).x), first = node + 4, nearest = 0;
    float pixels = lines_none * lines_none, on_ground = pixels;
    vec2 towards = vec2(0.0);
    vec2 away_px = vec2(0.0);
    for (int i = 0; i < lines_most; ++i) {
        if (i >= count) break;
        vec4 segment = lines_texel(lines, first + i);
        vec2 a = metres * (segment.xy - here), b = metres * (segment.zw - here);
        vec2 ground = lines_segment(a, b);
        if (dot(ground, ground) < on_ground) {
            on_ground = dot(ground, ground);
            towards = ground;
        }
        vec2 drawn = lines_drawn(to_pixels * a, to_pixels * b, pixel.horizon);
        if (dot(drawn, drawn) < pixels) {
            pixels = dot(drawn, drawn);
            nearest = i;
            away_px = drawn;
        }
    }
    vec4 segment = lines_texel(lines, first + nearest);
    vec4 two = lines_texel(lines, first + count + nearest / 2);
    vec2 along = (nearest & 1) == 0 ? two.xy : two.zw;
    float lines_at = lines_texel(lines, 0).w;
    float across_m = length((towards / max(sqrt(on_ground), 1e-12)) * pixel.step_m);
    vec2 way = metres * (segment.zw - segment.xy);
    float length_m = max(length(way), 1e-9);
    vec2 reached = pixel.step_m * away_px / max(1.0 + dot(pixel.horizon, away_px), 1e-3);
    float at_m = clamp(dot(reached - metres * (segment.xy - here), way) / length_m, 0.0, length_m);
    return LineHit(sqrt(pixels), along.x + at_m,
                   lines_texel(lines, int(lines_at + along.y)).x, int(along.y), sqrt(on_ground),
                   max(across_m, 1e-9), max(length((way / length_m) * pixel.step_m), 1e-9));
}

/// Level of the cells whose lists have all lines within a reach: half their side is complete.
/// @param longest_m  steps on the ground to the next pixels, together [m/px]
int lines_level_of(in float longest_m, in vec2 horizon, in float reach_px, in float reach_m, in float post_m) {
    const float most = 0.9;  // of the way to the horizon
    float far_m = reach_px * longest_m / (1.0 - min(reach_px * length(horizon), most));
    return int(ceil(log2(max(2.0 * max(far_m, reach_m) / post_m, 1e-9))));
}

/// Whether lines may be within a reach of a point: reads nothing of the pixels around.
bool lines_may_be_near(in sampler2D lines, in Surface s, in LinesPlace place, in float reach_px, in float reach_m) {
    vec4 head = lines_texel(lines, 0);
    if (head.x < head.y) return false;
#ifdef ORTHOGRAPHIC
    vec2 horizon = vec2(0.0);
    float longest_m = lines_longest(lines_pixel(mat2(head.z)).step_m);
#else
    float ray = length(pixel_ray_at(gl_FragCoord.xy));
    vec2 horizon = (s.distance_m / ray) * lines_depth_limit(s, ray / s.distance_m);
    float longest_m = (s.distance_m / ray) * (1.5 * length(frame.pixel_ray_dx.xyz) + ray * length(horizon));
#endif
    return lines_node(lines, place, lines_level_of(longest_m, horizon, reach_px, reach_m, head.z)) != 0;
}

/// The same as lines_near() for a point and its place.
LineHit lines_search(in sampler2D lines, in Surface s, in LinesPlace place, in float reach_px, in float reach_m) {
#ifdef ORTHOGRAPHIC
    LinesPixel pixel = lines_pixel(mat2(lines_texel(lines, 0).z));  // by the width of a post
#else
    LinesPixel pixel = lines_pixel(s);
#endif
    int level = lines_level_of(lines_longest(pixel.step_m), pixel.horizon, reach_px, reach_m, lines_texel(lines, 0).z);
    int node = lines_node(lines, place, level);
    if (node == 0 || lines_texel(lines, node).x < 1.0)
        return LineHit(lines_none, 0.0, lines_no_value, -1, lines_none, 1.0, 1.0);
    return lines_in_node(lines, node, place, pixel);
}

/// The nearest line of a texture of kind `lines`.
/// @param reach_px, reach_m  how far lines are searched, the farther of both. The smaller, the faster
LineHit lines_near(in sampler2D lines, in Surface s, in float reach_px, in float reach_m) {
    LineHit hit = LineHit(lines_none, 0.0, lines_no_value, -1, lines_none, 1.0, 1.0);
    LinesPlace place = lines_place(s);
    // A loop, because software devices skip loops that no pixel of a group enters, and no branches.
    int times = lines_may_be_near(lines, s, place, reach_px, reach_m) ? 1 : 0;
    for (int i = 0; i < times; ++i)
        hit = lines_search(lines, s, place, reach_px, reach_m);
    return hit;
}

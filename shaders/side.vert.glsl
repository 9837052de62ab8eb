//! provides  the cut sides of a DEM that is seen from outside: a wall below each edge of the drawn ground
//! reads     a tile's net and height page, as terrain.vert.glsl does, so that walls meet the ground as it
//!           is drawn, whatever its level and however far it has morphed
//! writes    position [m, relative to the eye], height [m], that of the ground, share of the way down, direction
//!           outwards
//!
//! An edge is one of two kinds: a step along the DEM's rim, or the line on which a triangle of the ground
//! is cut because a corner of it has no height.

//@ include lib/finite.glsl
//@ include lib/tile.glsl

layout(location = 13) in vec4 ends;  // xy, zw: two corners, in vertices of the tile
layout(location = 14) in vec4 third;  // xy: the third one, x below 0 on the rim; z: 1 the edge's other end; w: 1 down

out vec3 side_position_m;
out float side_height_m;
out float side_ground_m;  // height of the ground at the wall's top, that effects may have moved the wall up from
out float side_depth;
out vec3 side_outwards;  // away from the ground beside a hole, of no length on the rim

/// A corner of the ground as it is drawn.
struct SideCorner {
    vec2 at;  // 0..1 over the tile's part of the DEM
    vec3 position_m;
    float height_m;
    float coverage;
    float moved_m;  // up, by effects
};

SideCorner corner(in vec2 grid) {
    vec4 levels = texelFetch(height_pages, net_texel(grid), 0);
    vec2 vertex = min(grid, net_quads());
    SideCorner c;
    c.at = net_place(vertex);
    vec2 height = morphed(levels, net_morph(length(placed(c.at, levels.r))));
    c.height_m = height.r;
    c.coverage = height.g;
    VertexFrame v = net_vertex(vertex, c.height_m);
    c.position_m = v.position_m;
    hook_displace(v, v.position_m);
    bool nowhere = finite(vec4(v.position_m, 0.0)) == 0.0;
    c.moved_m = nowhere ? 0.0 : dot(v.position_m - c.position_m, v.up) / frame.height_range.z;
    c.position_m = nowhere ? c.position_m : v.position_m;
    return c;
}

const int kReach = 3;  // nodes around that tell where a void lies

/// How coverage rises along rows and columns around a node of the page.
vec2 slope_of_coverage(in ivec2 node) {
    vec2 slope = vec2(0.0);
    int layer = int(net_uu.w);
    for (int i = 1; i <= kReach; ++i) {
        for (int j = -i; j <= i; ++j) {
            ivec4 x = clamp(node.x + ivec4(i, -i, j, j), 0, 66);
            ivec4 y = clamp(node.y + ivec4(j, j, i, -i), 0, 66);
            slope.x += texelFetch(height_pages, ivec3(x.x, y.x, layer), 0).g -
                       texelFetch(height_pages, ivec3(x.y, y.y, layer), 0).g;
            slope.y += texelFetch(height_pages, ivec3(x.z, y.z, layer), 0).g -
                       texelFetch(height_pages, ivec3(x.w, y.w, layer), 0).g;
        }
    }
    return slope;
}

/// Away from the ground at an end of an edge beside a void: the rim of a void follows posts in steps, and is
/// shaded as the line that they follow. Places around count by how clear the line is there: on a straight part
/// it is clearest, so that sides meet in a corner. A plain mean would face between them there, and shine.
/// source: after the idea of M. Kuwahara et al., Digital Processing of Biomedical Images, 1976, 187
/// @param cut  false on the DEM's rim, whose steps are the DEM's own corners: gives no direction
vec3 outwards(in vec2 grid, in vec2 at, in bool cut) {
    if (!cut) return vec3(0.0);
    vec2 slope = vec2(0.0);
    ivec2 texel = ivec2(grid) + 1;
    for (int i = 0; i < 9; ++i) {
        ivec2 way = ivec2(i % 3, i / 3) - 1;
        ivec2 node = texel + way * (way.x * way.y == 0 ? kReach : kReach - 1);
        vec2 found = slope_of_coverage(clamp(node, 1, 65));
        float clear = dot(found, found) / 1000.0;
        slope += found * clear * clear * clear * clear;
    }
    const float step = 0.01;
    vec3 along = placed(at + vec2(step, 0.0), 0.0) - placed(at, 0.0);
    vec3 down = placed(at + vec2(0.0, step), 0.0) - placed(at, 0.0);
    vec3 away = -slope.x * normalize(along) - slope.y * normalize(down);
    return length(away) > 0.0 ? normalize(away) : vec3(0.0);
}

/// Where the way between two corners leaves the ground: to the same bits from both triangles that share it,
/// for walls beside each other to meet.
SideCorner crossing(in SideCorner one, in SideCorner other) {
    SideCorner a = one, b = other;
    if (one.coverage < other.coverage) {
        a = other;
        b = one;
    }
    float share = clamp((0.5 - a.coverage) / (b.coverage - a.coverage), 0.0, 1.0);
    return SideCorner(mix(a.at, b.at, share), mix(a.position_m, b.position_m, share),
                      mix(a.height_m, b.height_m, share), 0.5, mix(a.moved_m, b.moved_m, share));
}

bool covered(in SideCorner c) {
    return c.coverage >= 0.5;
}

/// Rounding leaves up to a step of the rasteriser between walls beside each other: each reaches this share of
/// its length past its ends.
const float kOverlap = 1.0 / 128.0;

void main() {
    SideCorner a = corner(ends.xy), b = corner(ends.zw);
    bool in_a = covered(a), in_b = covered(b);
    bool other = third.z > 0.5;
    SideCorner first = a, last = b;
    bool nothing = !in_a && !in_b;
    if (third.x < 0.0) {
        if (in_b && !in_a) first = crossing(a, b);
        if (in_a && !in_b) last = crossing(a, b);
    } else {
        SideCorner c = corner(third.xy);
        bool in_c = covered(c);
        nothing = in_a == in_b && in_b == in_c;
        // The corner that is alone on its side is on both edges that are crossed.
        if (in_a != in_b && in_a != in_c) {
            first = crossing(a, b);
            last = crossing(a, c);
        } else if (in_b != in_a && in_b != in_c) {
            first = crossing(b, c);
            last = crossing(b, a);
        } else {
            first = crossing(c, a);
            last = crossing(c, b);
        }
        // Against the ground's order, where two corners have ground.
        bool alone = int(in_a) + int(in_b) + int(in_c) == 1;
        if (alone) {
            SideCorner swapped = first;
            first = last;
            last = swapped;
        }
    }
    bool down = third.w > 0.5;
    SideCorner end = first;
    vec2 back = last.at;
    if (other) {
        end = last;
        back = first.at;
    }
    side_height_m = down ? frame.block.x : end.height_m + end.moved_m;
    side_ground_m = end.height_m;
    side_position_m = down ? placed(end.at, frame.block.x) : end.position_m;
    side_position_m += kOverlap * (placed(end.at, end.height_m) - placed(back, end.height_m));
    side_depth = third.w;
    side_outwards = outwards(other ? ends.zw : ends.xy, end.at, third.x >= 0.0);
    gl_Position = nothing ? vec4(0.0, 0.0, 0.0, 1.0) : clipped(side_position_m);
}

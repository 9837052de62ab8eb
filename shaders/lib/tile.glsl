//! provides  where a vertex of a tile lies, for every program that draws the ground or its walls
//! reads     a tile's net: position and vertical as polynomials over the tile [m, relative to the eye]; its
//!           height page
//! source    morphing after F. Strugar, J. Graphics, GPU and Game Tools 14(4), 2009: render/lod.h
//!
//! Programs whose results must meet get the same bits from here: walls start at vertices of the ground.
//! Without `precise` and `invariant` a compiler may fuse a product and a sum in one program and not in another.

//@ include lib/ground.glsl

invariant gl_Position;

layout(location = 1) in vec4 net_0;  // w: quads of the tile that lie on the DEM, x
layout(location = 2) in vec4 net_u;  // w: and y
layout(location = 3) in vec4 net_uu;  // w: layer in the height pages
layout(location = 4) in vec4 net_v;  // w: column of the tile's first post
layout(location = 5) in vec4 net_uv;  // w: and row
layout(location = 6) in vec4 net_uuv;  // w: posts from vertex to vertex
layout(location = 7) in vec4 net_vv;  // w: distance from the eye where morphing starts [m]
layout(location = 8) in vec4 net_uvv;  // w: morphing there a metre, 1 being all of it [1/m]
layout(location = 9) in vec4 net_uuvv;  // w: lowest height of the tile [m]
layout(location = 10) in vec4 up_0;  // w: highest [m]
layout(location = 11) in vec4 up_u;
layout(location = 12) in vec4 up_v;

uniform sampler2DArray height_pages;  // r: height [m]; g: 1 on posts, 0 on holes; ba: the same of the coarser level

/// Quads of the tile that lie on the DEM, in x and y.
vec2 net_quads() {
    return vec2(net_0.w, net_u.w);
}

/// 0..1 over the tile's part of the DEM. @param vertex  column and row in quads
vec2 net_place(in vec2 vertex) {
    precise vec2 at = vertex / net_quads();
    return at;
}

/// The vertical there, not quite unit.
vec3 net_up(in vec2 at) {
    precise vec3 up = up_0.xyz + at.x * up_u.xyz + at.y * up_v.xyz;
    return up;
}

/// Where a point of the tile lies, relative to the eye [m].
/// @param at  net_place()
vec3 placed(in vec2 at, in float height) {
    precise vec3 row = net_0.xyz + at.x * (net_u.xyz + at.x * net_uu.xyz);
    precise vec3 row_v = net_v.xyz + at.x * (net_uv.xyz + at.x * net_uuv.xyz);
    precise vec3 row_vv = net_vv.xyz + at.x * (net_uvv.xyz + at.x * net_uuvv.xyz);
    precise vec3 position_m = row + at.y * (row_v + at.y * row_vv) + height * frame.height_range.z * net_up(at);
    return position_m;
}

/// Texel of a vertex in the height pages. @param grid  0..64, and a little more for the skirt
ivec3 net_texel(in vec2 grid) {
    return ivec3(clamp(grid, vec2(0.0), ceil(net_quads())) + 1.0, net_uu.w);
}

/// How far a vertex has morphed to the coarser level, 0..1.
/// @param distance_m  from the eye, at the height of its own level
float net_morph(in float distance_m) {
    precise float morph = clamp((distance_m - net_vv.w) * net_uvv.w, 0.0, 1.0);
    return morph;
}

/// Height [m] and coverage. @param levels  from height_pages
vec2 morphed(in vec4 levels, in float morph) {
    precise vec2 height = mix(levels.rg, levels.ba, morph);
    return height;
}

/// The tile's first post.
vec2 net_first_post() {
    return vec2(net_v.w, net_uv.w);
}

/// Columns and rows from there to what counts as the last post: a little short of it, so that it lies in a page as
/// all others do.
vec2 net_last_post() {
    return (net_quads() - 0.01) * net_uuv.w;
}

/// A vertex where the DEM has it. @param vertex  column and row in quads
VertexFrame net_vertex(in vec2 vertex, in float height) {
    vec2 at = net_place(vertex);
    VertexFrame v;
    v.up = net_up(at);
    v.height_m = height;
    v.height_unit = height_unit_of(height);
    v.position_m = placed(at, height);
    v.ground_m = ground_at(v.position_m, v.up, height);
    v.anchored_m = ground_anchored_at(v.position_m, v.up, height);
    v.distance_m = length(v.position_m);
    v.drawn_height_m = height * frame.height_range.z;
    v.post = net_first_post() + clamp(vertex * net_uuv.w, vec2(0.0), net_last_post());
    return v;
}

#ifdef ORTHOGRAPHIC
/// In clip space of a map: where the grid has the vertex, at the depth of its position.
/// @param post        column and row, not clamped to the DEM
/// @param position_m  relative to the eye
vec4 net_on_map(in vec2 post, in vec3 position_m) {
    precise vec4 clip = frame.view_projection * vec4(position_m, 1.0);
    precise vec2 place = vec2(dot(frame.map_x.xyz, vec3(post, 1.0)), dot(frame.map_y.xyz, vec3(post, 1.0)));
    clip.xy = place * clip.w;
    return clip;
}

/// Whether the skirt of a vertex leaves the DEM, in x and y. @param vertex  on the DEM, in quads
bvec2 net_leaves_dem(in vec2 grid, in vec2 vertex) {
    vec2 post = net_first_post() + vertex * net_uuv.w;
    vec2 last = frame.posts.xy - 1.5;
    return bvec2(grid.x < 0.0 ? post.x < 0.5 : grid.x > 64.0 && post.x > last.x,
                 grid.y < 0.0 ? post.y < 0.5 : grid.y > 64.0 && post.y > last.y);
}

/// Column and row of a vertex on a map. Where its skirt leaves the DEM, the ground reaches to the edge of the
/// cells, half a post on; between tiles it overlaps by a share of a pixel, for rounding.
/// @param grid    0..64, and a little more for the skirt
/// @param vertex  the same on the DEM
vec2 net_map_post(in vec2 grid, in vec2 vertex) {
    const float overlap_px = 0.25;
    vec2 inside = clamp(vertex, vec2(0.0), net_quads());
    vec2 outwards = sign(grid - clamp(grid, vec2(0.0), vec2(64.0)));
    vec2 column_px = frame.viewport.xy * vec2(frame.map_x.x, frame.map_y.x);
    vec2 row_px = frame.viewport.xy * vec2(frame.map_x.y, frame.map_y.y);
    vec2 side_px = 0.5 * vec2(length(column_px), length(row_px));
    vec2 reach = min(overlap_px / max(side_px, vec2(1e-6)), vec2(0.5));
    vec2 post = net_first_post() + inside * net_uuv.w;
    return post + outwards * mix(reach, vec2(0.5), net_leaves_dem(grid, inside));
}
#endif

/// In clip space. @param position_m  relative to the eye
vec4 clipped(in vec3 position_m) {
    precise vec4 clip = frame.view_projection * vec4(position_m, 1.0);
    return clip;
}

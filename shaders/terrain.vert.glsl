//! provides  one grid of 65 x 65 vertices, placed on the round Earth and displaced by the elevation
//! reads     a tile's net: position and vertical as polynomials over the tile [m, relative to the eye]
//! writes    column and row of the post, height [m]; clip distance 0 cuts holes out half way between a
//!           post that has a height and one that has none
//! source    morphing after F. Strugar, J. Graphics, GPU and Game Tools 14(4), 2009: render/lod.h

//@ include lib/finite.glsl
//@ include lib/ground.glsl

layout(location = 0) in vec2 grid;  // 0..64, and a little beyond for the skirt
layout(location = 1) in vec4 net_0;  // w: quads of the tile that lie on the DEM, x
layout(location = 2) in vec4 net_u;  // w: and y
layout(location = 3) in vec4 net_uu;  // w: layer in the height pages
layout(location = 4) in vec4 net_v;  // w: column of the tile's first post
layout(location = 5) in vec4 net_uv;  // w: and row
layout(location = 6) in vec4 net_uuv;  // w: posts from vertex to vertex
layout(location = 7) in vec4 net_vv;  // w: distance from the eye where morphing starts [m]
layout(location = 8) in vec4 net_uvv;  // w: morphing there a metre, 1 being all of it [1/m]
layout(location = 9) in vec4 net_uuvv;
layout(location = 10) in vec4 up_0;
layout(location = 11) in vec4 up_u;
layout(location = 12) in vec4 up_v;

uniform sampler2DArray height_pages;  // r: height [m]; g: 1 on posts, 0 on holes; ba: the same of the coarser level

const float kSkirt_px = 2.0;  // how far the skirt hangs down in the picture

out vec2 post;
out float height_m;
out float height_from_eye_m;  // of the DEM's heights: near the eye small, and so exact
out vec3 vertex_normal;

/// Where a point of the tile lies, relative to the eye [m].
/// @param at  0..1 over the tile's part of the DEM
vec3 placed(in vec2 at, in float height) {
    vec3 up = up_0.xyz + at.x * up_u.xyz + at.y * up_v.xyz;
    vec3 row = net_0.xyz + at.x * (net_u.xyz + at.x * net_uu.xyz);
    vec3 row_v = net_v.xyz + at.x * (net_uv.xyz + at.x * net_uuv.xyz);
    vec3 row_vv = net_vv.xyz + at.x * (net_uvv.xyz + at.x * net_uuvv.xyz);
    return row + at.y * (row_v + at.y * row_vv) + height * frame.height_range.z * up;
}

void main() {
    vec2 limit = vec2(net_0.w, net_u.w);
    ivec3 texel = ivec3(clamp(grid, vec2(0.0), ceil(limit)) + 1.0, net_uu.w);
    vec2 vertex = min(grid, limit + max(grid - 64.0, 0.0));
    vec2 at = vertex / limit;
    vec4 levels = texelFetch(height_pages, texel, 0);
#ifdef TERRAIN_DEPTH
    const float morph = 0.0;  // an orthographic view sees a tile at one level
#else
    float distance_m = length(placed(at, levels.r));
    float morph = clamp((distance_m - net_vv.w) * net_uvv.w, 0.0, 1.0);
#endif
    vec2 height = mix(levels.rg, levels.ba, morph);
    bool skirt = grid != clamp(grid, 0.0, 64.0);
#ifndef TERRAIN_DEPTH
    height.r -= skirt ? kSkirt_px * length(frame.pixel_ray_dx.xyz) * distance_m : 0.0;
#endif

    VertexFrame v;
    v.up = up_0.xyz + at.x * up_u.xyz + at.y * up_v.xyz;
    v.height_m = height.r;
    v.height_unit = height_unit_of(height.r);
    v.position_m = placed(at, height.r);
    v.ground_m = ground_at(v.position_m, v.up, height.r);
    v.distance_m = length(v.position_m);
    v.drawn_height_m = height.r * frame.height_range.z;
    // Short of the last post, so that it lies in a page as all others do.
    v.post = vec2(net_v.w, net_uv.w) + clamp(vertex, vec2(0.0), limit - 0.01) * net_uuv.w;
    vec3 in_place = v.position_m;
    hook_displace(v, v.position_m);
#ifdef DISPLACED
    // A vertex that is nowhere takes its triangles out of the picture without a word: it stays where
    // it was, and the pixels around are told of by a height that no ground has.
    bool nowhere = finite(vec4(v.position_m, 0.0)) == 0.0;
    v.position_m = nowhere ? in_place : v.position_m;
#endif
    v.distance_m = length(v.position_m);
    v.drawn_height_m += dot(v.position_m - in_place, v.up);
    hook_vertex(v);

#ifdef TERRAIN_DEPTH
    // Down to where no ground is lower: light does not come in under the DEM's sides.
    float sunk_m = v.drawn_height_m - frame.height_range.w * frame.height_range.z;
    v.position_m -= (skirt ? sunk_m : 0.0) * v.up;
#endif

#ifdef TERRAIN_NORMAL_VERTEX
    // The paper's normal: two more reads, at the next posts along the row and down the column, and
    // the cross product of the two differences, turned outwards on grids whose rows run north.
    vec4 next = texelFetch(height_pages, texel + ivec3(1, 0, 0), 0);
    vec3 beside = placed(at + vec2(1.0 / limit.x, 0.0), mix(next.r, next.b, morph));
    next = texelFetch(height_pages, texel + ivec3(0, 1, 0), 0);
    vec3 below = placed(at + vec2(0.0, 1.0 / limit.y), mix(next.r, next.b, morph));
    vec3 here = placed(at, mix(levels.r, levels.b, morph));  // the skirt has its edge's normal
    vec3 crossed = cross(beside - here, below - here);
    vertex_normal = normalize(dot(crossed, v.up) < 0.0 ? -crossed : crossed);
#endif
    post = v.post;
    height_m = height.r;
#ifdef DISPLACED
    height_m = nowhere ? kNowhere_m : height_m;
#endif
#ifdef HEIGHT_STEPS
    height_from_eye_m = height.r - frame.eye_m.w / frame.height_range.z;
#endif
    gl_Position = frame.view_projection * vec4(v.position_m, 1.0);
    gl_ClipDistance[0] = height.g - 0.5;
}

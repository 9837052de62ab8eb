//! provides  one grid of 65 x 65 vertices, placed on the round Earth and displaced by the elevation
//! reads     a tile's net and height page (lib/tile.glsl)
//! writes    column and row of the post, height [m]; clip distance 0 cuts holes out half way between a
//!           post that has a height and one that has none

//@ include lib/finite.glsl
//@ include lib/tile.glsl

layout(location = 0) in vec2 grid;  // 0..64, and a little beyond for the skirt

const float kSkirt_px = 2.0;  // how far the skirt hangs down in the picture

// Interpolation rounds in proportion to values: of a column beyond 65,536 it would lose hundredths.
flat out vec4 post_limits;  // xy: first; zw: from there to the last
out vec2 post_of_tile;        // from the first
out float height_m;
out float height_in_tile_m;  // above the eye, or that height of the tile's that is nearest to it: small, and so exact
out vec3 vertex_normal;
out vec3 place_m;  // of a map, relative to the eye

void main() {
    vec2 limit = net_quads();
    ivec3 texel = net_texel(grid);
    vec2 vertex = min(grid, limit + max(grid - 64.0, 0.0));
    vec2 at = net_place(vertex);
    vec4 levels = texelFetch(height_pages, texel, 0);
#ifdef TERRAIN_DEPTH
    const float morph = 0.0;  // an orthographic view sees a tile at one level
#else
    float distance_m = length(placed(at, levels.r));
    float morph = net_morph(distance_m);
#endif
    vec2 height = morphed(levels, morph);
    bool skirt = grid != clamp(grid, 0.0, 64.0);
#ifdef ORTHOGRAPHIC
    skirt = skirt && !any(net_leaves_dem(grid, clamp(vertex, vec2(0.0), limit)));
#endif
#ifndef TERRAIN_DEPTH
    height.r -= skirt ? kSkirt_px * length(frame.pixel_ray_dx.xyz) * distance_m : 0.0;
#endif

    VertexFrame v = net_vertex(vertex, height.r);
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
    post_limits = vec4(net_first_post(), net_last_post());
    post_of_tile = clamp(vertex, vec2(0.0), limit) * net_uuv.w;
    height_m = height.r;
#ifdef DISPLACED
    height_m = nowhere ? kNowhere_m : height_m;
#endif
#ifdef HEIGHT_STEPS
    height_in_tile_m = height.r - clamp(frame.eye_m.w / frame.height_range.z, net_uuvv.w, up_0.w);
#endif
#ifdef ORTHOGRAPHIC
    place_m = v.position_m;
    gl_Position = net_on_map(net_map_post(grid, vertex), v.position_m);
#else
    gl_Position = clipped(v.position_m);
#endif
    gl_ClipDistance[0] = height.g - 0.5;
}

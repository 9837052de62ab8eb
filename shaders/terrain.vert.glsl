//! provides  one grid of 65 x 65 vertices, placed on the round Earth and displaced by the elevation
//! reads     a patch's net: position and vertical as polynomials over the patch [m, relative to the eye]
//! writes    texel and layer in the normal pages, height [m]; clip distance 0 cuts holes out half way
//!           between a post that has a height and one that has none

//@ include lib/ground.glsl

layout(location = 0) in vec2 grid;  // 0..64; a little beyond at the rim, so that patches overlap
layout(location = 1) in vec4 net_0;  // w: quads of the patch that lie on the DEM, x
layout(location = 2) in vec4 net_u;  // w: and y
layout(location = 3) in vec4 net_uu;  // w: layer in the height pages
layout(location = 4) in vec4 net_v;  // w: layer in the normal pages
layout(location = 5) in vec4 net_uv;  // w: first texel there, x
layout(location = 6) in vec4 net_uuv;  // w: and y
layout(location = 7) in vec4 net_vv;  // w: texels there from vertex to vertex
layout(location = 8) in vec4 net_uvv;
layout(location = 9) in vec4 net_uuvv;
layout(location = 10) in vec4 up_0;
layout(location = 11) in vec4 up_u;
layout(location = 12) in vec4 up_v;

uniform sampler2DArray height_pages;  // r: height [m]; g: 1 on posts, 0 on holes

out vec2 page_texel;
flat out float page_layer;
out float height_m;
out vec3 vertex_normal;

/// Where a point of the patch lies, relative to the eye [m].
/// @param at  0..1 over the patch
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
    vec2 post = min(grid, limit + max(grid - 64.0, 0.0));
    vec2 at = post / 64.0;
    vec2 height = texelFetch(height_pages, texel, 0).rg;

    VertexFrame v;
    v.up = up_0.xyz + at.x * up_u.xyz + at.y * up_v.xyz;
    v.height_m = height.r;
    v.height_unit = height_unit_of(height.r);
    v.position_m = placed(at, height.r);
    v.ground_m = vec3(v.position_m.xy + frame.eye_m.xy, height.r);
    v.distance_m = length(v.position_m);
    hook_displace(v, v.position_m);
    hook_vertex(v);

#ifdef TERRAIN_NORMAL_VERTEX
    // The paper's normal: two more reads, at the next posts along the row and down the column, and
    // the cross product of the two differences, turned outwards on grids whose rows run north.
    vec3 beside = placed(at + vec2(1.0 / 64.0, 0.0), texelFetch(height_pages, texel + ivec3(1, 0, 0), 0).r);
    vec3 below = placed(at + vec2(0.0, 1.0 / 64.0), texelFetch(height_pages, texel + ivec3(0, 1, 0), 0).r);
    vec3 here = placed(at, height.r);
    vec3 crossed = cross(beside - here, below - here);
    vertex_normal = normalize(dot(crossed, v.up) < 0.0 ? -crossed : crossed);
#endif
    page_texel = vec2(net_uv.w, net_uuv.w) + post * net_vv.w;
    page_layer = net_v.w;
    height_m = height.r;
    gl_Position = frame.view_projection * vec4(v.position_m, 1.0);
    gl_ClipDistance[0] = height.g - 0.5;
}

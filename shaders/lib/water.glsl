//! provides  water_at: where water stands on the ground, and which ground was a hole
//! reads     water pages, in the layers of the normal pages: render/water_field.h

//@ include lib/pages.glsl
//@ include lib/pixel.glsl

uniform sampler2DArray water_pages;  // r: side of the shore, one half on it; gb: sea, floor known; a: filled 0.5, covered 1

/// Share of a pixel behind an edge. @param beyond_px  from the edge to its centre [px]
/// Of a tent as wide as two pixels, as antialias.frag.glsl has: an edge between two pixels blends both.
float water_covered(in float beyond_px) {
    float outside = max(1.0 - abs(beyond_px), 0.0);
    float share = 0.5 * outside * outside;
    return beyond_px > 0.0 ? 1.0 - share : share;
}

/// Water at a place of the DEM.
/// @param post         column and row
/// @param pixel_posts  posts that a pixel is wide
/// @param dx, dy       to the next pixel right and up [posts]: shores are smooth over that
/// @param land         moves the shore towards the water, as a share of the way between posts, -0.5..0.5
/// @returns x: share of water, 0 to 1; y: of it, the share that is sea, z: and whose floor the DEM has; w: of holes,
///          0.5 where they are filled and 1 where they are covered
vec4 water_ashore(in vec2 post, in float pixel_posts, in vec2 dx, in vec2 dy, in float land) {
    int most = textureQueryLevels(page_table) - 1;
    int level = clamp(int(log2(max(pixel_posts, 1.0)) + 0.5), 0, most);
    PagePlace at = page_place(post, level);
    if (at.layer == kNoPage) return vec4(0.0);
    vec2 node = at.node + 1.0;
    vec2 quad = floor(node);
    vec2 t = node - quad;
    vec4 side = textureGather(water_pages, vec3((quad + 1.0) / kNormalPage_px, float(at.layer)), 0);
    vec2 along = mix(side.wx, side.zy, t.x);  // the row above and the one below
    vec2 slope = vec2(mix(side.z - side.w, side.y - side.x, t.y), along.y - along.x) * at.nodes_per_post;
    float a_pixel = length(vec2(dot(slope, dx), dot(slope, dy)));
    float share = water_covered((mix(along.x, along.y, t.y) - 0.5 + land) / max(a_pixel, 1e-4));
    vec3 kind = textureLod(water_pages, vec3((node + 0.5) / kNormalPage_px, float(at.layer)), 0.0).gba;
    return vec4(share, kind);
}

/// The same with shores where the DEM's posts have them.
vec4 water_between(in vec2 post, in float pixel_posts, in vec2 dx, in vec2 dy) {
    return water_ashore(post, pixel_posts, dx, dy, 0.0);
}

/// The same for pixels of one width each way. @param pixel_posts  posts that a pixel is wide
vec4 water_at(in vec2 post, in float pixel_posts) {
    return water_between(post, pixel_posts, vec2(pixel_posts, 0.0), vec2(0.0, pixel_posts));
}

/// To the point that a neighbouring pixel shows of level ground [m]. Not of maps.
/// @param ray_step  to the ray of that pixel
/// @param least     sine of the lowest elevation that the view is taken to have, so that steps end
vec3 water_step_m(in Surface s, in vec3 ray_step, in float least) {
    vec3 forward = normalize(cross(frame.pixel_ray_dy.xyz, frame.pixel_ray_dx.xyz));
    vec3 ray = s.position_m / dot(s.position_m, forward) + ray_step;
    float slant = min(dot(ray, s.up), -least * length(ray));
    return ray * (min(dot(s.position_m, s.up), -least * s.distance_m) / slant) - s.position_m;
}

/// The same in columns and rows of the DEM [posts].
vec2 water_step(in Surface s, in vec3 ray_step) {
    vec3 step_m = water_step_m(s, ray_step, 0.02);
    vec3 east = east_at(s.up);
    return frame.light_axes.xy * dot(step_m, east) + frame.light_axes.zw * dot(step_m, cross(s.up, east));
}

/// At a visible point. @param land  as water_ashore()
vec4 water_ashore_of(in Surface s, in float land) {
#ifdef ORTHOGRAPHIC
    mat2 step_posts = pixel_step_on_map();
    return water_ashore(s.post, 0.5 * (length(step_posts[0]) + length(step_posts[1])), step_posts[0], step_posts[1], land);
#else
    float pixel_m = 0.5 * (length(s.ground_dx_m) + length(s.ground_dy_m));
    return water_ashore(s.post, pixel_m * frame.normal_texels_per_m, water_step(s, frame.pixel_ray_dx.xyz),
                        water_step(s, frame.pixel_ray_dy.xyz), land);
#endif
}

/// At a visible point.
vec4 water_of(in Surface s) {
    return water_ashore_of(s, 0.0);
}

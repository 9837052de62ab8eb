//! provides  instances of a plugin's meshes: each stands at a site of a jittered grid, on the ground as it is drawn
//! reads     a tile's net and height page (lib/tile.glsl); a rectangle of the tile and the cells of the grid in it
//! writes    what geometry passes store, the reflectance and the normal of the instance
//!
//! With SHADOW_MAP they are drawn as the sun sees them, one point each.
//!
//! One draw has a rectangle of cells: an instance has a row of them, with a copy of the mesh for each. place_instance() stands for the function of
//! the plugin, <id>_place_<name>. A site that has no instance ends outside of the picture.

//@ include lib/crown.glsl
//@ include lib/instances.glsl
//@ include lib/tile.glsl

layout(location = 0) in vec4 instance_vertex;  // xyz: of the mesh, height 1 and width 1; w: number of the copy
layout(location = 13) in vec4 instance_cells;   // xy: first cell; z: kind; w: instances_range_m()
layout(location = 14) in vec4 instance_detail;  // xy: distances between which this mesh is drawn [m], x: or a shadow map; zw: cells per post
layout(location = 15) in vec4 instance_packed;  // xyz: unit; w: colour, 8 bits each

const float kRagged = 0.12;  // as in instance.frag.glsl
const float kDetailJitter = 0.2;  // share of the distance by which instances change their meshes sooner or later

flat out vec4 instance_crown;  // of a shadow map, as instance_shadow.frag.glsl has them
flat out vec4 instance_place;
flat out vec2 post;
out float height_m;
out vec3 instance_normal;
out vec4 instance_reflectance;  // a: share of the sun's light past instances whose shadows are not drawn
out vec4 instance_shape;  // of a sprite; xy: the point's side over its width and height, z: taper, w: flatness
flat out float instance_half_width_m;
flat out vec4 instance_clumps;  // xy: random numbers; z: ragged, w: taper
out vec3 instance_within;       // place in a mesh, as shares of half its width and height

/// The rectangle of posts whose sites this draw has: first and last, half open.
vec4 instance_rectangle() {
    return vec4(net_uuvv.w, up_0.w, up_u.w, up_v.w);
}

/// The ground at a place of the tile, on its drawn triangles. Coverage is 0 on voids.
/// @param vertex  column and row in quads
VertexFrame ground_of(in vec2 vertex, out vec3 normal, out float coverage) {
    vec2 quad = floor(vertex), t = vertex - quad;
    bool far = t.x + t.y > 1.0;  // each quad has two triangles, which share the corners b and c
    vec4 a = texelFetch(height_pages, net_texel(quad + (far ? 1.0 : 0.0)), 0);
    vec4 b = texelFetch(height_pages, net_texel(quad + vec2(1.0, 0.0)), 0);
    vec4 c = texelFetch(height_pages, net_texel(quad + vec2(0.0, 1.0)), 0);
    vec2 way = far ? vec2(1.0) - t.yx : t;
    vec2 at = net_place(vertex);
    float morph = net_morph(length(placed(at, a.r)));
    vec2 ha = morphed(a, morph), hb = morphed(b, morph), hc = morphed(c, morph);
    float height = ha.r + way.x * (hb.r - ha.r) + way.y * (hc.r - ha.r);
    coverage = min(ha.g, min(hb.g, hc.g));

    VertexFrame v = net_vertex(vertex, height);
    vec2 rise = far ? vec2(ha.r - hc.r, ha.r - hb.r) : vec2(hb.r - ha.r, hc.r - ha.r);
    vec3 along = net_u.xyz / net_quads().x + rise.x * v.up, down = net_v.xyz / net_quads().y + rise.y * v.up;
    vec3 crossed = normalize(cross(along, down));
    normal = dot(crossed, v.up) < 0.0 ? -crossed : crossed;
    return v;
}

/// Of mean 1.
vec3 instance_mesh_colour() {
    uint bits = uint(instance_packed.w);
    return vec3(bits & 255u, bits >> 8u & 255u, bits >> 16u) / 127.5;
}

#ifdef SHADOW_MAP
/// A point over the whole of a crown as the sun sees it, in the map of this draw.
vec4 instance_shadow(in InstanceSite site, in Instance it) {
    vec4 map = frame.instance_shadow_maps[int(instance_detail.x)];
    vec3 along = instances_shadow_along(site.ground.position_m);
    float side = frame.instance_shadow_px, map_m = 1.0 / map.w;
    float cosine = clamp(dot(site.ground.up, frame.instance_shadow_axes[2].xyz), 0.0, 1.0);
    vec2 ends = crown_ends(0.5 * it.width_m, it.height_m, it.taper, cosine);
    float middle = 0.5 * (ends.x + ends.y);
    float half_side = max(max(0.5 * it.width_m, 0.5 * (ends.y - ends.x)), map_m / side);  // a texel at least
    instance_crown = vec4(0.5 * it.width_m, it.height_m, it.taper, cosine);
    instance_place = vec4(middle, half_side, along.z, instance_detail.x);
    gl_PointSize = half_side * side / map_m;
    vec2 at = instances_shadow_place(along + vec3(0.0, middle, 0.0), map).xy;
    return vec4(at.x, (at.y + 1.0 + 2.0 * instance_detail.x) / float(kInstanceMaps) - 1.0, 0.5, 1.0);
}
#elif defined(SPRITES)
/// A point over the whole of a crown.
/// @param flatness    how far it is shaded as the ground below it
/// @param position_m  its middle, relative to the eye
vec4 instance_sprite(in InstanceSite site, in Instance it, in float flatness, out vec3 position_m) {
    VertexFrame foot = site.ground;
    vec3 middle_m = foot.position_m + 0.5 * it.height_m * foot.up;
    float cosine = dot(normalize(middle_m), foot.up), sine2 = 1.0 - cosine * cosine;
    vec4 position = clipped(middle_m);
    // As seen by the eye: an ellipsoid of the crown's height and width.
    float high = sqrt(it.height_m * it.height_m * sine2 + it.width_m * it.width_m * cosine * cosine);
    float across = max(it.width_m, high) * (1.0 + kRagged * it.ragged);
    position_m = middle_m;
    gl_PointSize = max(across / (position.w * length(frame.pixel_ray_dx.xyz)), 1.0);
    instance_shape = vec4(across / it.width_m, across / high, it.taper * sine2, flatness);
    instance_normal = site.normal;
    instance_half_width_m = 0.5 * it.width_m;
    instance_reflectance = vec4(it.colour, it.sun);
    return position;
}
#else
/// A vertex of the mesh, turned and scaled.
vec4 instance_mesh(in InstanceSite site, in Instance it, in float flatness, out vec3 position_m) {
    VertexFrame foot = site.ground;
    vec3 east = east_at(foot.up), north = cross(foot.up, east);
    float cosine = cos(it.turn), sine = sin(it.turn);
    vec3 right = cosine * east + sine * north, ahead = cosine * north - sine * east;
    vec3 size = vec3(it.width_m, it.width_m, it.height_m);
    vec3 local = instance_vertex.xyz * size;
    instance_within = instance_vertex.xyz * 2.0 - vec3(0.0, 0.0, 1.0);
    instance_half_width_m = 0.5 * it.width_m;
    vec3 turned = instance_packed.xyz / max(size, vec3(1e-3));
    instance_normal = normalize(mix(normalize(turned.x * right + turned.y * ahead + turned.z * foot.up), site.normal,
                                    flatness));
#ifdef SPRITES_FOLLOW
    instance_reflectance = vec4(it.colour * instance_mesh_colour(), 1.0);  // all near instances have a shadow
#else
    instance_reflectance = vec4(it.colour * instance_mesh_colour(), it.sun);
#endif
    position_m = foot.position_m + local.x * right + local.y * ahead + local.z * foot.up;
    return clipped(position_m);
}
#endif

void main() {
    ivec2 cell = ivec2(instance_cells.xy) + ivec2(int(instance_vertex.w), gl_InstanceID);
    vec4 chance = instances_random(cell, 0u);
    vec2 place = (vec2(cell) + 0.1 + 0.8 * chance.xy) / instance_detail.zw;
    vec2 vertex = (place - net_first_post()) / net_uuv.w;
    vec4 within = instance_rectangle();
    bool here = all(greaterThanEqual(place, within.xy)) && all(lessThan(place, within.zw));

    InstanceSite site;
    float coverage;
    site.ground = ground_of(clamp(vertex, vec2(0.0), net_quads()), site.normal, coverage);
    site.random = instances_random(cell, 1u);
    Instance it = Instance(1.0, 0.0, 0.0, 6.2831853 * site.random.x, vec3(0.3), 0, 0.0, 1.0, 0.0);
    place_instance(site, it);

    float away_m = site.ground.distance_m;
    bool kept = chance.w < it.density * instances_share(away_m, instance_cells.w);
    bool drawn = here && kept && coverage > 0.99 && it.height_m > 0.0 && it.width_m > 0.0;
#ifdef SHADOW_MAP
    vec4 position = instance_shadow(site, it);
#else
    float seen_m = away_m * (1.0 + kDetailJitter * (chance.z - 0.5));
    drawn = drawn && seen_m >= instance_detail.x && seen_m < instance_detail.y;
#ifndef SPRITES
    drawn = drawn && it.kind == int(instance_cells.z);
#endif
    // Far away instances are shaded as the cover of the ground that takes their place.
    float flatness = smoothstep(0.1, kInstanceFade, away_m / instance_cells.w);
    it.colour = clamp(it.colour, 0.0, 1.0);
    post = site.ground.post;
    height_m = site.ground.height_m;
    VertexFrame v = site.ground;
#ifdef SPRITES
    vec4 position = instance_sprite(site, it, flatness, v.position_m);
    // OpenGL clips a point by its centre; some drivers do not.
    drawn = drawn && all(lessThan(abs(position.xy), position.ww));
#else
    vec4 position = instance_mesh(site, it, flatness, v.position_m);
#endif
    instance_clumps = vec4(site.random.yz, it.ragged, it.taper);
    v.distance_m = length(v.position_m);
    v.drawn_height_m += dot(v.position_m - site.ground.position_m, v.up);
    hook_vertex(v);
#endif
    gl_Position = drawn ? position : vec4(2.0, 2.0, 0.5, 1.0);
#if defined(SPRITES) || defined(SHADOW_MAP)
    if (!drawn) gl_PointSize = 1.0;  // near the eye it is huge, and some drivers draw what of it is in the picture
#endif
}

//! provides  trees: conifers and broadleaf trees near the eye, and the forest's cover farther away
//! hook      material; places tree
//! reads     the climate's tables, a map of land cover, height, slope, water
//! writes    diffuse, ambient, specular of the ground below trees and of the cover
//! source    lib/crown.glsl: gaps between crowns

//@ include lib/climate.glsl
//@ include lib/crown.glsl
//@ include lib/instances.glsl
//@ include lib/land.glsl
//@ include lib/repeats.glsl
//@ include lib/water.glsl

uniform float trees_density = 0.85; //@ range(0, 1) label("Density") description("Share of the sites of closed forest that have a tree")
uniform float trees_size = 1.0; //@ range(0.3, 1.3) label("Size") description("Factor on the height and width of trees")
uniform float trees_line_m = 0.0; //@ range(-3000, 3000) unit(m) label("Tree line shift") description("Added to the climate's tree line")
uniform float trees_clearings = 0.6; //@ range(0, 1) label("Clearings") description("How much thinner forest is in its clearings")
uniform vec2 trees_slope_deg = vec2(38.0, 52.0); //@ range(0, 90) unit(deg) label("Slopes from, to") description("Slopes between which trees become rare")
uniform vec3 trees_needles = vec3(0.030, 0.048, 0.024); //@ colour label("Needles")
uniform vec3 trees_leaves = vec3(0.055, 0.088, 0.026); //@ colour label("Leaves")
uniform vec3 trees_scrub = vec3(0.066, 0.075, 0.038); //@ colour label("Scrub") description("Leaves where it is warm and dry")
uniform vec3 trees_autumn = vec3(0.125, 0.082, 0.034); //@ colour label("Leaves when they fall")

const float trees_spacing_m = 10.0;   // plugin.json
const float trees_highest_m = 28.0;  // plugin.json
const float trees_light = 0.2;       // plugin.json: light_through
const float trees_conifer_width = 0.34;  // over the height
const float trees_broadleaf_width = 0.72;

/// What stands at a place.
struct trees_Stand {
    float density;     // share of sites that have a tree
    float conifers;    // share of them
    float height_m;    // mean
    vec3 leaves;       // reflectance of broadleaf trees
    float width;       // of broadleaf trees over their height
};

/// Smooth noise of cells of the ground, 0..1, of mean 0.5.
float trees_noise(in vec2 anchored_m, in float cell_m, in uint stream) {
    vec2 t;
    ivec2 cell = ground_cell(anchored_m, mat2(1.0 / cell_m), t);
    t = t * t * (3.0 - 2.0 * t);
    float a = instances_random(cell, stream).x, b = instances_random(cell + ivec2(1, 0), stream).x;
    float c = instances_random(cell + ivec2(0, 1), stream).x, d = instances_random(cell + ivec2(1, 1), stream).x;
    return mix(mix(a, b, t.x), mix(c, d, t.x), t.y);
}

/// Light and dark of forest from afar, of mean 1: crowns and groups of them, while they are larger than pixels.
float trees_tone(in Surface s) {
    float across_m = sqrt(length(s.ground_dx_m) * length(s.ground_dy_m));
    float crowns = 1.4 * (1.0 - smoothstep(2.0, 9.0, across_m)), groups = 0.6 * (1.0 - smoothstep(8.0, 40.0, across_m));
    return 1.0 + crowns * (trees_noise(s.anchored_m, 6.0, 8u) - 0.5) + groups * (trees_noise(s.anchored_m, 41.0, 9u) - 0.5);
}

/// @param normal  of the ground, not exaggerated
/// @param water   share of the ground that is water
/// @param map     where it tells anything, it says where forest is instead of the climate
trees_Stand trees_stand(in vec3 up, in float height_m, in vec3 normal, in vec2 anchored_m, in float water,
                        in LandCover map) {
    ClimateGround ground = climate_ground(climate_place(up), height_m);
    float growth = ground.growth + trees_line_m / 450.0;
    float cosine = clamp(dot(normal, up), 0.02, 1.0);
    float steep = sqrt(1.0 - cosine * cosine) / cosine;
    vec2 slopes = tan(radians(min(trees_slope_deg, vec2(89.0))));
    trees_Stand stand;
    float wooded = smoothstep(1.0, 2.1, ground.dryness) * smoothstep(0.85, 1.2, growth - 0.06 * steep);
    wooded = mix(wooded, map.trees, map.known);
    float closed = mix(1.0, smoothstep(0.2, 0.55, trees_noise(anchored_m, 140.0, 7u)), trees_clearings);
    stand.density = trees_density * wooded * closed * (1.0 - smoothstep(slopes.x, max(slopes.y, slopes.x + 1e-3), steep)) *
                    (1.0 - smoothstep(0.0, 0.5, water));
    stand.conifers = 1.0 - smoothstep(3.0, 11.0, ground.temperature);
    // Trees are lower near the tree line and in dry country.
    float vigour = smoothstep(0.8, 2.2, growth) * smoothstep(0.8, 2.4, ground.dryness);
    stand.height_m = trees_size * mix(5.0, 20.0, vigour);
    // Leaves fall where winters are cold and summers moist.
    float falls = smoothstep(3.0, 9.0, ground.temperature) * (1.0 - smoothstep(13.0, 17.0, ground.temperature)) *
                  smoothstep(1.2, 1.8, ground.dryness);
    stand.leaves = mix(trees_leaves, trees_autumn, falls * (1.0 - ground.green));
    // Where it is warm and dry they are evergreen scrub, wider than high.
    float scrub = smoothstep(11.0, 15.0, ground.temperature) * (1.0 - smoothstep(1.2, 1.8, ground.dryness));
    stand.height_m *= 1.0 - 0.5 * scrub;
    stand.leaves = mix(stand.leaves, trees_scrub, scrub);
    stand.width = mix(trees_broadleaf_width, 1.2, scrub);
    return stand;
}

/// Crowns of the mean tree of a kind.
Crown trees_crown(in trees_Stand stand, in bool conifer) {
    float height_m = (conifer ? 1.0 : 0.8) * stand.height_m;
    return Crown(height_m, height_m * (conifer ? trees_conifer_width : stand.width), trees_light);
}

float trees_range_m() {
    return instances_range_m(trees_highest_m, trees_spacing_m);
}

/// Trees on a square metre.
float trees_per_m2(in trees_Stand stand) {
    return stand.density / (trees_spacing_m * trees_spacing_m);
}

/// What crowns of both kinds hide from a direction. @param per_m2  trees on a square metre
vec2 trees_filled(in trees_Stand stand, in float per_m2, in float cosine) {
    const float unequal = 1.05;  // mean area of crowns of trees_place_tree() over that of the mean crown
    return unequal * per_m2 * vec2(stand.conifers * crown_cone_area_m2(trees_crown(stand, true), cosine),
                         (1.0 - stand.conifers) * crown_area_m2(trees_crown(stand, false), cosine));
}

/// Share of a direction's light that reaches the ground, through gaps and through crowns.
/// @param apart  0..1: 1 where the eye looks through other gaps
float trees_lit(in trees_Stand stand, in float per_m2, in float cosine, in float apart) {
    vec2 filled = trees_filled(stand, per_m2, cosine);
    float both = filled.x + filled.y, cells = both / max(per_m2 * trees_spacing_m * trees_spacing_m, 1e-6);
    return mix(trees_light, 1.0, crown_gap(both, cells, apart));
}

/// How far the ground that crowns hide from the sun is other ground than what they hide from the eye, 0..1: middles of
/// both over a crown's width. Ground that is seen between crowns is lit where both are the same.
float trees_apart(in trees_Stand stand, in vec3 to_eye, in vec3 up) {
    vec3 to_sun = frame.sun_direction.xyz;
    float apart = length(to_sun / max(dot(to_sun, up), 0.05) - to_eye / max(dot(to_eye, up), 0.05));
    return min(apart / mix(stand.width, trees_conifer_width, stand.conifers), 1.0);
}

/// Share of the sun's light that reaches the sunny side of crowns past others.
float trees_crown_sunlight(in trees_Stand stand, in float per_m2) {
    vec2 slant = trees_filled(stand, per_m2, dot(frame.sun_direction.xyz, frame.eye_up.xyz)) - trees_filled(stand, per_m2, 1.0);
    return mix(trees_light, 1.0, crown_sunlight(slant.x + slant.y, slant.x / max(slant.x + slant.y, 1e-6)));
}

/// A map of land cover, and where it tells nothing the shares that come with the program.
LandCover trees_map(in VertexFrame ground) {
#if HAS_houses
    return LandCover(0.0, 0.0, 0.0, 1.0);  // the heights have all trees
#endif
    LandCover map = land_cover_at(ground.post, 1.0);
    LandClasses land = land_classes_at(ground.post, 1.0, ground.up);
    float growth = climate_ground(climate_place(ground.up), ground.height_m).growth + trees_line_m / 450.0;
    float known = land.known * (1.0 - map.known), trees = land.trees * smoothstep(0.55, 1.05, growth);
    return LandCover(mix(map.trees, trees, known), map.plants, map.ice, max(map.known, known));
}

/// Species differ in their green, and stand in groups. Of mean 1.
vec3 trees_hue(in InstanceSite at) {
    float group = trees_noise(at.ground.anchored_m, 55.0, 10u), own = fract(7.0 * at.random.y + 3.0 * at.random.w);
    float kind = clamp(0.55 * group + 0.45 * own, 0.0, 1.0) - 0.5;
    return (1.0 + 0.5 * (at.random.w - 0.5)) * (1.0 + kind * vec3(0.75, 0.3, -0.1));
}

void trees_place_tree(in InstanceSite at, inout Instance it) {
    trees_Stand stand = trees_stand(at.ground.up, at.ground.height_m, at.normal, at.ground.anchored_m,
                                    water_at(at.ground.post, 1.0).x, trees_map(at.ground));
    bool conifer = at.random.y < stand.conifers;
    Crown crown = trees_crown(stand, conifer);
    it.kind = conifer ? 0 : 1;
    it.taper = conifer ? 1.0 : 0.0;
    it.density = stand.density;
    it.height_m = crown.height_m * (0.65 + 0.7 * at.random.z);
    it.width_m = crown.width_m * (0.65 + 0.7 * at.random.z) * (0.85 + 0.3 * at.random.w);
    it.sun = trees_crown_sunlight(stand, trees_per_m2(stand) * (1.0 - instances_shadow_share(at.ground.position_m, trees_range_m())));
    it.ragged = 1.0;
    it.colour = (conifer ? trees_needles : stand.leaves) * trees_hue(at);
}

void trees_on_material(inout Surface s) {
    trees_Stand stand = trees_stand(s.up, s.height_m, s.ground_normal, s.anchored_m, water_of(s).x,
                                    s.forest < 0.0 ? land_cover_at(s.post, s.pixel_posts) : LandCover(s.forest, 0.0, 0.0, 1.0));
    float per_m2 = trees_per_m2(stand), range_m = trees_range_m();
    float shaded = per_m2 * instances_shadow_share(s.position_m, range_m);  // by shadows that are drawn
    float to_sun = dot(frame.sun_direction.xyz, s.up), apart = trees_apart(stand, -s.position_m / s.distance_m, s.up);

    // The ground between the trees. Shadows that are drawn darken it later.
    float share = instances_share(s.distance_m, range_m);  // of the trees that are drawn, and hide ground
    float drawn = trees_lit(stand, shaded, to_sun, mix(1.0, apart, share));
    float sun = trees_lit(stand, per_m2, to_sun, apart) / drawn;
    s.diffuse *= sun;
    s.specular *= sun;
    s.ambient *= trees_lit(stand, per_m2, 0.6, 1.0);  // the sky's light comes from 53 degrees off the vertical in the mean

    // The cover stands for the trees that are not drawn.
    float left = per_m2 * (1.0 - share);
    vec2 filled = trees_filled(stand, left, dot(-s.position_m, s.up) / s.distance_m);
    // Sprites are at least a pixel wide: they hide more than crowns, as if these stood more evenly.
    float cover = 1.0 - crown_gap(filled.x + filled.y, 0.15);
    vec3 colour = trees_tone(s) * mix(stand.leaves, trees_needles, filled.x / max(filled.x + filled.y, 1e-6));
    s.diffuse = mix(s.diffuse, colour * trees_crown_sunlight(stand, per_m2) / drawn, cover);
    s.ambient = mix(s.ambient, colour, cover);
    s.specular *= 1.0 - cover;
}

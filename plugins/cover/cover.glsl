//! provides  materials: natural ground by climate, height, date and shape
//! hook      albedo, normal
//! reads     the climate's tables, a map of land cover, height [m], slope and aspect, ground coordinates [m]
//! writes    forest, material, material_weight, texture_at, gloss, diffuse, ambient, specular, emissive, shininess, normal
//! source    core/climate/cover.h has the climate's; what shape does to it is the README's

//@ include lib/climate.glsl
//@ include lib/ground.glsl
#if HAS_houses
//@ include lib/houses.glsl
#endif
//@ include lib/land.glsl
//@ include lib/noise.glsl
//@ include lib/repeats.glsl
//@ include lib/rivers.glsl

uniform sampler2DArray cover_albedo;

// Where the climate's word is not taken.
uniform int cover_trees = 0; //@ enum(climate, line, none) static label("Trees") description("Up to the climate's tree line, up to a given line, or none")
uniform float cover_tree_line_m = 2000.0; //@ range(-1000, 9000) unit(m) label("Tree line") description("Height of the given tree line")
uniform float cover_tree_shift_m = 0.0; //@ range(-3000, 3000) unit(m) label("Tree line shift") description("Added to the climate's tree line; negative where wind, grazing or logging lower it")
uniform int cover_rain = 0; //@ enum(climate, given) static label("Rain") description("By the climate, or by a given dryness")
uniform float cover_dryness = 2.0; //@ range(0, 10) label("Dryness") description("Given dryness, precipitation over what the temperature requires: below 0.5 desert, below 1 steppe, from 1.75 forest")
uniform float cover_rain_factor = 1.0; //@ range(0, 10) label("Rain factor") description("Factor on the climate's precipitation")
uniform int cover_snow = 0; //@ enum(climate, line, none) static label("Snow") description("By the climate and the date, above a given line, or none")
uniform float cover_snow_line_m = 2500.0; //@ range(-1000, 9000) unit(m) label("Snow line") description("Height of the given snow line, on level ground")
uniform float cover_snow_shift_m = 0.0; //@ range(-3000, 3000) unit(m) label("Snow line shift") description("Added to the climate's snow line; negative in a snowy year")
uniform bool cover_ice = true; //@ static label("Permanent ice")
uniform float cover_rivers = 5.0; //@ range(0, 20) label("Rivers") description("Rivers where water runs by the heights and the rain: from afar at most so much wider than they are, so that they are seen; 0: none")

// What shape does to it.
uniform float cover_aspect_m = 480.0; //@ range(0, 3000) unit(m) label("Aspect") description("Rise of the snow line on walls that face the noon sun, relative to level ground")
uniform vec2 cover_rock_deg = vec2(36.0, 52.0); //@ range(0, 90) unit(deg) label("Rock from, to") description("Slopes between which soil becomes rock")
uniform vec2 cover_bare_deg = vec2(46.0, 64.0); //@ range(0, 90) unit(deg) label("Snow slides from, to") description("Slopes between which snow becomes rare")
uniform float cover_open_flats = 0.3; //@ range(0, 1) label("Open flats") description("Fraction of level ground in temperate forests that is meadow")
uniform float cover_noise = 1.0; //@ range(0, 3) label("Ragged edges") description("Irregularity of the limits between materials")
uniform float cover_texture_m = 12.0; //@ range(0.1, 100000) unit(m) label("Texture size") description("Size of the grain, visible from near")
uniform float cover_crowns = 1.0; //@ range(0, 1) label("Crowns") description("How far forests show the crowns of their trees")
uniform float cover_grain = 1.0; //@ range(0, 1) label("Grain") description("Strength of the grain, visible from near")

// What it looks like, as albedo.
uniform vec3 cover_desert = vec3(0.47, 0.35, 0.22); //@ colour label("Desert")
uniform vec3 cover_steppe = vec3(0.31, 0.25, 0.13); //@ colour label("Steppe, dry")
uniform vec3 cover_steppe_green = vec3(0.178, 0.172, 0.082); //@ colour label("Steppe, green")
uniform vec3 cover_grass = vec3(0.105, 0.132, 0.045); //@ colour label("Grass, green")
uniform vec3 cover_straw = vec3(0.195, 0.172, 0.082); //@ colour label("Grass, dry or frozen")
uniform vec3 cover_tundra = vec3(0.15, 0.14, 0.062); //@ colour label("Alpine grass")
uniform vec3 cover_heath = vec3(0.074, 0.060, 0.036); //@ colour label("Heath") description("Moors of cool and wet country")
uniform vec3 cover_scrub = vec3(0.095, 0.092, 0.047); //@ colour label("Scrub") description("Evergreen shrubs on the slopes of dry, mild country")
uniform vec3 cover_conifers = vec3(0.033, 0.045, 0.020); //@ colour label("Needleleaf forest")
uniform vec3 cover_broadleaf = vec3(0.049, 0.075, 0.024); //@ colour label("Broadleaf forest")
uniform vec3 cover_leafless = vec3(0.088, 0.073, 0.052); //@ colour label("Bare broadleaf forest")
uniform vec3 cover_crop = vec3(0.054, 0.088, 0.027); //@ colour label("Fields, green")
uniform vec3 cover_ripe = vec3(0.245, 0.192, 0.085); //@ colour label("Fields, ripe")
uniform vec3 cover_soil = vec3(0.150, 0.112, 0.076); //@ colour label("Soil and bare ground")
uniform vec3 cover_town = vec3(0.165, 0.148, 0.114); //@ colour label("Towns")
uniform vec3 cover_roof = vec3(0.135, 0.128, 0.125); //@ colour label("Roofs") description("Of a surface model; some houses have others")
uniform vec3 cover_wall = vec3(0.275, 0.250, 0.212); //@ colour label("Walls")
uniform vec3 cover_street = vec3(0.165, 0.162, 0.155); //@ colour label("Streets")
uniform vec3 cover_rock = vec3(0.202, 0.200, 0.192); //@ colour label("Rock")
uniform vec3 cover_water = vec3(0.055, 0.102, 0.145); //@ colour label("Rivers' water")
uniform vec3 cover_floor = vec3(0.19, 0.18, 0.16); //@ colour label("Sea floor")
uniform vec3 cover_firn = vec3(0.62, 0.73, 0.82); //@ colour label("Ice")
uniform vec3 cover_white = vec3(0.75, 0.79, 0.855); //@ colour label("Snow")

// Of sand, grass, rock, snow.
uniform vec4 cover_specular = vec4(0.02, 0.012, 0.025, 0.08); //@ range(0, 1) label("Specular")
uniform vec4 cover_shininess = vec4(12.0, 10.0, 16.0, 24.0); //@ range(1, 1000) label("Shininess")

const int cover_last_level = 10;  // of the albedo textures, 1 x 1: their mean

/// Shares of the ground, 0..1.
struct cover_Shares {
    float rock, forest, ice, snow;
};

/// What is around a point, whatever the climate.
struct cover_Shape {
    float steep;   // tangent of the slope, as if posts were 10 m apart
    float sunny;   // how far the slope leans towards the noon sun, -1..1
    vec4 small, broad;  // of patches, faded with distance: tone, hue, shrubs, fine tone, less 0.5
    float ragged;  // what limits wander by, about -1..1
    float fine;    // how far the ground's cover follows single slopes: 1 from near, less in overviews
    float across_m;  // side of a square as large as the pixel on the ground
};

/// Posts far apart cut off slopes: by an eighth for each doubling.
float cover_steepness(in Surface s, in float pixel_m) {
    float c = clamp(dot(s.ground_normal, s.up), 0.02, 1.0);
    float apart_m = max(1.0 / frame.normal_texels_per_m, pixel_m);
    return sqrt(1.0 - c * c) / c * (1.0 + 0.125 * max(log2(apart_m * 0.1), 0.0));
}

/// Slopes that face the equator are sunny; at the equator none is more than another.
float cover_sunniness(in Surface s) {
    float sine = dot(s.up, frame.polar_axis.xyz);
    vec3 north = frame.polar_axis.xyz - sine * s.up;
    return -dot(s.ground_normal, north) * inversesqrt(max(dot(north, north), 1e-6)) *
           clamp(2.4 * sine, -1.0, 1.0);
}

cover_Shape cover_shape(in Surface s, in float pixel_m) {
    cover_Shape shape;
    shape.steep = cover_steepness(s, pixel_m);
    shape.sunny = cover_sunniness(s);
    shape.across_m = sqrt(length(s.ground_dx_m) * length(s.ground_dy_m));
    const float small_per_m = 1.0 / 410.0;
    shape.small = cover_patch(ground_repeats(s.anchored_m, vec2(small_per_m)), small_per_m * s.ground_dx_m.xy,
                              small_per_m * s.ground_dy_m.xy);
    shape.broad = cover_turned_patch(s, cover_turn / 4700.0);
    // Near limits: from afar they are ragged by the ground's own shape.
    float near = mix(0.1, 1.0, 1.0 / (1.0 + pixel_m * pixel_m * 0.01));
    // From afar colour would spoil what light tells of slopes: there it follows height and climate.
    shape.fine = 1.0 - 0.8 * smoothstep(30.0, 400.0, pixel_m);
    shape.ragged = near * cover_noise * (1.7 * shape.broad.r + 1.5 * shape.small.r + 1.1 * shape.broad.a);
    return shape;
}

/// A share of the ground as near ground has it: here all, there nothing, of the same mean (within 0.02).
/// @param noise  of mean 0 and standard deviation 0.19
/// @param near   0..1: how far such places are larger than pixels
float cover_mosaic(in float share, in float noise, in float near) {
    float edge = mix(0.2, 0.05, near);  // of a place, so that it has no stairs
    float limit = smoothstep(-0.36, 0.36, noise);
    float here = smoothstep(limit - edge, limit + edge, mix(-edge, 1.0 + edge, share));
    return mix(share, here, near);
}

/// From near rock among trees, clearings in woods and the last snow have edges.
void cover_part(inout cover_Shares shares, inout LandClasses land, in cover_Shape shape) {
    float near = 0.9 / (1.0 + shape.across_m * shape.across_m * 0.005);
    float middle = 0.9 / (1.0 + shape.across_m * shape.across_m * 0.0002);
    shares.rock = cover_mosaic(shares.rock, shape.small.r + 0.6 * shape.small.a, near);
    shares.forest = cover_mosaic(shares.forest, shape.broad.r + 0.7 * shape.small.g, middle);
    vec4 patches = mix(shape.small, shape.broad, smoothstep(10.0, 50.0, shape.across_m));  // small ones repeat
    shares.snow = cover_mosaic(shares.snow, 0.8 * patches.g + 0.8 * patches.a, middle);
    land.fields = cover_mosaic(land.fields, shape.broad.g + 0.7 * shape.small.r, near);
    land.bare = cover_mosaic(land.bare, shape.broad.a + 0.7 * shape.small.r, near);
    land.towns = cover_mosaic(land.towns, 0.6 * shape.broad.g + 0.6 * shape.small.r + 0.8 * shape.small.a, middle);
}

/// Tangents of two slopes, in degrees, of which the second is the greater one: else smoothstep is undefined.
vec2 cover_tangents(in vec2 slopes_deg) {
    vec2 tangents = tan(radians(min(slopes_deg, vec2(89.0))));
    return vec2(tangents.x, max(tangents.y, tangents.x + 1e-3));
}

/// Warmth for plants where a tree line is given: as steep as the climate's.
float cover_growth(in ClimateGround ground, in float height_m) {
    float by_line = 1.0 + (cover_tree_line_m - height_m) / 450.0;
    return cover_trees == 1 ? by_line : ground.growth + cover_tree_shift_m / 450.0;
}

float cover_dryness_of(in ClimateGround ground) {
    return cover_rain == 1 ? cover_dryness : ground.dryness * cover_rain_factor;
}

/// Ice and snow of a point, before slopes.
vec2 cover_white_at(in vec2 place, in float height_m) {
    vec2 read = vec2(-10.0, 0.0);
    if (cover_snow == 0 || cover_ice) read = climate_snow(place, height_m - cover_snow_shift_m);
    if (!cover_ice) read.x = -10.0;
    if (cover_snow == 1) read.y = smoothstep(-180.0, 180.0, height_m - cover_snow_line_m);
    if (cover_snow == 2) read.y = 0.0;
    return read;
}

/// Open ground without snow: desert, steppe, grass, and above them what is bare.
/// @param rain    dryness, with what the slope does to it
/// @param growth  warmth for plants
/// @param steep   tangent of the slope
/// @param mapped  0..1: how far a map of land cover says that there is no forest, whatever the rain
vec3 cover_open(in ClimateGround ground, in float rain, in float growth, in float steep, in float mapped) {
    vec3 steppe = mix(cover_steppe, cover_steppe_green, ground.green * smoothstep(0.4, 1.0, rain));
    vec3 meadow = mix(cover_straw, cover_grass, ground.green);
    meadow = mix(mix(meadow, cover_tundra, 0.75), meadow, smoothstep(0.7, 1.7, growth));
    vec3 open = mix(cover_desert, steppe, smoothstep(0.25, 0.8, rain));
    open = mix(open, meadow, smoothstep(0.8, 1.9, rain));
    // Where winters are mild shrubs stay green through the drought: chaparral, maquis, fynbos.
    float shrubs = smoothstep(0.55, 1.1, rain) * smoothstep(6.0, 11.0, ground.temperature) * smoothstep(0.06, 0.4, steep) *
                   (1.0 - mapped * smoothstep(1.0, 1.8, rain));
    return mix(open, cover_scrub, 0.85 * shrubs);
}

/// A number of a plot, 0..1: fields and blocks of houses of some 320 x 190 m or twice that, with bent borders, and of
/// what lies around them, of 1280 x 760 m; far away those alone.
/// @returns two numbers, and how far plots are seen
vec3 cover_plot(in Surface s, in cover_Shape shape) {
    const mat2 per_m = mat2(0.7986 / 320.0, 0.6018 / 190.0, -0.6018 / 320.0, 0.7986 / 190.0);
    float single = 1.0 - smoothstep(70.0, 260.0, shape.across_m), seen = 1.0 - smoothstep(150.0, 500.0, shape.across_m);
    seen *= 1.0 - 0.85 * smoothstep(0.04, 0.16, shape.steep);  // steep ground is no field
    vec2 within;
    ivec2 cell = ground_cell(s.anchored_m + 120.0 * shape.broad.rg, per_m, within), large = cell >> 1;
    float around = noise_random(cell >> 2, 2u);
    if (fract(61.0 * around) < 0.5) cell = 2 * large;
    float one = noise_random(cell, 0u);
    vec2 number = 0.5 + 0.35 * (vec2(around, fract(257.0 * around)) - 0.5) + 1.2 * shape.broad.ga +
                  0.75 * single * (vec2(one, fract(257.0 * one)) - 0.5);
    return vec3(clamp(number, 0.0, 1.0), seen);
}

/// Fields are green, ripe or bare, and most of them between; from afar their mean.
vec3 cover_field(in vec3 plot, in float green) {
    float greens = 0.12 + 0.75 * green;
    vec3 other = mix(cover_soil, cover_ripe, 0.5), one = mix(cover_soil, cover_ripe, plot.y);
    vec3 mean = mix(other, cover_crop, greens);
    one = mix(cover_crop, one, smoothstep(greens - 0.4, greens + 0.4, plot.x));
    // Nearly half of a field is as all are: hedges, weeds and what the last year has left.
    return mix(1.0, 0.78 + 0.44 * fract(7.0 * plot.y), plot.z) * mix(mean, one, 0.55 * plot.z);
}

/// Ground without trees, by what covers land.
vec3 cover_land(in LandClasses land, in Surface s, in ClimateGround ground, in float growth, in cover_Shape shape) {
    float moor = smoothstep(-8.5, -5.5, -ground.temperature) * smoothstep(2.0, 4.0, ground.dryness);
    // In dry country flat ground by rivers is watered, and slopes above it are not.
    float drained = smoothstep(0.03, 0.12, shape.steep) - smoothstep(0.3, 1.1, shape.steep + max(ground.dryness - 0.9, 0.0));
    float watered = ground.green * (1.0 - 0.6 * max(drained, 0.0));
    vec3 grass = mix(cover_straw, cover_grass, watered);
    grass = mix(mix(cover_steppe, cover_steppe_green, watered), grass, smoothstep(0.4, 1.1, ground.dryness));
    grass = mix(mix(grass, cover_tundra, 0.75), grass, smoothstep(0.7, 1.7, growth));
    vec3 low = mix(mix(grass, cover_heath, 0.55 * moor), mix(cover_scrub, cover_heath, 0.8 * moor), land.shrubs);
    vec3 plot = cover_plot(s, shape);
    float gardens = 0.5 + plot.z * (1.6 * plot.x - 0.8) + 1.5 * shape.small.a + shape.small.g;
    vec3 town = mix(cover_town * (0.6 + 0.6 * plot.y), mix(grass, cover_broadleaf, 0.55), 0.3 + 0.6 * clamp(gardens, 0.0, 1.0));
    // Where people live meadows have owners, and each its own grass.
    float owned = plot.z * smoothstep(0.02, 0.2, land.settled - 2.0 * shape.steep);
    low *= 1.0 + owned * ((plot.x - 0.5) * vec3(0.7, 0.65, 0.6) + (plot.y - 0.5) * vec3(0.25, 0.1, 0.0));
    float rest = max(1.0 - land.trees - land.fields - land.bare - land.towns, 0.0);
    vec4 shares = vec4(rest, land.fields, land.bare, land.towns) / max(rest + land.fields + land.bare + land.towns, 1e-3);
    vec3 open = shares.x * low + shares.y * cover_field(plot, ground.green) + shares.z * cover_soil + shares.w * town;
    // The ground's colour is that of its soil: fields and meadows show less of it, towns the least.
    float bare_tint = mix(0.95, 0.4, smoothstep(0.5, 1.2, ground.dryness));
    vec3 colour = open * exp2(dot(shares, vec4(0.75, 0.6, bare_tint, 0.25)) * land.tint);
    // Soils and plants have as much green as red and blue in the mean: with less they would be pink.
    return vec3(colour.r, max(colour.g, 0.5 * (colour.r + colour.b)), colour.b);
}

vec3 cover_forest(in ClimateGround ground, in float growth) {
    // Needles where it is cold; leaves that fall where winters are, and those that stay in the tropics.
    vec3 forest = mix(cover_conifers, cover_broadleaf, smoothstep(3.0, 11.0, ground.temperature));
    forest *= mix(1.0, 0.78, smoothstep(18.0, 24.0, ground.temperature));
    float falls = smoothstep(3.0, 9.0, ground.temperature) * (1.0 - smoothstep(13.0, 17.0, ground.temperature));
    return mix(forest, cover_leafless, 0.5 * falls * (1.0 - ground.green));
}

// Of this pixel, for the hook normal.
vec2 cover_canopy_slope = vec2(0.0);

cover_Shares cover_shares(in ClimateGround ground, in LandClasses land, in vec2 white, in float rain, in float growth,
                          in cover_Shape shape) {
    cover_Shares shares;
    float ragged = shape.ragged;
    vec2 rocky = cover_tangents(cover_rock_deg);
    // In warm and wet country roots hold soil on slopes up to half as steep again.
    float rooted = 1.0 + 0.5 * smoothstep(1.0, 5.0, growth) * smoothstep(1.0, 2.0, rain);
    shares.rock = smoothstep(rocky.x * rooted, rocky.y * rooted, shape.steep * (1.0 + 0.2 * ragged));
    // Steep rock has plants on its ledges; cliffs have no ledges.
    shares.rock *= 1.0 - 0.2 * smoothstep(0.5, 1.5, growth) * smoothstep(0.8, 1.6, rain) * (1.0 - smoothstep(1.2, 1.9, shape.steep));
    // Above the growing limit soil thins out, first where it is steep.
    float soil = growth + 0.3 * ragged - 0.35 * shape.steep;
    shares.rock = max(shares.rock, 1.0 - smoothstep(-0.35, 0.55, soil));

    float wooded = smoothstep(1.15, 2.15, rain * (1.0 + 0.22 * ragged)) *
                   smoothstep(0.82, 1.16, growth + 0.16 * ragged - 0.06 * shape.steep);
    float temperate = smoothstep(3.0, 6.0, ground.temperature) * (1.0 - smoothstep(15.0, 19.0, ground.temperature));
    float flats = 1.0 - smoothstep(0.01, 0.15, shape.steep * (1.0 + 0.3 * ragged));
    wooded *= 1.0 - cover_open_flats * temperate * flats * shape.fine;
    float line = smoothstep(0.55, 1.05, growth + 0.16 * ragged - 0.06 * shape.steep);
    wooded = mix(wooded, land.trees * line, land.known);
    shares.forest = cover_trees == 2 ? 0.0 : wooded * (1.0 - smoothstep(0.85 * rooted, 1.3 * rooted, shape.steep));

    vec2 bare = cover_tangents(cover_bare_deg);
    float holds = 1.0 - 0.85 * smoothstep(bare.x, bare.y, shape.steep * (1.0 + 0.25 * ragged));
    // Cold ground that is as bright as ice is ice, whatever the climate has.
    float bright = smoothstep(0.7, 1.4, land.tint.g) * (1.0 - smoothstep(-8.0, -4.0, ground.temperature)) * land.known;
    shares.ice = max(smoothstep(0.0, 0.7, white.x + 0.3 * ragged), cover_ice ? bright : 0.0) * holds;
    float edge = 4.0 * white.y * (1.0 - white.y);
    shares.snow = smoothstep(0.12, 0.88, white.y + 0.22 * edge * ragged) * holds;
    return shares;
}

/// What a map of land cover says, instead of the climate.
/// @param shares, rain  changed as far as the map has a class
void cover_take_map(in LandCover map, inout cover_Shares shares, inout float rain) {
    if (cover_trees == 2) {
        map.plants += map.trees;
        map.trees = 0.0;
    }
    if (!cover_ice) map.ice = 0.0;
    float left = max(1.0 - map.ice, 1e-3);
    float trees = map.trees / left, plants = map.plants / left, bare = max(1.0 - trees - plants, 0.0);
    // Bare ground is sand where the climate is dry, and rock elsewhere: young lava, till, scree.
    float rock = bare * max(shares.rock, smoothstep(0.25, 0.9, rain)), sand = bare - rock;
    shares.rock = mix(shares.rock, rock, map.known);
    shares.forest = mix(shares.forest, trees / max(1.0 - rock, 1e-3), map.known);
    shares.ice = mix(shares.ice, map.ice, map.known);
    float watered = mix(0.2, max(rain, 1.2), plants / max(plants + sand, 1e-3));
    rain = mix(rain, watered, map.known * (1.0 - rock));
}

#if HAS_houses
/// Of a surface model the heights say what stands where: trees nowhere else, and no rock at the foot of walls.
void cover_take_houses(in Surface s, in Houses houses, inout cover_Shares shares, inout LandClasses land) {
    Houses around = houses_at(s.post, 4.0 * max(s.pixel_posts, 1.0));
    shares.rock *= 1.0 - smoothstep(0.05, 0.3, around.built + around.street + around.trees);
#ifndef BEYOND_PX
    shares.forest = land.trees = land.towns = 0.0;
#endif
    shares.snow *= 1.0 - 0.7 * houses.trees;
}

/// Clumps of leaves on crowns shade each other.
float cover_leaves(in Surface s) {
    vec4 clumps = cover_turned_patch(s, cover_turn / 9.0), boughs = cover_turned_patch(s, cover_turn / 37.0);
    return max(0.9 + 2.2 * clumps.a + 1.5 * clumps.r + 1.2 * boughs.a, 0.25);
}
#endif

/// The grain of the heaviest materials, as a factor of mean 1, and their gloss; fades by itself.
vec4 cover_grain_of(in Surface s) {
    vec4 grain = vec4(0.0);
    int count = s.material_weight.y > 0.05 ? 2 : 1;
    for (int i = 0; i < count; ++i) {
        vec4 read = textureGrad(cover_albedo, vec3(s.texture_at, float(s.material[i])), s.texture_dx, s.texture_dy);
        vec3 mean = texelFetch(cover_albedo, ivec3(0, 0, s.material[i]), cover_last_level).rgb;
        grain += (count == 1 ? 1.0 : s.material_weight[i]) * vec4(read.rgb / mean, read.a);
    }
    return vec4(mix(vec3(1.0), grain.rgb, cover_grain), grain.a);
}

/// The two heaviest of sand, grass, rock and snow.
void cover_take(inout Surface s, in vec4 weights) {
    float most = max(max(weights.x, weights.y), max(weights.z, weights.w));
    int first = weights.x == most ? 0 : weights.y == most ? 1 : weights.z == most ? 2 : 3;
    weights[first] = -1.0;
    float next = max(max(weights.x, weights.y), max(weights.z, weights.w));
    int second = weights.x == next ? 0 : weights.y == next ? 1 : weights.z == next ? 2 : 3;
    s.material = ivec2(first, second);
    s.material_weight = vec2(most, next) / max(most + next, 1e-4);
}

void cover_on_albedo(inout Surface s) {
    float pixel_m = max(length(s.ground_dx_m), length(s.ground_dy_m));
    cover_Shape shape = cover_shape(s, pixel_m);
    vec2 place = climate_place(s.up);
    ClimateGround ground = climate_ground(place, s.height_m);
    vec2 white = cover_white_at(place, s.height_m - cover_aspect_m * shape.sunny);
    float growth = cover_growth(ground, s.height_m);
    float rain = cover_dryness_of(ground) * (1.0 - 0.45 * shape.sunny * shape.fine);
#if HAS_mapped
    LandCover map = land_cover_at(s.post, s.pixel_posts);
#else
    const LandCover map = LandCover(0.0, 0.0, 0.0, 0.0);
#endif
    LandClasses land = land_classes_at(s.post, s.pixel_posts, s.up);
    // Where another climate is asked for, what grows in this one says nothing.
    land.known *= cover_rain == 1 || cover_rain_factor != 1.0 ? 0.0 : 1.0 - map.known;
    cover_Shares shares = cover_shares(ground, land, white, rain, growth, shape);
    cover_take_map(map, shares, rain);
#if HAS_houses
    Houses houses = houses_at(s.post, s.pixel_posts);
    cover_take_houses(s, houses, shares, land);
#endif
    s.forest = shares.forest * (1.0 - shares.rock);
    cover_part(shares, land, shape);

    // Patches are for the eye that is near: none of them is seen from afar, and the broad ones from nowhere but there.
    float near = 1.0 / (1.0 + shape.across_m * shape.across_m * 0.00005);
    float level = 1.0 - smoothstep(0.015, 0.08, shape.steep);
    float wide = 1.0 / (1.0 + shape.across_m * shape.across_m * mix(5e-5, 1e-6, level));
    float tone = near * (0.7 * shape.small.a + 0.45 * shape.small.r) + wide * (0.4 * shape.broad.a + 0.3 * shape.broad.r);
    vec3 open = cover_open(ground, rain * (1.0 + 0.3 * shape.ragged), growth, shape.steep, map.known);
    open = mix(open, cover_land(land, s, ground, growth, shape), land.known);
    // Dry land lies as low as the shore of the Dead Sea.
    float floor_share = max((1.0 - smoothstep(-30.0, -12.0, s.height_m)) * smoothstep(0.6, 1.2, rain),
                            1.0 - smoothstep(-600.0, -440.0, s.height_m));
    open = mix(open, cover_floor, floor_share);
    open *= 1.0 + 0.8 * tone + near * 0.25 * shape.small.g * vec3(1.0, 0.0, -0.6);
    vec3 rock = mix(cover_rock, 0.45 * cover_desert + 0.3 * cover_rock, 1.0 - smoothstep(0.3, 1.0, rain));
    // Wet rock is dark, with lichen and moss on it.
    rock *= (1.0 + 1.6 * tone) * mix(1.0, 0.6, smoothstep(2.5, 4.5, rain));
    // Stands of another age or kind are darker or bluer.
    vec3 forest = cover_forest(ground, growth) * (1.0 + 1.6 * tone + wide * shape.broad.g * vec3(0.65, 0.45, 0.1));
    vec3 albedo = mix(open, rock, shares.rock);
    // Pixels of hundreds of metres have clearings in them, and dark woods would hide their own relief.
    float trees = shares.forest * (1.0 - shares.rock) * (0.5 + 0.5 * shape.fine);
#if HAS_near
    if (trees > 0.02) {
        cover_Canopy canopy = cover_canopy_at(s, pixel_m, shape.across_m, 1.0 - smoothstep(3.0, 11.0, ground.temperature),
                                               cover_crowns);
        cover_canopy_slope = trees * canopy.slope;
        forest *= max(canopy.light, 0.2);
    }
#endif
    albedo = mix(albedo, forest, trees);
    vec2 river = river_at(s.post, shape.across_m, 0.6 * level * shape.broad.ra, cover_rivers);
    // On the banks plants have water when the country around is dry.
    vec3 bank = mix(mix(cover_grass, cover_broadleaf, 0.6), cover_tundra, 1.0 - smoothstep(0.5, 1.2, growth));
    albedo = mix(albedo, bank, 0.7 * max(river.y - river.x, 0.0) * (1.0 - smoothstep(0.1, 0.4, shape.steep)));
    // Near by one looks into the water, from afar at the sky in it.
    albedo = mix(albedo, cover_water * (0.4 + 0.6 * smoothstep(2.0, 30.0, shape.across_m)), river.x);
#if HAS_houses
    albedo = mix(albedo, cover_street, smoothstep(0.2, 0.8, houses.street));
    albedo = mix(albedo, forest * cover_leaves(s), smoothstep(0.15, 0.6, houses.trees));
    albedo = houses_over(albedo, houses, shape.steep, cover_roof, cover_wall);
#endif
    // From above trees hide most of the snow under them.
    float lying = shares.snow * (1.0 - 0.94 * smoothstep(0.0, 0.9, trees));
    // Ice that the wind has swept is bluer and darker than what lies in its lee.
    float swept = clamp(1.1 * shape.broad.r + 0.7 * shape.small.r, -0.5, 0.5);
    albedo = mix(albedo, cover_firn * (1.0 + swept * vec3(0.5, 0.36, 0.2)), shares.ice);
    lying = max(lying, shares.ice * shares.snow) * (1.0 - shares.ice * (0.3 - 0.6 * swept));
    albedo = mix(albedo, cover_white, lying);

    float covered = max(lying, shares.ice);
    float sandy = (1.0 - smoothstep(0.4, 1.0, rain)) * (1.0 - shares.rock);
    cover_take(s, vec4(sandy, 1.0 - sandy - (1.0 - sandy) * shares.rock, shares.rock, 0.0) * (1.0 - covered) +
                      vec4(0.0, 0.0, 0.0, covered));
    float per_m = 1.0 / cover_texture_m;
    s.texture_at = ground_repeats(s.anchored_m, vec2(per_m));
    s.texture_dx = s.ground_dx_m.xy * per_m;
    s.texture_dy = s.ground_dy_m.xy * per_m;
    s.gloss = 0.5;
#if HAS_near
    if (pixel_m < min(cover_texture_m, cover_near_m)) {
        vec4 grain = cover_grain_of(s);
#if HAS_houses
        grain = mix(grain, vec4(1.0, 1.0, 1.0, 0.5), min(houses.built + houses.street, 1.0));
#endif
        albedo *= grain.rgb;
        s.gloss = grain.a;
    }
#endif
    s.diffuse = albedo;
    // Snow lights the sky and the slopes around it, and these the snow: by 1 / (1 - 0.8 x 0.3) where all is white.
    s.ambient = albedo * (1.0 + 0.3 * covered);
    s.emissive = vec3(0.0);
    s.specular = vec3(dot(s.material_weight, vec2(cover_specular[s.material.x], cover_specular[s.material.y])));
    s.shininess = dot(s.material_weight, vec2(cover_shininess[s.material.x], cover_shininess[s.material.y]));
}

void cover_on_normal(inout Surface s) {
    s.normal = normalize(s.normal + cover_canopy_slope.x * s.tangent + cover_canopy_slope.y * s.bitangent);
}

//! provides  water where the DEM has sea and lakes, or up to a level: a mirror of the sky with the sun's
//!           glitter and waves near the eye, the floor seen through it, and in overviews the floor's relief
//! hook      displace, material, visibility, lit
//! reads     water pages, height [m], diffuse, the sky's radiance without the sun's disc
//! writes    position; normal, diffuse, ambient, specular, shininess; factor; radiance
//! source    light in water: R. M. Pope and E. S. Fry, Applied Optics 36 (1997), 8710, and A. Bricaud, A. Morel
//!           and L. Prieur, Limnology and Oceanography 26 (1981), 43; waves: C. Cox and W. Munk,
//!           J. Optical Society of America 44 (1954), 838; their mirror: E. Bruneton, F. Neyret and N.
//!           Holzschuch, Real-time realistic ocean lighting, Computer Graphics Forum 29 (2010), 487; their
//!           spectrum: W. J. Pierson and L. Moskowitz, J. Geophysical Research 69 (1964), 5181; fetch: K.
//!           Hasselmann et al., JONSWAP, Ergaenzungsheft zur Deutschen Hydrographischen Zeitschrift A 12 (1973)

//@ include lib/ground.glsl
//@ include lib/noise.glsl
//@ include lib/repeats.glsl
//@ include lib/surface.glsl
//@ include lib/surround.glsl
//@ include lib/water.glsl

uniform sampler2D sea_patches;

uniform float sea_level_m = 0.0; //@ range(-500, 9000) unit(m) label("Level") description("0: water where the DEM has sea and lakes. Otherwise all ground at or below this height is flooded")
uniform float sea_least_depth_m = 10.0; //@ range(0, 1000) unit(m) label("Least depth") description("Added to the depth of flooded ground, whose height may equal the level")
uniform float sea_wind_m_s = 5.0; //@ range(0, 20) unit(m/s) label("Wind") description("Wind speed: more wind raises longer waves and widens the sun's glitter")
uniform float sea_wind_deg = 240.0; //@ range(0, 360) unit(°) label("Wind from") description("Direction that the wind blows from, clockwise from north")
uniform float sea_yellow = 0.2; //@ range(0, 10) unit(1/m) label("Yellow substance") description("Absorption at 440 nm by dissolved matter: 0.01 in the open ocean, 0.2 near a coast, above 1 in an estuary")
uniform int sea_floor = 0; //@ enum(auto, hidden, seen) label("Floor") description("Relief of the sea's floor. auto: seen from high above, where the DEM has the floor of a sea on more than a tenth of its posts")
uniform float sea_shore = 1.0; //@ range(0, 1) label("Shores between posts") description("Synthetic bays and headlands between the DEM's posts, and slicks on the water; 0: straight from post to post, and plain water")
uniform float sea_relief = 1.0; //@ range(0, 10) label("Relief") description("Factor on the slopes that the floor is shaded with")

const vec3 sea_absorption = vec3(0.264, 0.0565, 0.0101);  // of pure water at 610, 550 and 465 nm [1/m]
const vec3 sea_yellow_by_colour = vec3(0.0925, 0.214, 0.705);  // exp(-0.014 (wavelength - 440 nm))
const vec3 sea_scattered = vec3(0.004, 0.026, 0.036);     // albedo of deep water, chosen by eye: blue-green

const vec3 sea_sand = vec3(0.30, 0.28, 0.21);  // of a floor whose colour nobody knows, chosen by eye
const float sea_tide_m = 2.0;  // added to its depth: charts count from low water
// And so much for each metre between posts: shelves slope by a hundredth or less, so that a shallow post says nothing
// of the water half-way to the next one, and bright plates would show the grid's corners.
const float sea_shelf = 0.01;

/// How much of a flood a point is: all of it up to the level, none from 0.3 m above on.
float sea_share(in float height_m) {
    return 1.0 - smoothstep(sea_level_m, sea_level_m + 0.3, height_m);
}

/// Height of the DEM itself at a point. The ground is drawn as coarsely as the picture allows, and coasts
/// and shadows on the water would move with that.
float sea_height_m(in Surface s) {
    return s.height_m + dot(surface_point(s) - s.position_m, s.up) / frame.height_range.z;
}

// Of a seen floor, chosen by eye: its colour in deep water, what is added to that on the feet of islands and at the
// shore, and the depths that these fade over [m]: blue reaches deepest.
const vec3 sea_basin = surround_sea_albedo;
const vec3 sea_feet = vec3(0.003, 0.018, 0.028);
const float sea_feet_m = 1200.0;
const vec3 sea_shallows = vec3(0.045, 0.085, 0.065);
const vec3 sea_fade_m = vec3(40.0, 130.0, 420.0);

const float sea_low_m = 4000.0;  // eyes higher than this above the water see maps, lower ones see water
const float sea_least_sine = 0.5;  // the sun shades the floor from no lower: long shadows are of no use in a map
const float sea_shadeless = 0.25;  // share of that light that comes from everywhere
const float sea_smooth_m = 30.0;  // posts or pixels that far apart have the floor's own slopes
const float sea_land_smooth_m = 300.0;  // posts that far apart have the land's own slopes

/// How much of the floor's relief is seen, 0 to 1.
float sea_seen() {
    if (sea_floor != 0) return sea_floor == 2 ? 1.0 : 0.0;
#ifdef ORTHOGRAPHIC
    float overview = 1.0;
#else
    // Small DEMs are seen as a whole from lower.
    float low_m = min(0.1 / max(frame.ground_extent.z, frame.ground_extent.w), sea_low_m);
    float overview = smoothstep(-1.0, 1.0, log2(max(frame.eye_m.w, 1.0) / low_m));
#endif
    return frame.sea_floor_share > 0.1 ? overview : 0.0;
}

/// Albedo of a seen floor and the water over it, but for the light of the shore's sand.
vec3 sea_map_albedo(in float depth_m) {
    return sea_basin + sea_feet * exp(-depth_m / sea_feet_m) + sea_shallows * exp(-sqrt(depth_m / sea_fade_m));
}

/// Normal of a steeper slope. @param steeper  factor on its tangent
vec3 sea_steep(in vec3 normal, in vec3 up, in float steeper) {
    return normalize(normal + (1.0 / max(steeper, 1e-3) - 1.0) * dot(normal, up) * up);
}

/// Light on a floor over that on level ground.
/// @param normal  of the floor, unit
/// @param steeper  factor on its slope
float sea_shade(in vec3 normal, in vec3 up, in vec3 to_sun, in float steeper) {
    float sine = clamp(dot(to_sun, up), sea_least_sine, 1.0);
    vec3 level = to_sun - dot(to_sun, up) * up;
    vec3 light = level * (sqrt(1.0 - sine * sine) / max(length(level), 1e-4)) + sine * up;
    return mix(max(dot(sea_steep(normal, up, steeper), light), 0.0) / sine, 1.0, sea_shadeless);
}

/// Factor on the slopes of a floor for its shading. Slopes between points d apart fall with d^(H - 1),
/// and H is near 2/3: coarse posts and pixels would make an ocean's mountains plains. Exaggerated ones are steep already.
float sea_steeper(in float pixel_m) {
    float apart_m = max(pixel_m, 1.0 / frame.normal_texels_per_m);
    return sea_relief * max(pow(apart_m / sea_smooth_m, 1.0 / 3.0) / frame.height_range.z, 1.0);
}

const float sea_rim = 0.08;  // of the DEM's shorter side: so far from its rim a seen floor becomes the sea beyond

/// How far a seen floor is that of the sea around the DEM, of which nobody knows the relief: 1 at the rim.
float sea_at_rim(in vec2 post) {
#if HAS_outside || defined(ORTHOGRAPHIC)
    return 0.0;  // nothing is beyond
#else
    vec2 within = min(post, frame.posts.xy - 1.0 - post) / (sea_rim * min(frame.posts.x, frame.posts.y));
    return surround_sea() * (1.0 - smoothstep(0.0, 1.0, min(within.x, within.y)));
#endif
}

/// Factor on the slopes of land for its shading, where the floor is seen: as the floor's, but less, and only where
/// posts are so far apart that mountains are plains.
float sea_land_steeper() {
    float steeper = pow(max(1.0 / (frame.normal_texels_per_m * sea_land_smooth_m), 1.0), 1.0 / 3.0);
    return max(steeper / frame.height_range.z, 1.0);
}

/// Mean square slope of the waves. source: Cox and Munk, clean surface
float sea_roughness() {
    return 0.003 + 0.00512 * sea_wind_m_s;
}

// Waves near the eye: trains a third of an octave apart, each with a share of the spectrum's slopes.
const int sea_trains = 31;
const float sea_longest_m = 256.0, sea_step = 0.7937005;  // 2^(-1/3)
const float sea_train_slope = 9.358e-4;  // mean square, of Pierson and Moskowitz': 0.0081 / 2 ln(2) / 3
const float sea_wander = 0.09;  // of a crest by the waves that are longer [wavelengths]
const float sea_gravity = 9.81;
const float sea_fetch_m = 5000.0;  // of lakes; the sea is fully risen
const float sea_unresolved = 0.3;  // of a wave in a pixel, and none of it is seen
const float sea_period_s = 512.0;  // after which all waves are as they were

/// Of a train, its direction from the wind's, to the right of it, as cosine and sine, and its phase: the longer the nearer
/// to the wind, neighbours apart. Steps of the golden ratio leave no two alike; a table would be stored again for every pixel.
vec3 sea_train(in int i) {
    float aside = 2.0 * fract(0.618034 * float(i) + 0.25) - 1.0;
    float angle = (0.4 + 0.03 * float(i)) * aside * (0.35 + 0.65 * aside * aside);
    return vec3(cos(angle), sin(angle), fract(0.754878 * float(i) + 0.1));
}

/// Waves at a point.
struct sea_Waves {
    vec2 slope;       // of those that pixels resolve, east and north
    float roughness;  // mean square slope of the others
};

/// Length of the waves at the peak of the spectrum [m].
/// @param open  1 on the sea, 0 on a lake
float sea_peak_m(in float open) {
    float wind = max(sea_wind_m_s, 0.1);
    float risen = 0.855 * sea_gravity / wind;
    float young = 22.0 * pow(sea_gravity * sea_gravity / (wind * sea_fetch_m), 1.0 / 3.0);
    float angular = mix(max(risen, young), risen, open);
    return 6.2831853 * sea_gravity / (angular * angular);
}

/// Share of a train that a pixel resolves. @param cycles  of the wave in a pixel
float sea_resolved(in float cycles) {
    return 1.0 - smoothstep(0.08, sea_unresolved, cycles);
}

/// The waves that pixels resolve; the slopes of all others stay rough.
/// @param anchored_m  of Surface
/// @param dx_m, dy_m  to the next pixels on the water, east and north
/// @param share       factor on the resolved slopes
sea_Waves sea_waves(in vec2 anchored_m, in vec2 dx_m, in vec2 dy_m, in float open, in float share) {
    sea_Waves w = sea_Waves(vec2(0.0), sea_roughness());
    float peak_m = sea_peak_m(open), length_m = sea_longest_m;
    // Low over the water pixels are long: of the finest waves only those along them would be left, as a comb.
    float mean_m = sqrt(length(dx_m) * length(dy_m));
    float finest_m = share > 0.0 ? mean_m / sea_unresolved : 1e9;
    vec2 downwind = -vec2(sin(radians(sea_wind_deg)), cos(radians(sea_wind_deg)));
    float now_s = mod(frame.still_seconds, sea_period_s);
    float wander = 0.0;
    for (int i = 0; i < sea_trains; ++i) {
        if (length_m < finest_m) break;
        vec3 train = sea_train(i);
        vec2 way = mat2(train.x, -train.y, train.y, train.x) * downwind;
        vec2 k = way / length_m;
        float over_peak = length_m / peak_m;
        float seen = share * sea_resolved(max(max(abs(dot(k, dx_m)), abs(dot(k, dy_m))), mean_m / length_m));
        float square = seen * seen * sea_train_slope * exp(-1.25 * over_peak * over_peak);
        // Whole periods, so that the sea repeats and a long time costs no accuracy.
        float hertz = round(sqrt(sea_gravity / (6.2831853 * length_m)) * sea_period_s) / sea_period_s;
        float cycles = ground_repeats(anchored_m, mat2(k.x, 0.0, k.y, 0.0)).x - hertz * now_s + train.z;
        // Longer waves move the crests of shorter ones: trains of straight crests would weave a cloth.
        float crest = cos(6.2831853 * fract(cycles + sea_wander * wander));
        wander = 0.95 * wander + crest;
        w.slope += way * (sqrt(2.0 * square) * crest);
        w.roughness -= square;
        length_m *= sea_step;
    }
    return w;
}

/// Share of the light that rough water mirrors, on average over its waves.
/// source: Bruneton et al., section 4.3; C. Schlick, Computer Graphics Forum 13 (1994), 233
/// @param cosine     between the view and the vertical
/// @param roughness  mean square slope of the waves
float sea_mirrored(in float cosine, in float roughness) {
    float slope = sqrt(0.5 * roughness);  // along the view, which is half of all
    float grazing = 1.0 - clamp(cosine, 0.0, 1.0);
    return 0.02 + 0.98 * pow(grazing, 5.0 * exp(-2.69 * slope)) / (1.0 + 22.7 * slope * sqrt(slope));
}

/// Albedo of water over a floor: light goes down to it and up again.
vec3 sea_albedo(in vec3 floor_albedo, in float depth_m) {
    vec3 passed = exp(-2.0 * (sea_absorption + sea_yellow * sea_yellow_by_colour) * depth_m);
    return sea_scattered + floor_albedo * passed;
}

/// Highlight of the waves that mirror the sun, as Phong's exponent and its peak over the irradiance.
/// source: Cox and Munk's Gaussian of slopes; a lobe of normals cos^n has n = 2 / variance, one of mirrored
/// rays a quarter of that
vec2 sea_glitter(in float cosine, in float roughness) {
    return vec2(0.5 / roughness, sea_mirrored(cosine, roughness) / (4.0 * roughness * max(cosine, 0.15)));
}

/// What stands on a point of the ground.
struct sea_Water {
    float share;    // of it that is water
    float depth_m;  // to the DEM's floor; 0 where that is not known
    float seen_m;   // how deep it is for light, which a floor nobody knows does not return
    float open;     // 1 for a sea, 0 for a lake
    float known;    // 1 where the DEM has the floor
};

/// How far shores run beside the lines between posts, as water_ashore() takes it: headlands by less than half of the way
/// between posts, so that there are no islands without a post, bays by 0.28; none where a post has fewer than two pixels.
float sea_shore_moved(in vec2 post, in float pixel_posts) {
    const float outwards = 0.1;  // the sea's surface is level there, the land's is not
    float per_post = 1.3, height = sea_shore * 0.4, sum = outwards * sea_shore;
    vec2 at = post;
    for (int i = 0; i < 4; ++i) {
        float seen = 1.0 - smoothstep(0.2, 0.6, pixel_posts * per_post);
        if (seen == 0.0) break;
        at = mat2(0.8, 0.6, -0.6, 0.8) * at;
        sum += seen * height * (noise_smooth(at * per_post, uint(i)) - 0.5);
        per_post *= 2.1;
        height *= 0.5;
    }
    return sum * (1.0 - smoothstep(0.2, 0.5, pixel_posts));
}

sea_Water sea_water(in Surface s, in float height_m) {
    float depth_m = max(sea_level_m - height_m, 0.0);
    if (sea_level_m != 0.0) return sea_Water(sea_share(height_m), depth_m, depth_m + sea_least_depth_m, 1.0, 1.0);
    const float unseen_m = 1000.0;
#if HAS_outside || defined(ORTHOGRAPHIC)
    vec4 water = water_of(s);
#else
    // Down a cliff bays and headlands would be icicles.
    float level = smoothstep(0.75, 0.93, dot(s.geometric_normal, s.up));
    vec4 water = water_ashore_of(s, level * sea_shore_moved(s.post, s.pixel_posts));
#endif
    float known = water.y * water.z;
    return sea_Water(water.x, depth_m * known,
                    mix(unseen_m, depth_m + sea_tide_m + sea_shelf / frame.normal_texels_per_m, known), water.y, known);
}

/// Slicks and clouded water of kilometres: how bright it is there, over its mean.
float sea_gusts(in Surface s) {
    const mat2 per_m = mat2(0.5 / 9000.0, 0.866 / 31000.0, -0.866 / 9000.0, 0.5 / 31000.0);
    vec4 patches = textureGrad(sea_patches, ground_repeats(s.anchored_m, per_m), per_m * s.ground_dx_m.xy, per_m * s.ground_dy_m.xy);
    return 1.0 + sea_shore * (patches.r + 0.7 * patches.a - 0.85);
}

/// At a visible point. @param near  factor on the waves that pixels resolve
sea_Waves sea_waves_of(in Surface s, in sea_Water water, in float near) {
#ifdef ORTHOGRAPHIC
    vec2 dx_m = s.ground_dx_m.xy, dy_m = s.ground_dy_m.xy;
#else
    const float least = 1e-3;
    vec2 dx_m = water_step_m(s, frame.pixel_ray_dx.xyz, least).xy, dy_m = water_step_m(s, frame.pixel_ray_dy.xyz, least).xy;
#endif
    // Where the vertical of the DEM's centre is not that of the place, its plane is no map of the water.
    float share = water.share > 0.0 ? near * smoothstep(0.5, 0.8, s.up.z) : 0.0;
    return sea_waves(s.anchored_m, dx_m, dy_m, water.open, share);
}

/// From a floor up to the level.
vec3 sea_lift_m(in VertexFrame v) {
    return max(sea_level_m - v.height_m, 0.0) * frame.height_range.z * v.up;
}

void sea_on_displace(in VertexFrame v, inout vec3 position_m) {
    bool floods = sea_level_m != 0.0;
    float depth_m = sea_level_m - v.height_m;
    // A lake's heights are its surface already, whatever its level.
    vec4 water = floods || depth_m <= 0.0 ? vec4(1.0) : water_at(v.post, 1.0);
    float lifted = water.x > 0.0 && water.y > 0.5 ? 1.0 : 0.0;
    position_m += lifted * sea_lift_m(v);
}

/// Of the material, for the light: share of water, and its waves.
float sea_here = 0.0;
vec3 sea_normal = vec3(0.0, 0.0, 1.0);
float sea_rough = 1.0;
float sea_floor_here = 0.0;  // share of a seen floor

/// @param overview  sea_seen()  @param share  of water
void sea_shade_land(inout Surface s, in float overview, in float share) {
    if (overview > 0.0 && share < 1.0)
        s.normal = sea_steep(s.normal, s.up, mix(1.0, sea_land_steeper(), overview));
}

void sea_on_material(inout Surface s) {
#if HAS_water
    float height_m = sea_height_m(s);
    sea_Water water = sea_water(s, height_m);
    float overview = sea_seen(), seen = overview * water.known;
    vec3 to_sun;
    sun_light(s.up, to_sun);
    vec3 albedo = sea_albedo(sea_level_m != 0.0 ? s.diffuse : sea_sand, water.seen_m);
    float pixel_m = s.pixel_posts / frame.normal_texels_per_m;
    vec3 map = albedo - sea_scattered + sea_map_albedo(water.seen_m);
    map *= sea_shade(s.geometric_normal, s.up, to_sun, sea_steeper(pixel_m));
    float rim = seen > 0.0 ? sea_at_rim(s.post) : 0.0;
    albedo = mix(albedo * sea_gusts(s), mix(map, surround_sea_albedo, rim), seen);

    sea_Waves waves = sea_waves_of(s, water, 1.0 - seen);
    sea_here = water.share * (1.0 - seen * rim);  // the sea beyond mirrors nothing
    sea_floor_here = water.share * seen;
    sea_rough = waves.roughness;
    sea_normal = normalize(s.up - vec3(waves.slope, 0.0));
    vec2 glitter = sea_glitter(-dot(s.position_m, s.up) / s.distance_m, waves.roughness);
    // The surface of this pixel is that of the water, not the drawn floor's.
    surface_of_water(s, height_m, water.share, water.known);
    if (water.share > 0.0) s.geometric_normal = normalize(mix(s.geometric_normal, s.up, water.share));
    sea_shade_land(s, overview, water.share);
    if (water.share > 0.0) s.normal = normalize(mix(s.normal, sea_normal, water.share));
    // Light from below comes out of the water whichever way a wave leans.
    float facing = (max(dot(s.up, to_sun), 0.0) + 0.02) / (max(dot(sea_normal, to_sun), 0.0) + 0.02);
    s.diffuse = mix(s.diffuse, albedo * min(facing, 4.0), water.share);
    s.ambient = mix(s.ambient, albedo, water.share);
    s.shininess = mix(s.shininess, glitter.x, water.share);
    // Low over the water the glitter is many times as bright as snow, which no picture can show.
    s.specular = mix(s.specular, vec3(min(glitter.y, 0.4)) * (1.0 - seen), water.share);
#else
    sea_shade_land(s, sea_seen(), 0.0);
#endif
}

/// Mountains of a floor that is seen as on a map cast next to no shadows on it: they would be blots of ink, of a sun that
/// does not reach there.
void sea_on_visibility(in Surface s, in vec3 to_sun, inout float factor) {
    const float shadowless = 0.8;
    factor = mix(factor, 1.0, shadowless * sea_floor_here);
}

void sea_on_lit(in Surface s, inout vec3 radiance) {
#if HAS_water
    vec3 view = s.position_m / s.distance_m;
    float cosine = max(-dot(view, sea_normal), 0.0);
    // What is mirrored in waves lies higher than in a level mirror, and never below the horizon.
    vec3 mirrored = view + 2.0 * cosine * sea_normal + sqrt(sea_rough) * s.up;
    mirrored -= min(dot(mirrored, s.up), 0.0) * s.up;
    radiance = mix(radiance, background_radiance(normalize(mirrored), false), sea_here * sea_mirrored(cosine, sea_rough));
#endif
}

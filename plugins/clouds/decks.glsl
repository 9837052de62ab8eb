//! provides  where decks are: heights on the round Earth, columns of cloud by place
//! reads     place [m], frame.seconds

//@ include lib/ground.glsl

uniform float clouds_cover_1 = 0.45; //@ range(0, 1) label("Cover, deck 1") description("Share of the sky that the lowest deck covers as seen from straight above")
uniform float clouds_base_1_m = 2600.0; //@ range(-500, 20000) unit(m) label("Base 1") description("Height of its lower side above sea level")
uniform float clouds_top_1_m = 3700.0; //@ range(-500, 22000) unit(m) label("Top 1") description("Height of its highest tops")
uniform float clouds_depth_1 = 30.0; //@ range(0, 1000) label("Optical depth 1") description("Of its thickest parts from above: 0.5 cirrus, 10 stratus, 30 cumulus, 100 thunderstorm")
uniform int clouds_kind_1 = 0; //@ enum(cumulus, stratus, cirrus) label("Kind 1")
uniform float clouds_cover_2 = 0.0; //@ range(0, 1) label("Cover, deck 2")
uniform float clouds_base_2_m = 5000.0; //@ range(-500, 20000) unit(m) label("Base 2")
uniform float clouds_top_2_m = 5500.0; //@ range(-500, 22000) unit(m) label("Top 2")
uniform float clouds_depth_2 = 8.0; //@ range(0, 1000) label("Optical depth 2")
uniform int clouds_kind_2 = 1; //@ enum(cumulus, stratus, cirrus) label("Kind 2")
uniform float clouds_cover_3 = 0.0; //@ range(0, 1) label("Cover, deck 3")
uniform float clouds_base_3_m = 9000.0; //@ range(-500, 20000) unit(m) label("Base 3")
uniform float clouds_top_3_m = 9800.0; //@ range(-500, 22000) unit(m) label("Top 3")
uniform float clouds_depth_3 = 0.8; //@ range(0, 1000) label("Optical depth 3")
uniform int clouds_kind_3 = 2; //@ enum(cumulus, stratus, cirrus) label("Kind 3")
uniform int clouds_seed = 1; //@ range(0, 65535) label("Seed") description("Other clouds of the same kind")
uniform float clouds_cell_m = 1600.0; //@ range(50, 50000) unit(m) label("Cell") description("Width of a large heap of cumulus; sheets and streaks are wider in proportion")
uniform float clouds_variation = 0.35; //@ range(0, 1) label("Variation") description("How much optical depth and tops vary within a deck")
uniform float clouds_wind_m_s = 8.0; //@ range(0, 100) unit(m/s) label("Wind") description("Moves the clouds with --seconds")
uniform float clouds_wind_from_deg = 270.0; //@ angle range(0, 360) unit(deg) label("Wind from")

uniform sampler2D clouds_columns;

const float clouds_earth_m = 6371000.0;
const float clouds_reach_m = 400000.0;  // half of the map of columns

struct clouds_Deck {
    float cover;   // over the DEM, where it varies
    float base_m;  // as drawn, exaggerated
    float top_m;
    float depth;   // of the thickest columns
    float varies;  // how much the depth does beyond that, 0..1
    int kind;
};

/// Largest optical depth of a deck's raster; -1 without one.
float clouds_depth_most(in int deck) {
    return vec3(clouds_depths_1_most(), clouds_depths_2_most(), clouds_depths_3_most())[deck];
}

/// @param deck  0 to 2
clouds_Deck clouds_deck(in int deck) {
    clouds_Deck d = clouds_Deck(clouds_cover_1, clouds_base_1_m, clouds_top_1_m, clouds_depth_1, clouds_variation, clouds_kind_1);
    if (deck == 1) d = clouds_Deck(clouds_cover_2, clouds_base_2_m, clouds_top_2_m, clouds_depth_2, clouds_variation, clouds_kind_2);
    if (deck == 2) d = clouds_Deck(clouds_cover_3, clouds_base_3_m, clouds_top_3_m, clouds_depth_3, clouds_variation, clouds_kind_3);
    float cover_most = vec3(clouds_covers_1_most(), clouds_covers_2_most(), clouds_covers_3_most())[deck];
    float depth_most = clouds_depth_most(deck);
    if (cover_most >= 0.0) {
        float mean = vec3(clouds_covers_1_mean(), clouds_covers_2_mean(), clouds_covers_3_mean())[deck];
        d.cover = cover_most > 0.0 ? max(mean, 1e-3) : 0.0;  // clouds may be beyond the DEM
    }
    if (depth_most >= 0.0) {
        d.cover = depth_most > 0.0 ? 0.5 : 0.0;
        d.depth = depth_most;
        d.varies = 0.0;
    }
    d.base_m *= frame.height_range.z;
    d.top_m = max(d.top_m * frame.height_range.z, d.base_m + 1.0);
    return d;
}

/// The place on the ground below a point: east and north of the DEM's centre [m].
/// @param position_m  relative to the eye
/// @param height_m    as drawn
vec2 clouds_place(in vec3 position_m, in float height_m) {
    return position_m.xy + frame.eye_m.xy - height_m * up_at(position_m).xy;
}

/// How far along a ray a height is reached, on a round Earth, from below [m].
/// @param rise_m  from where the ray begins, above 0
/// @param sine    of the ray's elevation there
float clouds_way_up(in float rise_m, in float sine) {
    float bend = (1.0 - sine * sine) / clouds_earth_m;
    return 2.0 * rise_m / max(sine + sqrt(max(sine * sine + 2.0 * bend * rise_m, 0.0)), 1e-6);
}

// The map of columns: its texels are the finer the nearer to the eye, 32 m below it.
float clouds_near_m() {
    return max(3000.0, 0.5 * frame.eye_m.w);
}

vec2 clouds_centre() {
    return frame.eye_m.xy - frame.eye_m.w * frame.eye_up.xy;
}

vec2 clouds_map_at(in vec2 place) {
    vec2 away = (place - clouds_centre()) / clouds_near_m();
    return 0.5 + 0.5 * sign(away) * log2(1.0 + abs(away)) / log2(1.0 + clouds_reach_m / clouds_near_m());
}

vec2 clouds_of_map(in vec2 at) {
    vec2 out_of_middle = 2.0 * at - 1.0;
    vec2 away = exp2(abs(out_of_middle) * log2(1.0 + clouds_reach_m / clouds_near_m())) - 1.0;
    return clouds_centre() + clouds_near_m() * sign(out_of_middle) * away;
}

/// A place where the wind has not yet moved the clouds.
vec2 clouds_before_wind(in vec2 place) {
    vec2 to = -vec2(sin(clouds_wind_from_deg), cos(clouds_wind_from_deg));
    return place - to * clouds_wind_m_s * frame.seconds;
}

/// The same in cells.
vec2 clouds_cells(in vec2 place) {
    return clouds_before_wind(place) / clouds_cell_m;
}

/// Cover of a deck at a place; beyond what a raster or a forecast has its mean over the DEM.
float clouds_cover_at(in clouds_Deck d, in int deck, in vec2 place) {
    if (vec3(clouds_covers_1_most(), clouds_covers_2_most(), clouds_covers_3_most())[deck] < 0.0) return d.cover;
    vec2 found = deck == 0 ? clouds_covers_1(place) : deck == 1 ? clouds_covers_2(place) : clouds_covers_3(place);
    return mix(d.cover, clamp(found.x, 0.0, 1.0), found.y);
}

/// The share whose column has an optical depth from a raster: the inverse of clouds_tau().
float clouds_share_of_depth(in clouds_Deck d, in int deck, in vec2 place) {
    vec2 at = clouds_before_wind(place);
    vec2 found = deck == 0 ? clouds_depths_1(at) : deck == 1 ? clouds_depths_2(at) : clouds_depths_3(at);
    float part = clamp(found.x * found.y / d.depth, 0.0, 1.0);
    if (part <= 0.0) return -1.0;  // so thin that no lumps of its edges are there either
    return d.kind == 2 ? part : 1.0 - sqrt(1.0 - (d.kind == 0 ? part * part : part));
}

/// Thickness of a deck's cloud at a place: clouds_share().
float clouds_thickness(in int deck, in vec2 place) {
    clouds_Deck d = clouds_deck(deck);
    if (d.cover <= 0.0) return -4.0;
    if (clouds_depth_most(deck) > 0.0) return clouds_share_of_depth(d, deck, place);
    vec2 cells = clouds_cells(place);
    if (d.kind == 2) {  // streaks lie along the wind
        float s = sin(clouds_wind_from_deg), c = cos(clouds_wind_from_deg);
        cells = mat2(s, c, c, -s) * cells;
    }
    uint stream = uint(clouds_seed) * 4099u + uint(deck) * 1013u;
    return clouds_share(d.kind, clouds_field(d.kind, cells, stream), clouds_cover_at(d, deck, place));
}

/// Decks up to the last one that covers anything; those beyond cost nothing. Loops end after a deck and
/// not before the next one: software devices compute what follows a break.
int clouds_count() {
    return clouds_deck(2).cover > 0.0 ? 3 : clouds_deck(1).cover > 0.0 ? 2 : 1;
}

/// Thickness of the three decks: clouds_share(); and how their tops and depths vary, 0..1.
vec4 clouds_pass_columns(in Texel t) {
    vec2 place = clouds_of_map(t.at);
    vec2 cells = clouds_cells(place);
    uint stream = uint(clouds_seed) * 4099u + 700u;
    float vary = 0.6 * clouds_octaves(0.55 * cells, 2, stream) + 0.4 * clouds_domes(0.8 * cells, stream + 9u);
    vec3 shares = vec3(-4.0);
    int count = clouds_count();
    for (int i = 0; i < 3; ++i) {
        shares[i] = clouds_thickness(i, place);
        if (i + 1 >= count) break;
    }
    return vec4(shares, clamp(2.2 * vary - 0.7, 0.0, 1.0));
}

/// The same at any place, from 0 to 1. Clamped after the texture's filter, so that edges are smooth.
vec4 clouds_at(in vec2 place) {
    return clamp(textureLod(clouds_columns, clouds_map_at(place), 0.0), 0.0, 1.0);
}

/// Whether a deck's clouds are thunderclouds, with anvils: cumulus of 5 km and more.
bool clouds_anvil(in clouds_Deck d) {
    return d.kind == 0 && d.top_m - d.base_m >= 5000.0 * frame.height_range.z;
}

/// Height of a cloud over its deck's, 0..1. @param share  clouds_share()
float clouds_height(in clouds_Deck d, in float share) {
    if (d.kind == 2) return share > 0.0 ? 1.0 : 0.0;
    if (d.kind == 0) return sqrt(share * (2.0 - share));
    return 1.0 - (1.0 - share) * (1.0 - share);
}

/// Vertical optical depth of a column. @param vary  0..1
float clouds_tau(in clouds_Deck d, in float share, in float vary) {
    float of_deck = d.kind == 2 ? share : clouds_height(d, share);
    return d.depth * of_deck * (1.0 + d.varies * (2.0 * vary - 1.0));
}

/// Height above the deck's base that the tallest clouds of a place have [m].
float clouds_tall_m(in clouds_Deck d, in float vary) {
    float uneven = d.kind == 1 ? 1.6 : clouds_anvil(d) ? 0.3 : 0.8;
    return (d.top_m - d.base_m) * (1.0 - uneven * clouds_variation * vary);
}

/// Top of a column [m].
float clouds_column_top_m(in clouds_Deck d, in float share, in float vary) {
    float height = clouds_height(d, share);
    if (clouds_anvil(d)) height = 0.92 + 0.08 * share;
    if (d.kind == 1) height = 0.5 + 0.5 * height;  // sheets thin out sideways
    if (share <= 0.0) height = 0.0;
    return d.base_m + max(clouds_tall_m(d, vary) * height, 1e-3 * (d.top_m - d.base_m));
}

const float clouds_waist = 0.45;  // share from which a thundercloud reaches from its base to its anvil

/// Share from which a cloud reaches a height: the inverse of clouds_height(); with an anvil, a narrow tower below a
/// wide top. @param within  0 at the base, 1 at the tallest tops
float clouds_needed(in clouds_Deck d, in float within) {
    if (d.kind == 2) return 0.0;
    if (d.kind == 1) return 1.0 - sqrt(min(2.0 - 2.0 * within, 1.0));
    if (!clouds_anvil(d)) return 1.0 - sqrt(max(1.0 - within * within, 0.0));
    float tower = clouds_waist * smoothstep(0.03, 0.25, within) * (1.0 - smoothstep(0.6, 0.86, within));
    return tower + max(12.5 * within - 11.5, 0.0);
}

/// Share of the height of a column that is cloud. @param share  clouds_share()
float clouds_filled(in clouds_Deck d, in float share) {
    return clouds_anvil(d) ? mix(0.15 + 0.95 * share, 1.0, smoothstep(0.42, 0.46, share)) : 1.0;
}

//! provides  how dense decks are at a point: columns whose edges a volume of lumps moves in and out
//! reads     the map of columns, a volume of noise

uniform float clouds_lumpy = 0.5; //@ range(0, 1) label("Lumps") description("How far lumps move the surface of a cloud in and out")

uniform sampler3D clouds_detail;

const float clouds_detail_texels = 64.0;
const float clouds_widest_lump = 0.35;  // most that lumps change a share by, where clouds_lumpy is 1

/// Lumps of three sizes, about -1..1 and 0 in the mean. The last texels repeat the first, so that filters see no seam.
vec4 clouds_pass_detail(in Voxel v) {
    vec3 at = fract((v.at * clouds_detail_texels - 0.5) / (clouds_detail_texels - 1.0));
    float lumps = 0.6 * clouds_lumps(at, 4, 60u) + 0.27 * clouds_lumps(at, 8, 400u) + 0.13 * clouds_lumps(at, 16, 800u);
    return vec4(3.0 * (lumps - 0.62));
}

/// The same at a point, on the wind. @param place  clouds_place() [m]
float clouds_lumps_at(in vec2 place, in float height_m, in int kind) {
    vec3 cells = vec3(clouds_cells(place), height_m / clouds_cell_m);
    cells *= kind == 0 ? vec3(1.5) : kind == 1 ? vec3(0.5, 0.5, 1.5) : vec3(0.2, 0.8, 1.5);
    vec3 at = (fract(cells) * (clouds_detail_texels - 1.0) + 0.5) / clouds_detail_texels;
    return textureLod(clouds_detail, at, 0.0).r;
}

/// How far billows lower the top of a sheet, of its height. @param lump  clouds_lumps_at()
float clouds_billow(in float lump) {
    return 0.4 * clouds_lumpy * clamp(0.5 - 0.5 * lump, 0.0, 1.0);
}

/// A point of a deck.
struct clouds_Point {
    float extinction;  // [1/m]
    float above;       // optical depths straight up and down
    float below;
    float gap_m;       // outside: no cloud is nearer, as far as can be known
};

/// @param soft_m  over which edges go from nothing to all; what is smaller has no lumps
clouds_Point clouds_point(in clouds_Deck d, in int deck, in vec3 position_m, in float height_m, in float soft_m) {
    clouds_Point p = clouds_Point(0.0, 0.0, 0.0, 0.0);
    vec2 place = clouds_place(position_m, height_m);
    vec4 columns = textureLod(clouds_columns, clouds_map_at(place), 0.0);
    float vary = clamp(columns.a, 0.0, 1.0), tallest_m = clouds_tall_m(d, vary);
    float within = (height_m - d.base_m) / tallest_m;
    float widest = clouds_lumpy * clouds_widest_lump * (clouds_anvil(d) ? 2.0 : 1.0) * clamp(4.0 * within + 0.3, 0.3, 1.0);
    float needed = clouds_needed(d, clamp(within, 0.0, 1.0));
    float share = columns[deck] - needed;  // beyond what is needed at this height
    p.gap_m = max(max(-share - widest, 0.0) * 0.15 * clouds_cell_m, height_m - d.base_m - tallest_m);
    if (p.gap_m > 0.0 || height_m < d.base_m - soft_m) return p;
    float lump = soft_m < 0.2 * clouds_cell_m ? clouds_lumps_at(place, height_m, d.kind) : 0.0;
    share += (d.kind == 1 ? 0.3 : 1.0) * widest * lump;
    if (share <= 0.0) return p;
    float column = min(share + needed, 1.0);
    float top_m = clouds_column_top_m(d, column, vary), tall_m = top_m - d.base_m;
    if (d.kind == 1) top_m -= clouds_billow(lump) * tall_m;
    within = clamp((height_m - d.base_m) / tall_m, 0.0, 1.0);
    float tau = clouds_tau(d, column, vary);
    float inside_m = min(top_m - height_m, 0.3 * clouds_cell_m * share);
    float edge = smoothstep(0.0, 1.0, inside_m / soft_m) * clamp((height_m - d.base_m) / soft_m + 0.5, 0.0, 1.0);
    p.extinction = edge * tau / (tall_m * clouds_filled(d, column));
    p.above = tau * (1.0 - within);
    p.below = tau * within;
    return p;
}

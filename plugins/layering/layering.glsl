//! provides  materials: sand, grass, rock, snow by elevation and slope, two at most at a point
//! hook      albedo
//! reads     height [m and 0..1], slope, latitude, ground coordinates [m]
//! writes    material, material_weight, texture_at, gloss, diffuse, ambient, specular, emissive, shininess
//! source    Costa and Celes, Tecnicas simples para visualizacao foto-realista de terrenos em tempo real
//!           usando placas graficas programaveis (Tecgraf, PUC-Rio), section 3.1 and table 1

//@ include lib/repeats.glsl

uniform sampler2DArray layering_albedo;
uniform sampler3D layering_noise;
uniform sampler2D layering_patches;
uniform sampler2D layering_regions;  // the same less 0.5, in floats

uniform int layering_limits = 2; //@ enum(normalised, metres, climate) static label("Limits") description("Limits of the materials: fractions of the DEM's range as in the paper, heights in metres, or tree and snow line of the latitude")

uniform vec2 layering_sand_grass = vec2(0.20, 0.25); //@ range(0, 1) label("Sand to grass, normalised")
uniform vec2 layering_grass_rock = vec2(0.40, 0.45); //@ range(0, 1) label("Grass to rock, normalised")
uniform vec2 layering_rock_snow = vec2(0.80, 0.85); //@ range(0, 1) label("Rock to snow, normalised")
uniform float layering_noise_amount = 0.03; //@ range(0, 0.5) label("Noise on limits, normalised")

uniform vec2 layering_sand_grass_m = vec2(1.0, 6.0); //@ range(-12000, 9000) unit(m) label("Sand to grass")
uniform vec2 layering_grass_rock_m = vec2(1700.0, 2300.0); //@ range(-12000, 9000) unit(m) label("Grass to rock")
uniform vec2 layering_rock_snow_m = vec2(2700.0, 3000.0); //@ range(-12000, 9000) unit(m) label("Rock to snow")
uniform vec3 layering_noise_amount_m = vec3(2.0, 180.0, 180.0); //@ range(0, 2000) unit(m) label("Noise on limits") description("Noise on the limits from sand to grass, to rock, to snow")
uniform float layering_snow_shift_m = 0.0; //@ range(-9000, 9000) unit(m) label("Snow line shift") description("Added to the climate's snow line; negative in a cold season")

uniform bool layering_slope = true; //@ static label("Rock on steep ground")
uniform vec2 layering_slope_deg = vec2(33.0, 47.0); //@ range(0, 90) unit(deg) label("Steep from, to")

uniform bool layering_metres = true; //@ static label("Scales in metres") description("Off: numbers of repeats over the DEM, as in the paper")
uniform float layering_texture_m = 12.0; //@ range(0.1, 100000) unit(m) label("Texture size")
uniform float layering_noise_m = 2400.0; //@ range(1, 1000000) unit(m) label("Noise size")
uniform float layering_texture_repeats = 64.0; //@ range(1, 100000) label("Texture repeats")
uniform float layering_noise_repeats = 8.0; //@ range(1, 1000) label("Noise repeats")
uniform float layering_variation = 0.35; //@ range(0, 1) label("Variation") description("Difference in brightness of broad patches; 0 in the paper")
uniform bool layering_nature = true; //@ static label("Natural ground") description("Textures without visible repetition, dry and lush ground, shrubs, bands of rock; not in the paper")
uniform vec3 layering_patch_m = vec3(230.0, 5300.0, 67000.0); //@ range(1, 10000000) unit(m) label("Patch sizes") description("Sizes of small patches, broad patches and regions of natural ground")

// Coefficients of sand, grass, rock, snow.
uniform vec4 layering_diffuse = vec4(1.0, 1.0, 1.0, 1.0); //@ range(0, 2) label("Diffuse")
uniform vec4 layering_ambient = vec4(1.0, 1.0, 1.0, 1.0); //@ range(0, 2) label("Ambient")
uniform vec4 layering_specular = vec4(0.02, 0.015, 0.03, 0.10); //@ range(0, 1) label("Specular")
uniform vec4 layering_emissive = vec4(0.0, 0.0, 0.0, 0.0); //@ range(0, 10) label("Emissive")
uniform vec4 layering_shininess = vec4(12.0, 10.0, 16.0, 24.0); //@ range(1, 1000) label("Shininess")

const int layering_last_level = 10;  // of the albedo textures, 1 x 1: their mean

/// Elevations at which materials change: where sand begins to turn into grass, and so on.
struct layering_Limits {
    vec2 sand_grass, grass_rock, rock_snow;
};

/// Tree line: where closed growth ends, by latitude; rock and snow lie above it.
/// source: C. Koerner, A re-assessment of high elevation treeline positions and their explanation,
/// Oecologia 115 (1998), 445: level in the tropics, then 130 m a degree from 32 to 50 degrees and 75 m a
/// degree beyond; the snow line of temperate mountains lies some 900 m above it.
float layering_tree_line_m(in float latitude_deg) {
    float north = abs(latitude_deg);
    return 3800.0 - 130.0 * clamp(north - 32.0, 0.0, 18.0) - 75.0 * max(north - 50.0, 0.0);
}

layering_Limits layering_limits_at(in float latitude_deg) {
    layering_Limits at;
    if (layering_limits == 0) {
        at = layering_Limits(layering_sand_grass, layering_grass_rock, layering_rock_snow);
    } else if (layering_limits == 1) {
        at = layering_Limits(layering_sand_grass_m, layering_grass_rock_m, layering_rock_snow_m);
    } else {
        float trees = layering_tree_line_m(latitude_deg);
        float snow = trees + 900.0 + layering_snow_shift_m;
        at = layering_Limits(layering_sand_grass_m, trees + vec2(-150.0, 450.0),
                             snow + vec2(-100.0, 250.0));
    }
    // Between edges of which the second is not above the first, smoothstep is undefined.
    float least = layering_limits == 0 ? 1e-4 : 0.01;
    at.sand_grass.y = max(at.sand_grass.y, at.sand_grass.x + least);
    at.grass_rock.y = max(at.grass_rock.y, at.grass_rock.x + least);
    at.rock_snow.y = max(at.rock_snow.y, at.rock_snow.x + least);
    return at;
}

/// Weights of sand, grass, rock and snow, at most two above zero, sum 1.
/// @param elevation  in the limits' unit
/// @param noise      added to the three limits, in their unit
/// @param steep      0..1: how much of the point shows rock whatever the elevation
vec4 layering_weights(in layering_Limits limits, in float elevation, in vec3 noise, in float steep) {
    float grass = smoothstep(limits.sand_grass.x + noise.x, limits.sand_grass.y + noise.x, elevation);
    float rock = smoothstep(limits.grass_rock.x + noise.y, limits.grass_rock.y + noise.y, elevation);
    float snow = smoothstep(limits.rock_snow.x + noise.z, limits.rock_snow.y + noise.z, elevation);
    vec4 weights = vec4(1.0 - grass, grass * (1.0 - rock), grass * rock * (1.0 - snow),
                        grass * rock * snow);
    weights = mix(weights, vec4(0.0, 0.0, 1.0, 0.0), steep);
    // Where there is a third material its weight is taken from all of them, so that none comes or goes
    // suddenly: the third largest of four, by a sorting network.
    vec2 larger = max(weights.xz, weights.yw), smaller = min(weights.xz, weights.yw);
    float third = min(min(larger.x, larger.y), max(smaller.x, smaller.y));
    weights = max(weights - third, 0.0);
    return weights / dot(weights, vec4(1.0));
}

/// The angle of a cosine of 0 to 1 [deg], to 0.003 degrees.
/// source: the form is Abramowitz and Stegun's, Handbook of Mathematical Functions, 1964, 4.4.45
float layering_angle_deg(in float cosine) {
    float c = clamp(cosine, 0.0, 1.0);
    return sqrt(1.0 - c) * (89.997823 + c * (-12.196846 + c * (4.405885 - 1.197018 * c)));
}

/// How much of a slope shows rock: 0 on flat ground, 1 on cliffs.
/// @param cosine  of the angle between the ground's normal and the vertical
float layering_steepness(in float cosine, in float noise) {
    if (!layering_slope) return 0.0;
    return smoothstep(layering_slope_deg.x, max(layering_slope_deg.y, layering_slope_deg.x + 0.01),
                      layering_angle_deg(cosine) + 12.0 * noise);
}

vec4 layering_read(in vec2 at, in vec2 dx, in vec2 dy, in int material) {
    return textureGrad(layering_albedo, vec3(at, float(material)), dx, dy);
}

/// Turns by 37 degrees: patterns read both ways do not line up.
const mat2 layering_turn = mat2(0.7986, 0.6018, -0.6018, 0.7986);

/// Takes the visible repeats from a material: the same texture, turned and several times as large.
/// @returns factor on its albedo
/// @param per_m   repeats a metre of the texture itself
/// @param dx, dy  change of its coordinates from pixel to pixel
vec3 layering_unrepeated(in Surface s, in vec2 per_m, in vec2 dx, in vec2 dy, in int material) {
    const float larger = 0.23;
    mat2 wide_per_m = larger * mat2(per_m.x * layering_turn[0], per_m.y * layering_turn[1]);
    vec3 mean = texelFetch(layering_albedo, ivec3(0, 0, material), layering_last_level).rgb;
    vec3 wide = layering_read(ground_repeats(s.anchored_m, wide_per_m), layering_turn * dx * larger,
                              layering_turn * dy * larger, material).rgb;
    return 0.35 + 0.65 * wide / mean;
}

/// What places do to a material's colour: factors on its albedo.
/// @param small, broad  of patches.ktx2 at two sizes: tone, hue, shrubs, fine tone
/// @param flatness      cosine of the slope
vec3 layering_tint(in int material, in vec4 small, in vec4 broad, in float flatness) {
    float tone = small.r + broad.r - 1.0, fine = small.a - 0.5;
    float hue = 0.6 * small.g + broad.g - 0.8;
    if (material == 0) return vec3(1.0 + 0.45 * tone + 0.15 * fine) + hue * vec3(0.10, 0.0, -0.12);
    if (material == 2)
        return vec3(1.0 + 0.9 * tone + 0.5 * fine) + hue * vec3(0.16, 0.02, -0.12);
    if (material == 3) return vec3(1.0 + 0.08 * tone) + 0.04 * hue * vec3(1.0, 0.0, -1.0);
    // Grass: straw where it is dry, and shrubs in groups where it is not, fewer on steep ground.
    float dry = smoothstep(-0.12, 0.42, hue + 0.4 * tone);
    vec3 grass = mix(vec3(0.88, 0.97, 0.84), vec3(1.55, 1.28, 1.12), dry) * (1.0 + 0.5 * tone + 0.35 * fine);
    float groups = (1.0 - smoothstep(0.38, 0.62, broad.g)) * smoothstep(0.40, 0.62, broad.a);
    float shrubs = small.b * groups * smoothstep(0.55, 0.8, flatness);
    return mix(grass, vec3(0.42, 0.52, 0.44) * (1.0 + 0.8 * fine), 0.8 * shrubs);
}

void layering_on_albedo(inout Surface s) {
    vec3 texture_scale = vec3(1.0 / layering_texture_m);
    vec3 noise_scale = vec3(1.0 / layering_noise_m);
    if (!layering_metres) {
        texture_scale = vec3(layering_texture_repeats * frame.ground_extent.zw, 0.0);
        noise_scale = vec3(layering_noise_repeats * frame.ground_extent.zw, 0.0);
    }
    vec4 small, broad;
    float noise;
    if (layering_nature) {
        vec3 scale = 1.0 / layering_patch_m;
        vec2 gx = s.ground_dx_m.xy, gy = s.ground_dy_m.xy;
        small = textureGrad(layering_patches, ground_repeats(s.anchored_m, scale.xx), gx * scale.x, gy * scale.x);
        vec4 region = textureGrad(layering_regions, ground_repeats(s.anchored_m, scale.zz).yx, gx.yx * scale.z,
                                  gy.yx * scale.z);
        // Regions push the broad patches about, so that those do not show as tiles from afar.
        broad = textureGrad(layering_patches, ground_repeats(s.anchored_m, layering_turn * scale.y) + 2.4 * region.rg,
                            layering_turn * gx * scale.y, layering_turn * gy * scale.y);
        broad.rg += 0.6 * region.ra;
        // As strong as the volume's, which need not be read then.
        noise = 1.2 * (broad.r - 0.5) + 0.7 * (broad.a - 0.5) + 0.4 * (small.r - 0.5);
    } else {
        vec3 at = vec3(ground_repeats(s.anchored_m, noise_scale.xy), s.ground_m.z * noise_scale.z);
        noise = 2.0 * textureGrad(layering_noise, at, s.ground_dx_m * noise_scale, s.ground_dy_m * noise_scale).r - 1.0;
    }

    // North or south, only how far from the equator counts.
    float latitude_deg = 90.0 - layering_angle_deg(abs(dot(s.up, frame.polar_axis.xyz)));
    layering_Limits limits = layering_limits_at(latitude_deg);
    bool normalised = layering_limits == 0;
    vec4 weights = layering_weights(limits, normalised ? s.height_unit : s.height_m,
                                    noise * (normalised ? vec3(layering_noise_amount) : layering_noise_amount_m),
                                    layering_steepness(dot(s.ground_normal, s.up), noise));

    // The two materials: the heavier first.
    float most = max(max(weights.x, weights.y), max(weights.z, weights.w));
    int first = weights.x == most ? 0 : weights.y == most ? 1 : weights.z == most ? 2 : 3;
    vec4 rest = weights;
    rest[first] = 0.0;
    float next = max(max(rest.x, rest.y), max(rest.z, rest.w));
    int second = rest.x == next ? 0 : rest.y == next ? 1 : rest.z == next ? 2 : 3;
    if (next == 0.0) second = first;
    s.material = ivec2(first, second);
    s.material_weight = vec2(most, next);

    vec2 at = ground_repeats(s.anchored_m, texture_scale.xy);
    vec2 dx = s.ground_dx_m.xy * texture_scale.xy, dy = s.ground_dy_m.xy * texture_scale.xy;
    // The heavier material shows no repeats, which is enough. A loop, because a software renderer works
    // both sides of an "if": most ground has one material, and the second is read only near a limit.
    vec3 factor = layering_nature ? layering_unrepeated(s, texture_scale.xy, dx, dy, first) : vec3(1.0);
    float flatness = dot(s.ground_normal, s.up);
    vec3 albedo = vec3(0.0);
    float gloss = 0.0;
    int count = next > 0.0 ? 2 : 1;
    for (int i = 0; i < count; ++i) {
        vec4 read = s.material_weight[i] * layering_read(at, dx, dy, s.material[i]);
        if (layering_nature) factor *= layering_tint(s.material[i], small, broad, flatness);
        albedo += read.rgb * factor;
        gloss += read.a;
        factor = vec3(1.0);
    }
    albedo *= 1.0 + layering_variation * noise;

    s.texture_at = at;
    s.texture_dx = dx;
    s.texture_dy = dy;
    s.gloss = gloss;
    s.diffuse = albedo * dot(layering_diffuse, weights);
    s.ambient = albedo * dot(layering_ambient, weights);
    s.specular = vec3(dot(layering_specular, weights));
    s.emissive = albedo * dot(layering_emissive, weights);
    s.shininess = dot(layering_shininess, weights);
}

//! provides  fields of clouds by place: cumulus, stratus, cirrus, from integers alone
//! source    cellular noise: S. Worley, A Cellular Texture Basis Function, SIGGRAPH 1996; fBm: K. Perlin,
//!           An Image Synthesizer, SIGGRAPH 1985

//@ include lib/noise.glsl

const mat2 clouds_turn = mat2(0.8, 0.6, -0.6, 0.8);  // from octave to octave, so that no grid shows

/// Octaves of value noise, each of half the height and the length of the one before; about 0..1.
float clouds_octaves(in vec2 at, in int count, in uint stream) {
    float sum = 0.0, height = 0.5, all = 0.0;
    int i = 0;
    do {
        sum += height * noise_smooth(at, stream + uint(i));
        all += height;
        height *= 0.5;
        at = clouds_turn * at * 2.03;
    } while (++i < count);
    return sum / all;
}

/// Domes around random points, one in each cell: 1 at a point, 0 half way to the next ones.
float clouds_domes(in vec2 at, in uint stream) {
    vec2 whole = floor(at), part = at - whole;
    float nearest2 = 1.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 cell = ivec2(whole) + ivec2(x, y);
            float random = 4096.0 * noise_random(cell, stream);  // its upper bits east, its lower ones north
            vec2 away = vec2(x, y) + 0.15 + 0.7 * vec2(floor(random) / 4096.0, fract(random)) - part;
            nearest2 = min(nearest2, dot(away, away));
        }
    }
    return 1.0 - nearest2;
}

/// Cells around random points of a volume that repeats: 1 at a point, 0 half way to the next ones.
/// @param at  0..1 along each side of it, @param count  cells along each side
float clouds_lumps(in vec3 at, in int count, in uint stream) {
    vec3 whole = floor(float(count) * at), part = float(count) * at - whole;
    float nearest2 = 1.0;
    for (int i = 0; i < 27; ++i) {
        ivec3 aside = ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        ivec3 cell = (ivec3(whole) + aside + count) % count;
        uint layer = stream + 3u * uint(cell.z);
        vec3 point = vec3(noise_random(cell.xy, layer), noise_random(cell.xy, layer + 1u), noise_random(cell.xy, layer + 2u));
        vec3 away = vec3(aside) + point - part;
        nearest2 = min(nearest2, dot(away, away));
    }
    return 1.0 - nearest2;
}

/// Heaps in clusters, large domes with smaller ones on them; smooth sheets; or streaks along x, bent by slow winds.
/// Software devices compute all sides of a branch: so kinds differ in numbers, and loops end after what a kind needs.
/// @param kind  0 cumulus, 1 stratus, 2 cirrus, @param at  [cells]
float clouds_field(in int kind, in vec2 at, in uint stream) {
    bool heaps = kind == 0, streaks = kind == 2;
    float bent = noise_smooth((heaps ? 1.7 : 0.07) * at, stream + (heaps ? 20u : 40u)) - 0.5;
    vec2 wide = heaps ? 0.18 * at : streaks ? vec2(0.07 * at.x, 0.45 * at.y + 2.5 * bent) : 0.22 * at;
    float field = clouds_octaves(wide, heaps ? 3 : 5, stream + (heaps ? 0u : streaks ? 41u : 30u));
    float slow = clouds_octaves(0.08 * at, streaks ? 3 : 1, stream + 50u);
    if (streaks) field = 0.6 * field + 0.4 * slow;
    float domes = 0.0;
    uint i = 0u;
    do {
        vec2 moved = at + 0.35 * bent;
        vec2 dome = i == 0u ? moved : i == 1u ? clouds_turn * moved * 2.3 : moved * 5.1;
        domes += vec3(0.62, 0.26, 0.12)[i] * clouds_domes(dome, stream + 5u + i);
    } while (++i < (heaps ? 3u : 1u));
    return heaps ? 0.55 * field + 0.45 * domes : field;
}

// Fields below which so much of all places is: 0, 0.05 ... 1; the ends are where next to nothing is.
const float clouds_quantiles[63] = float[](
    0.3900, 0.4831, 0.5160, 0.5385, 0.5567, 0.5725, 0.5869, 0.6004, 0.6131, 0.6257, 0.6381,
    0.6503, 0.6626, 0.6754, 0.6888, 0.7030, 0.7187, 0.7363, 0.7577, 0.7877, 0.8650,
    0.1600, 0.2789, 0.3221, 0.3535, 0.3791, 0.4020, 0.4231, 0.4432, 0.4624, 0.4814, 0.5000,
    0.5185, 0.5373, 0.5566, 0.5767, 0.5977, 0.6207, 0.6467, 0.6779, 0.7210, 0.8400,
    0.2400, 0.3347, 0.3693, 0.3934, 0.4130, 0.4299, 0.4454, 0.4598, 0.4734, 0.4867, 0.4998,
    0.5130, 0.5263, 0.5402, 0.5545, 0.5700, 0.5870, 0.6065, 0.6305, 0.6651, 0.7600);
const float clouds_ramps[3] = float[](0.16, 0.12, 0.20);  // from a cloud's edge to its thickest

/// How thick a cloud is: from 0 at its edge to 1 and more, below 0 outside. All of it is above 1 at
/// cover 1.
/// @param cover  share of all places that have cloud, 0..1
float clouds_share(in int kind, in float field, in float cover) {
    float place = 20.0 * (1.0 - cover);
    int below = clamp(int(place), 0, 19);
    float edge = mix(clouds_quantiles[21 * kind + below], clouds_quantiles[21 * kind + below + 1], place - float(below));
    // The last tenth of cover also fills the gaps up.
    edge -= 2.0 * clouds_ramps[kind] * clamp(10.0 * cover - 9.0, 0.0, 1.0);
    return cover > 0.0 ? clamp((field - edge) / clouds_ramps[kind], -4.0, 4.0) : -4.0;
}

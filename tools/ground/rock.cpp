#include <algorithm>
#include <cmath>

#include "material.h"
#include "noise.h"

namespace relevo::ground {
namespace {

constexpr std::uint32_t kRockSeed = 0x50CC;
constexpr double kRockTile_m = 8;

// The beds strike about 20 degrees off the tile's axes; what they shape is drawn out along them.
const Lattice kBlocks(7, 3, -5, 15);   // blocks of 1.1 x 0.5 m
const Lattice kSlabs(17, 7, -13, 34);  // the pieces they break into, 0.45 x 0.2 m
const Lattice kBeds(4, 1, -14, 38);    // foliation, drawn out seven to one
const Lattice kFlakes(24, 10, -10, 24),
    kChips(51, -35, 35, 51);             // scars that pieces left, 30 and 13 cm
const Lattice kCrusts(44), kSpots(120);  // lichens, up to 18 and 7 cm

float unit_of(std::uint32_t id, int k) {
    return hash_unit(kRockSeed + 50, static_cast<int>(id & 0x7FFFFFFFu), k);
}

/// A network of cracks and the faces between them.
struct Fracture {
    float open;        ///< 1 in the middle of a crack that gapes, 0 away from it
    float near_crack;  ///< 1 at a joint, falling off over some centimetres
    float face_m;      ///< height of the face, a plane of its own
    std::uint32_t id;
};

/// @param cell_m   size of a cell: what distances in it are worth
/// @param crack_m  half the width of a crack that gapes
/// @param tilt     of a face, standard deviation
/// @param step_m   between faces, standard deviation
/// @param along    -1..1, varies along the cracks: where they gape and where they close
Fracture fracture(std::uint32_t seed, const Lattice& lattice, float s, float t, float cell_m,
                  float crack_m, float tilt, float step_m, float along) {
    const Cells cell = cells(seed, lattice, s, t, 0.94f);
    Fracture f;
    f.id = cell.id;
    // Some joints stand open, most are closed: the pair of faces decides.
    const float gape = unit_of(cell.id ^ cell.other, 0) - 0.50f + 1.0f * along;
    const float width_m = crack_m * std::clamp(0.3f + 1.2f * gape, 0.3f, 1.5f);
    const float distance_m = cell.edge * cell_m;
    f.open = smoothstep(width_m, 0.2f * width_m, distance_m) * smoothstep(-0.15f, 0.45f, gape);
    f.near_crack = std::exp(-distance_m / (4 * crack_m));
    const auto either = [&](int k) { return 1.7f * (2 * unit_of(cell.id, k) - 1); };
    // Faces lean, but meet their neighbours in a worn bevel; some of the step stays.
    const float inwards = smoothstep(-0.05f, 0.35f, cell.edge);
    f.face_m = step_m * either(1) +
               inwards * tilt * cell_m * (either(2) * cell.offset.x + either(3) * cell.offset.y);
    return f;
}

/// Shallow bowls that meet in sharp ridges, as stone breaks: the lowest of tilted paraboloids.
/// @returns about 0..1
float scars(std::uint32_t seed, const Lattice& lattice, float s, float t) {
    const glm::vec2 q = lattice.at(s, t);
    const int i0 = static_cast<int>(std::floor(q.x)), j0 = static_cast<int>(std::floor(q.y));
    // A bowl two cells away lies above 0.9 here and so never shows.
    float lowest = 9;
    for (int j = j0 - 1; j <= j0 + 1; ++j)
        for (int i = i0 - 1; i <= i0 + 1; ++i) {
            const glm::ivec2 cell = lattice.wrapped(i, j);
            const std::uint32_t id = hash(seed, cell.x, cell.y);
            const auto part = [id](int shift) {
                return static_cast<float>(id >> shift & 0x3Fu) / 63 - 0.5f;
            };
            const glm::vec2 d = q - (glm::vec2(i, j) + 0.5f + 0.6f * glm::vec2(part(0), part(6)));
            const float slope = part(12) * d.x + part(18) * d.y;
            lowest = std::min(lowest, glm::dot(d, d) + 0.5f * slope + 0.25f * part(24));
        }
    return lowest;
}

/// Colonies of lichen with ragged rims.
struct Lichen {
    float cover = 0;  ///< 0..1
    float kind = 0;   ///< 0..1, random to each
};

Lichen lichen(std::uint32_t seed, const Lattice& lattice, float s, float t, float share,
              float ragged) {
    const Cells cell = cells(seed, lattice, s, t, 1.0f);
    if (unit_of(cell.id, 10) > share) return {};
    const float radius = 0.16f + 0.42f * unit_of(cell.id, 11);
    return {smoothstep(radius, 0.75f * radius, cell.nearest + 0.28f * ragged),
            unit_of(cell.id, 12)};
}

glm::vec3 crust_colour(float kind) {
    constexpr glm::vec3 kPale{0.315f, 0.320f, 0.290f}, kGrey{0.225f, 0.235f, 0.205f},
        kMap{0.225f, 0.215f, 0.105f}, kBlack{0.060f, 0.056f, 0.052f};
    if (kind > 0.90f) return kBlack;
    if (kind > 0.84f) return kMap;
    return glm::mix(kPale, kGrey, std::min(1.0f, 1.4f * kind));
}

}  // namespace

// In one piece: a recipe, read from top to bottom.
Material make_rock(int n) {
    Material m;
    m.name = "rock";
    m.description = "jointed gneiss with foliation and lichens";
    m.tile_m = kRockTile_m;
    m.shininess = 16;
    m.mean_albedo = {0.184f, 0.169f, 0.148f};

    // Nothing breaks along a straight line.
    const Field warp_s = make_coarse_field(n, [](float s, float t) {
        return 0.016f * fractal_noise(kRockSeed + 1, s, t, 7, 4, 0.5f);
    });
    const Field warp_t = make_coarse_field(n, [](float s, float t) {
        return 0.016f * fractal_noise(kRockSeed + 2, s, t, 7, 4, 0.5f);
    });
    const Field along = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kRockSeed + 19, s, t, 16, 3, 0.6f); });
    const Field parting = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kRockSeed + 20, s, t, 7, 3); });
    const Field warmth = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kRockSeed + 11, s, t, 8, 4, 0.6f); });
    const Field iron = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kRockSeed + 12, s, t, 10, 3, 0.6f); });
    const Field colonies = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kRockSeed + 15, s, t, 9, 3, 0.6f); });

    m.height_m = Field(n, n);
    m.albedo = ColourField(n, n);
    m.gloss = Field(n, n);
    for_each_texel(n, [&](int c, int r) {
        const float s = (static_cast<float>(c) + 0.5f) / static_cast<float>(n);
        const float t = (static_cast<float>(r) + 0.5f) / static_cast<float>(n);
        const float fray = 0.0011f * fractal_noise(kRockSeed + 21, s, t, 70, 2);
        const float ws = s + smooth_sample(warp_s, s, t) + fray,
                    wt = t + smooth_sample(warp_t, s, t) - fray;
        const float gaping = smooth_sample(along, s, t);
        const Fracture block =
            fracture(kRockSeed + 3, kBlocks, ws, wt, 0.66f, 0.019f, 0.16f, 0.010f, gaping);
        const Fracture slab =
            fracture(kRockSeed + 4, kSlabs, ws, wt, 0.29f, 0.009f, 0.22f, 0.005f, gaping - 0.25f);
        const float broken = smoothstep(0.2f, 0.6f, unit_of(block.id, 5));  // into slabs or whole
        const float open = std::max(block.open, broken * slab.open);

        // Foliation: thin plates that end in little steps, where the rock parts along it.
        const float bed = fractal_noise(kRockSeed + 5, kBeds, ws, wt, 3, 0.6f);
        const float parts =
            smoothstep(-0.2f, 0.6f, sample(parting, s, t) + unit_of(block.id, 8) - 0.5f);
        const float plates = 3.0f * bed + 1.4f * fractal_noise(kRockSeed + 6, s, t, 15, 3, 0.55f);
        const float step = plates - std::floor(plates);
        const float ledge = std::floor(plates) + smoothstep(0.75f, 1.0f, step) + 0.3f * step;

        const float rough = fractal_noise(kRockSeed + 7, s, t, 14, 5, 0.62f);
        const float grain = hash_normal(kRockSeed + 9, c, r);
        const float flakes = scars(kRockSeed + 22, kFlakes, ws, wt);
        const float chips = scars(kRockSeed + 23, kChips, ws + fray, wt);
        m.height_m.at(c, r) = block.face_m + (0.3f + 0.7f * broken) * slab.face_m +
                              0.0050f * parts * ledge + 0.014f * rough + 0.045f * flakes +
                              0.019f * chips + 0.0005f * grain - 0.016f * block.open -
                              0.008f * broken * slab.open;

        // The rock itself: light and dark minerals in bands, and a tint for every block.
        const float band = fractal_noise(kRockSeed + 10, kBeds, ws, wt, 4, 0.8f);
        float light = 1 + 0.16f * (unit_of(block.id, 6) - 0.5f) +
                      0.20f * broken * (unit_of(slab.id, 6) - 0.5f);
        light *= 1 + 0.20f * band + 0.10f * rough + 0.06f * grain;
        const float warm = 0.10f * (unit_of(slab.id, 7) - 0.5f) + 0.07f * sample(warmth, s, t);
        glm::vec3 colour = m.mean_albedo * light * glm::vec3(1 + warm, 1, 1 - 1.2f * warm);

        // Iron stains near joints, and a dark film of algae in streaks.
        const float rust =
            smoothstep(0.2f, 0.9f, sample(iron, s, t) + 0.5f * block.near_crack + 0.2f * band);
        colour *= glm::mix(glm::vec3(1), glm::vec3(1.06f, 0.88f, 0.68f), 0.5f * rust);
        const float film =
            smoothstep(0.15f, 0.95f, fractal_noise(kRockSeed + 13, ws, wt, 10, 5, 0.66f));
        colour *= glm::mix(glm::vec3(1), glm::vec3(0.60f, 0.61f, 0.62f), 0.75f * film);

        const float ragged = fractal_noise(kRockSeed + 14, s, t, 64, 3, 0.75f);
        const float colony = smoothstep(-0.45f, 0.35f, sample(colonies, s, t));
        const Lichen crust = lichen(kRockSeed + 16, kCrusts, ws, wt, 0.50f * colony, ragged);
        const Lichen spot = lichen(kRockSeed + 17, kSpots, ws, wt, 0.35f * colony, ragged);
        for (const Lichen& l : {crust, spot})
            colour = glm::mix(colour, crust_colour(l.kind) * (1 + 0.10f * grain + 0.2f * ragged),
                              0.62f * l.cover * (1 - open));
        const float covered = std::max(crust.cover, spot.cover);
        // Soil and shade in the cracks: little light comes out of them whatever their normal is.
        colour = glm::mix(colour, glm::vec3(0.055f, 0.048f, 0.038f), 0.65f * open);
        m.albedo.at(c, r) = glm::max(colour, glm::vec3(0.01f));

        const float mica = hash_unit(kRockSeed + 18, c, r) > 0.985f ? 0.55f : 0.0f;
        m.gloss.at(c, r) =
            (1 - open) * (1 - 0.75f * covered) * (0.22f + 0.10f * band + 0.10f * (1 - film) + mica);
    });

    // Steps of a centimetre from one texel to the next would be jagged.
    m.height_m = blurred(m.height_m, 0.0055 * n / kRockTile_m);

    // Edges that stand out are worn fresh and pale, hollows gather dirt.
    const Field around = blurred(m.height_m, 0.04 * n / kRockTile_m);
    for_each_texel(n, [&](int c, int r) {
        const float out = (m.height_m.at(c, r) - around.at(c, r)) / 0.010f;
        m.albedo.at(c, r) *= 1 + 0.12f * std::clamp(out, -1.6f, 1.2f);
    });

    finish(m);
    return m;
}

}  // namespace relevo::ground

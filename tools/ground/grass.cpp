#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel_for.h"
#include "material.h"
#include "noise.h"

namespace relevo::ground {
namespace {

constexpr std::uint32_t kGrassSeed = 0x64A5;
constexpr double kGrassTile_m = 4;

/// A leaf as seen from above: a bent, tapering strip, or a round one of no length.
struct Leaf {
    glm::vec2 root, bend, tip;  ///< of a quadratic Bezier curve [m]
    float width_m, top_m;       ///< at the root; height of the highest part
    glm::vec3 root_colour, tip_colour;
    float gloss;
};

/// What is seen from above, the highest leaf winning.
class Canopy {
  public:
    explicit Canopy(int n) : height_m(n, n), colour(n, n), gloss(n, n), n_(n) {}

    Field height_m;
    ColourField colour;
    Field gloss;

    /// Draws every leaf. Bands of rows are drawn in parallel, each with all its leaves in order, so
    /// that the threads do not show.
    void draw(const std::vector<Leaf>& leaves) {
        constexpr int kBand = 64;
        const int bands = (n_ + kBand - 1) / kBand;
        std::vector<std::vector<int>> inside(static_cast<std::size_t>(bands));
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            const Leaf& leaf = leaves[i];
            const float low = std::min({leaf.root.y, leaf.bend.y, leaf.tip.y}) - leaf.width_m;
            const float high = std::max({leaf.root.y, leaf.bend.y, leaf.tip.y}) + leaf.width_m;
            const int first = static_cast<int>(std::floor(low * texels_per_m() / kBand));
            const int last = static_cast<int>(std::floor(high * texels_per_m() / kBand));
            for (int b = first; b <= last && b < first + bands; ++b)
                inside[static_cast<std::size_t>(((b % bands) + bands) % bands)].push_back(
                    static_cast<int>(i));
        }
        parallel_for(0, bands, 1, [&](int first, int last) {
            for (int b = first; b < last; ++b)
                for (const int i : inside[static_cast<std::size_t>(b)])
                    draw(leaves[static_cast<std::size_t>(i)], b * kBand,
                         std::min(n_, (b + 1) * kBand));
        });
    }

  private:
    int n_;

    float texels_per_m() const { return static_cast<float>(n_ / kGrassTile_m); }

    void draw(const Leaf& leaf, int row_begin, int row_end) {
        const float scale = texels_per_m();
        const glm::vec2 p0 = leaf.root * scale, p1 = leaf.bend * scale, p2 = leaf.tip * scale;
        const float length = glm::length(p1 - p0) + glm::length(p2 - p1);
        const int pieces = std::max(1, static_cast<int>(length / 4));
        glm::vec2 from = p0;
        for (int i = 0; i < pieces; ++i) {
            const float u0 = static_cast<float>(i) / static_cast<float>(pieces);
            const float u1 = static_cast<float>(i + 1) / static_cast<float>(pieces);
            const glm::vec2 to = (1 - u1) * (1 - u1) * p0 + 2 * u1 * (1 - u1) * p1 + u1 * u1 * p2;
            piece(leaf, from, to, u0, u1, row_begin, row_end);
            from = to;
        }
    }

    void piece(const Leaf& leaf, glm::vec2 from, glm::vec2 to, float u0, float u1, int row_begin,
               int row_end) {
        const float half = 0.5f * leaf.width_m * texels_per_m();
        const glm::vec2 along = to - from;
        const float square = std::max(glm::dot(along, along), 1e-6f);
        const int c0 = static_cast<int>(std::floor(std::min(from.x, to.x) - half));
        const int c1 = static_cast<int>(std::ceil(std::max(from.x, to.x) + half));
        const int r0 = static_cast<int>(std::floor(std::min(from.y, to.y) - half));
        const int r1 = static_cast<int>(std::ceil(std::max(from.y, to.y) + half));
        for (int r = r0; r <= r1; ++r) {
            const int row = ((r % n_) + n_) % n_;
            if (row < row_begin || row >= row_end) continue;
            for (int c = c0; c <= c1; ++c) {
                const glm::vec2 p = glm::vec2(c, r) + 0.5f - from;
                const float v = std::clamp(glm::dot(p, along) / square, 0.0f, 1.0f);
                const float u = u0 + (u1 - u0) * v;
                // Widest at a third, pointed at the end.
                const float width = half * (u < 0.33f ? 0.75f + 0.75f * u : 1.5f * (1 - u));
                const glm::vec2 off = p - v * along;
                const float distance = std::sqrt(glm::dot(off, off));
                if (distance > std::max(width, 0.45f)) continue;
                // It rises and droops; folded along its middle, the rims are higher.
                const float z = leaf.top_m * (u * (2.4f - 1.4f * u)) / 1.0286f +
                                0.12f * leaf.width_m * distance / std::max(half, 0.5f);
                const int column = ((c % n_) + n_) % n_;
                if (z <= height_m.at(column, row)) continue;
                height_m.at(column, row) = z;
                colour.at(column, row) = glm::mix(leaf.root_colour, leaf.tip_colour, u);
                gloss.at(column, row) = leaf.gloss;
            }
        }
    }
};

// Reflectances, linear sRGB, of the parts (docs/ground-materials.md has their sources).
constexpr glm::vec3 kGreen{0.062f, 0.098f, 0.031f}, kYellowGreen{0.120f, 0.138f, 0.043f},
    kDarkGreen{0.038f, 0.066f, 0.028f}, kStraw{0.29f, 0.225f, 0.115f},
    kThatch{0.145f, 0.108f, 0.062f}, kSoil{0.100f, 0.072f, 0.038f};

/// Fields that the leaves go by, -1..1 or so, over the unit tile.
float vigour(float s, float t) {
    return fractal_noise(kGrassSeed + 1, s, t, 10, 4, 0.5f);
}

float dryness(float s, float t) {
    return fractal_noise(kGrassSeed + 2, s, t, 8, 4, 0.6f);
}

glm::vec2 turned(float angle) {
    return {std::cos(angle), std::sin(angle)};
}

/// Dead leaves of last year, lying flat.
std::vector<Leaf> thatch() {
    constexpr int kAcross = 260;
    std::vector<Leaf> leaves;
    for (int j = 0; j < kAcross; ++j)
        for (int i = 0; i < kAcross; ++i) {
            const auto random = [&](int k) { return hash_unit(kGrassSeed + 10, i, j, k); };
            const glm::vec2 unit{(static_cast<float>(i) + random(0)) / kAcross,
                                 (static_cast<float>(j) + random(1)) / kAcross};
            if (random(2) > 0.75f + 0.7f * vigour(unit.x, unit.y)) continue;
            const glm::vec2 root = unit * static_cast<float>(kGrassTile_m);
            const glm::vec2 way = turned(random(3) * 6.2831853f);
            const float length_m = 0.03f + 0.07f * random(4);
            const glm::vec3 colour =
                glm::mix(kThatch, kStraw, random(5) * random(5)) * (0.6f + 0.6f * random(6));
            leaves.push_back({root, root + way * (0.5f * length_m),
                              root + way * length_m +
                                  0.3f * length_m * (random(8) - 0.5f) * glm::vec2(-way.y, way.x),
                              0.003f + 0.002f * random(9), 0.002f + 0.008f * random(7), colour,
                              colour, 0.18f});
        }
    return leaves;
}

/// Living blades, in tufts that lean outwards.
std::vector<Leaf> blades() {
    constexpr int kAcross = 470;
    constexpr int kTufts = 30;  // 13 cm from one to the next
    std::vector<Leaf> leaves;
    leaves.reserve(static_cast<std::size_t>(kAcross * kAcross));
    for (int j = 0; j < kAcross; ++j)
        for (int i = 0; i < kAcross; ++i) {
            const auto random = [&](int k) { return hash_unit(kGrassSeed + 20, i, j, k); };
            const float s = (static_cast<float>(i) + random(0)) / kAcross;
            const float t = (static_cast<float>(j) + random(1)) / kAcross;
            const Cells tuft = cells(kGrassSeed + 3, Lattice(kTufts), s, t, 0.95f);
            const auto of_tuft = [&](int k) {
                return hash_unit(kGrassSeed + 21, static_cast<int>(tuft.id & 0xFFFFFu), k);
            };
            const float strength = 0.56f + 0.80f * vigour(s, t) + 0.25f * (of_tuft(0) - 0.5f);
            // Sparse between the tufts and where little grows: thatch and soil show.
            const float cover = smoothstep(0.0f, 0.38f, strength) *
                                (1.05f - 0.75f * smoothstep(0.30f, 0.75f, tuft.nearest));
            if (random(2) > cover) continue;
            const float dry = dryness(s, t) + 0.8f * (of_tuft(1) - 0.5f);
            const glm::vec2 root = glm::vec2(s, t) * static_cast<float>(kGrassTile_m);

            const float out = 0.9f * smoothstep(0.0f, 0.6f, tuft.nearest);
            const glm::vec2 outwards =
                tuft.nearest > 1e-4f ? tuft.offset / tuft.nearest : glm::vec2(0);
            glm::vec2 way = out * outwards + 0.75f * turned(random(3) * 6.2831853f) +
                            0.35f * turned(of_tuft(2) * 6.2831853f);
            way /= std::max(glm::length(way), 1e-3f);
            const float length_m = (0.035f + 0.085f * random(4)) *
                                   (0.65f + 0.5f * std::clamp(strength, 0.0f, 1.2f)) *
                                   (0.75f + 0.5f * of_tuft(3));
            const glm::vec2 side =
                glm::vec2(-way.y, way.x) * (0.55f * length_m * (random(5) - 0.5f));

            glm::vec3 colour = glm::mix(kGreen, kDarkGreen, 0.8f * of_tuft(4));
            colour =
                glm::mix(colour, kYellowGreen,
                         std::clamp(0.30f + 0.45f * dry + 0.7f * (random(6) - 0.5f), 0.0f, 1.0f));
            const float straw = random(7) < 0.05f + 0.16f * std::clamp(dry + 0.2f, 0.0f, 1.0f)
                                    ? 0.55f + 0.45f * random(8)
                                    : 0.10f * std::clamp(dry, 0.0f, 1.0f);
            colour = glm::mix(colour, kStraw, straw) * (0.78f + 0.44f * random(9));
            glm::vec3 root_colour = glm::mix(colour, kThatch, 0.25f) * 0.8f;
            const float top_m = length_m * (0.35f + 0.45f * random(11));
            leaves.push_back({root, root + way * (0.5f * length_m) + side, root + way * length_m,
                              0.0030f + 0.0028f * random(12), top_m, root_colour, colour,
                              straw > 0.5f ? 0.15f : 0.18f + 0.22f * random(13)});
        }
    return leaves;
}

/// Clover and other small round leaves, in patches.
std::vector<Leaf> herbs() {
    constexpr int kAcross = 250;
    std::vector<Leaf> leaves;
    for (int j = 0; j < kAcross; ++j)
        for (int i = 0; i < kAcross; ++i) {
            const auto random = [&](int k) { return hash_unit(kGrassSeed + 30, i, j, k); };
            const float s = (static_cast<float>(i) + random(0)) / kAcross;
            const float t = (static_cast<float>(j) + random(1)) / kAcross;
            const float patch = fractal_noise(kGrassSeed + 4, s, t, 9, 3, 0.55f);
            if (random(2) > 0.02f + 0.95f * smoothstep(0.32f, 0.75f, patch)) continue;
            const glm::vec2 middle = glm::vec2(s, t) * static_cast<float>(kGrassTile_m);
            const float radius_m = 0.0045f + 0.0045f * random(4);
            const float turn = random(5) * 2.0943951f, top_m = 0.015f + 0.035f * random(6);
            const glm::vec3 colour =
                glm::mix(kGreen, kDarkGreen, 0.3f + 0.5f * random(7)) * (0.85f + 0.4f * random(8));
            for (int leaf = 0; leaf < 3; ++leaf) {
                const glm::vec2 out =
                    turned(turn + 2.0943951f * static_cast<float>(leaf)) * radius_m;
                leaves.push_back({middle + 0.3f * out, middle + 0.9f * out, middle + 1.9f * out,
                                  1.7f * radius_m, top_m, colour * 0.8f, colour * 1.05f, 0.22f});
            }
        }
    return leaves;
}

}  // namespace

Material make_grass(int n) {
    Material m;
    m.name = "grass";
    m.description = "meadow with tufts, clover, dead blades and some bare soil";
    m.tile_m = kGrassTile_m;
    m.shininess = 10;
    m.mean_albedo = {0.093f, 0.102f, 0.042f};

    // Blades are about as wide as a texel, so they are drawn twice as fine and averaged.
    const int fine = 2 * n;
    Canopy canopy(fine);
    const Field crumbs = make_field(
        n, [](float s, float t) { return fractal_noise(kGrassSeed + 5, s, t, 90, 3, 0.7f); });
    for_each_texel(fine, [&](int c, int r) {
        const float crumb = crumbs.at(c / 2, r / 2);
        const float grain = hash_normal(kGrassSeed + 6, c, r);
        canopy.height_m.at(c, r) = 0.002f + 0.006f * crumb + 0.0008f * grain;
        canopy.colour.at(c, r) = glm::mix(kSoil, kThatch, 0.30f + 0.30f * crumb) *
                                 std::max(0.4f, 1 + 0.55f * crumb + 0.16f * grain);
        canopy.gloss.at(c, r) = 0.05f;
    });
    canopy.draw(thatch());
    canopy.draw(herbs());
    canopy.draw(blades());

    // Light is lost between the leaves: what lies deeper than its surroundings is darker. A normal
    // map cannot say this of strips that overlap.
    const Field around = blurred(canopy.height_m, 0.016 / kGrassTile_m * fine);
    m.height_m = Field(n, n);
    m.albedo = ColourField(n, n);
    m.gloss = Field(n, n);
    for_each_texel(n, [&](int c, int r) {
        glm::vec3 colour(0);
        float height_m = 0, gloss = 0;
        for (int k = 0; k < 4; ++k) {
            const int fc = 2 * c + (k & 1), fr = 2 * r + (k >> 1);
            const float z = canopy.height_m.at(fc, fr);
            const float open = 0.48f + 0.52f * smoothstep(-0.018f, 0.014f, z - around.at(fc, fr));
            colour += 0.25f * open * canopy.colour.at(fc, fr);
            gloss += 0.25f * open * canopy.gloss.at(fc, fr);
            height_m += 0.25f * z;
        }
        m.albedo.at(c, r) = colour;
        m.gloss.at(c, r) = gloss;
        m.height_m.at(c, r) = height_m;
    });

    // Leaves stand over leaves: their steps, centimetres over millimetres, are no slope that a
    // normal could have. What can be said is how the sward as a whole is rounded, and a hint of the
    // blades.
    const double per_m = n / kGrassTile_m;
    const Field blade = blurred(m.height_m, 0.0028 * per_m);
    const Field tuft = blurred(m.height_m, 0.020 * per_m);
    for_each_texel(n, [&](int c, int r) {
        m.height_m.at(c, r) = 0.10f * (blade.at(c, r) - tuft.at(c, r)) + 0.55f * tuft.at(c, r);
    });

    finish(m);
    return m;
}

}  // namespace relevo::ground

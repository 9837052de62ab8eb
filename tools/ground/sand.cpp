#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/fft.h"
#include "material.h"
#include "noise.h"

namespace relevo::ground {
namespace {

constexpr std::uint32_t kSandSeed = 0x5A4D;
constexpr double kSandTile_m = 4;

/// Ripples as a wave with random phase and strength. Where its strength passes through zero the
/// crests fork, as wind ripples do. Source: T. Tricard et al., Procedural Phasor Noise, ACM
/// Transactions on Graphics 38(4), 2019, doi:10.1145/3306346.3322990, made here in the frequency
/// domain.
ComplexField ripple_wave(int n) {
    // Wind ripples: crests some 10 cm apart, nearly straight (Bagnold 1941, chapter 11).
    constexpr double kWaves = 38, kWindAngle = 0.42;
    constexpr double kAcross = 4.2, kAlong = 3.6;  // widths of the band [cycles a tile]
    ComplexField waves(n, n);
    for_each_texel(n, [&](int c, int r) {
        const double kx = frequency(c, n), ky = frequency(r, n);
        const double across = kx * std::cos(kWindAngle) + ky * std::sin(kWindAngle) - kWaves;
        const double along = -kx * std::sin(kWindAngle) + ky * std::cos(kWindAngle);
        const double strength = std::exp(
            -0.5 * (across * across / (kAcross * kAcross) + along * along / (kAlong * kAlong)));
        if (strength < 1e-4) return;
        // The frequency, not the index, is hashed: the same ripples at every resolution.
        const int ix = static_cast<int>(kx), iy = static_cast<int>(ky);
        waves.at(c, r) = std::complex<float>(hash_normal(kSandSeed, ix, iy, 1),
                                             hash_normal(kSandSeed, ix, iy, 2)) *
                         static_cast<float>(strength * n);
    });
    fft(waves, true);
    return waves;
}

}  // namespace

// In one piece: a recipe, read from top to bottom.
Material make_sand(int n) {
    Material m;
    m.name = "sand";
    m.description = "dry dune sand with wind ripples";
    m.tile_m = kSandTile_m;
    m.shininess = 12;
    m.mean_albedo = {0.443f, 0.329f, 0.197f};

    const ComplexField wave = ripple_wave(n);
    double square = 0;
    for (const std::complex<float> w : wave)
        square += std::norm(w);
    const auto typical = static_cast<float>(std::sqrt(square / static_cast<double>(wave.size())));

    // Ripples fade in patches, where the sand lies smooth.
    const Field patches = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSandSeed + 1, s, t, 7, 3, 0.55f); });
    const Field swell = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSandSeed + 2, s, t, 6, 4, 0.36f); });
    const Field mottling = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSandSeed + 5, s, t, 9, 4, 0.62f); });
    const Field minerals = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSandSeed + 6, s, t, 12, 3, 0.6f); });
    const Field redness = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSandSeed + 7, s, t, 8, 4, 0.6f); });

    Field crest(n, n);   // 0 in the trough, 1 on the crest
    Field ripple(n, n);  // strength
    for_each_texel(n, [&](int c, int r) {
        const float s = (static_cast<float>(c) + 0.5f) / static_cast<float>(n);
        const float t = (static_cast<float>(r) + 0.5f) / static_cast<float>(n);
        const std::complex<float> w = wave.at(c, r);
        const float phase = std::arg(w), strength = std::abs(w) / typical;
        // The lee side is steeper: the phase hurries through it.
        const float hurried = phase + 0.55f * std::sin(phase);
        crest.at(c, r) = 0.5f + 0.5f * std::cos(hurried);
        ripple.at(c, r) = smoothstep(0.0f, 0.6f, strength) *
                          (0.72f + 0.28f * smoothstep(-0.5f, 0.4f, sample(patches, s, t)));
    });

    m.height_m = Field(n, n);
    m.albedo = ColourField(n, n);
    m.gloss = Field(n, n);
    const float texels = static_cast<float>(n) / 1024.0f;
    for_each_texel(n, [&](int c, int r) {
        const float s = (static_cast<float>(c) + 0.5f) / static_cast<float>(n);
        const float t = (static_cast<float>(r) + 0.5f) / static_cast<float>(n);
        const float a = ripple.at(c, r), k = crest.at(c, r);
        const float grains = hash_normal(kSandSeed + 3, c, r);
        const float fine = fractal_noise(kSandSeed + 4, s, t, 160, 2, 0.7f);
        m.height_m.at(c, r) = 0.0072f * a * std::pow(k, 1.25f) +
                              0.016f * smooth_sample(swell, s, t) + 0.0005f * fine +
                              0.00028f * grains * texels;

        // Wind sorts: coarse, paler grains on the crests, dark heavy minerals in the troughs.
        const float mottle = sample(mottling, s, t);
        const float heavy = smoothstep(0.0f, 0.9f, sample(minerals, s, t));
        float light = 1 + 0.055f * grains + 0.05f * fine + 0.05f * mottle;
        light *= 1 + 0.05f * a * (k - 0.5f);
        light *= 1 - a * (1 - k) * (1 - k) * (0.04f + 0.11f * heavy);
        glm::vec3 colour = m.mean_albedo * light;
        // Iron on the grains varies: redder and yellower patches and grains.
        const float iron = 0.05f * sample(redness, s, t) + 0.03f * hash_normal(kSandSeed + 8, c, r);
        colour *= glm::vec3(1 + 0.35f * iron, 1 - 0.1f * iron, 1 - 0.9f * iron);
        m.albedo.at(c, r) = colour;

        // A few quartz faces in ten thousand look just right at the sun; the troughs are dull.
        const float quartz = hash_unit(kSandSeed + 9, c, r) > 0.994f ? 0.75f : 0.0f;
        m.gloss.at(c, r) = 0.16f + 0.10f * k * a + 0.05f * hash_unit(kSandSeed + 10, c, r) + quartz;
    });

    finish(m);
    return m;
}

}  // namespace relevo::ground

#include <cmath>
#include <numbers>

#include "field.h"
#include "noise.h"
#include "support/support.h"

namespace relevo::ground {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Field wave(int n, int kx, int ky, double phase = 0.3) {
    return make_field(n, [=](float s, float t) {
        return static_cast<float>(std::cos(kTurn * (kx * s + ky * t) + phase));
    });
}

TEST(Field, SamplingAtTexelCentresGivesTheTexels) {
    const Field field = wave(32, 3, -2);
    for (int r = 0; r < 32; ++r)
        for (int c = 0; c < 32; ++c) {
            const float s = (c + 0.5f) / 32, t = (r + 0.5f) / 32;
            EXPECT_NEAR(sample(field, s, t), field.at(c, r), 1e-5f);
            EXPECT_NEAR(sample(field, s - 1, t + 2), field.at(c, r), 1e-5f);
            // The spline blurs: (1 + 6 + 1) / 8 in each direction.
            EXPECT_NEAR(smooth_sample(field, s, t), field.at(c, r), 0.08f);
            EXPECT_NEAR(smooth_sample(field, s + 1, t - 1), smooth_sample(field, s, t), 1e-5f);
        }
}

// A Gaussian of deviation sigma leaves exp(-2 (pi sigma k / n)^2) of a wave of k cycles.
TEST(Blurred, LeavesAWaveWhatTheGaussiansTransformSays) {
    constexpr int n = 128;
    const Field field = wave(n, 5, 2);
    for (const double sigma_px : {0.8, 2.0, 6.5}) {
        const Field soft = blurred(field, sigma_px);
        const double k = std::hypot(5, 2);
        const double left = std::exp(-2 * std::pow(std::numbers::pi * sigma_px * k / n, 2));
        for (int r = 0; r < n; r += 7)
            for (int c = 0; c < n; c += 7)
                EXPECT_NEAR(soft.at(c, r), left * field.at(c, r), 1e-3);
    }
}

TEST(Flatten, TakesOutLongWavesAndKeepsShortOnes) {
    struct Case {
        int kx, ky;
        double left;
    };
    for (const Case& c :
         {Case{1, 0, 0}, Case{0, -2, 0}, Case{2, 2, 0}, Case{-4, 0, 0}, Case{0, 8, 1},
          Case{4, 4, flatten_gain(std::sqrt(32.0))}, Case{-5, 2, flatten_gain(std::sqrt(29.0))},
          Case{0, 7, flatten_gain(7)}, Case{-8, 6, 1}, Case{20, 3, 1}}) {
        const Field before = wave(64, c.kx, c.ky);
        Field after = before;
        for (float& v : after)
            v += 2;
        flatten(after);
        for (int i = 0; i < 64; ++i)
            EXPECT_NEAR(after.at(i, (i * 5) % 64), 2 + c.left * before.at(i, (i * 5) % 64), 2e-5)
                << c.kx << ", " << c.ky;
    }
    EXPECT_EQ(flatten_gain(0), 1);
    EXPECT_EQ(flatten_gain(4), 0);
    EXPECT_EQ(flatten_gain(6), 0.5);
    EXPECT_EQ(flatten_gain(8), 1);
}

}  // namespace
}  // namespace relevo::ground

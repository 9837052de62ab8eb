#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "support/support.h"
#include "weather/two_stream.h"

namespace relevo::weather {
namespace {

using test::error_of;

constexpr double kDepths[] = {0, 1e-6, 0.1, 1, 5, 20, 100, 1e4, 1e9};
constexpr double kCosines[] = {0.02, 0.2, 0.5, 0.866, 1};

TEST(TwoStream, LosesNoEnergy) {
    for (const double tau : kDepths)
        for (const double mu : kCosines) {
            const LayerLight beam = beam_through({.optical_depth = tau}, mu);
            EXPECT_NEAR(beam.transmitted() + beam.reflected, 1, 1e-9) << tau << ' ' << mu;
            EXPECT_GE(beam.direct, 0);
            EXPECT_GE(beam.diffuse, 0);
            EXPECT_NEAR(beam.direct, std::exp(-tau / mu), 1e-12);
            const LayerLight sky = sky_through({.optical_depth = tau});
            EXPECT_NEAR(sky.transmitted() + sky.reflected, 1, 1e-9);
            // Between layer and ground: what the ground takes and what leaves at the top is all.
            const LayerLight over = over_ground(beam, sky, 0.2);
            EXPECT_NEAR(0.8 * over.transmitted() + over.reflected, 1, 1e-9);
        }
}

TEST(TwoStream, AbsorptionTakesLight) {
    for (const double tau : kDepths)
        for (const double mu : kCosines) {
            const CloudLayerOptics layer{tau, 0.85, 0.99};
            const LayerLight beam = beam_through(layer, mu);
            EXPECT_TRUE(std::isfinite(beam.transmitted() + beam.reflected)) << tau << ' ' << mu;
            EXPECT_LE(beam.transmitted() + beam.reflected, 1 + 1e-9) << tau << ' ' << mu;
        }
    // Next to nothing absorbed is as good as nothing.
    const LayerLight a = beam_through({20, 0.85, 1 - 1e-8}, 0.5);
    const LayerLight b = beam_through({20, 0.85, 1}, 0.5);
    EXPECT_NEAR(a.diffuse, b.diffuse, 1e-4);
    EXPECT_NEAR(a.reflected, b.reflected, 1e-4);
}

// Photons one by one: free ways of an exponential distribution, turns of Henyey and Greenstein's.
LayerLight followed(const CloudLayerOptics& layer, double mu0, int photons) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    const double g = layer.asymmetry;
    LayerLight sum;
    for (int i = 0; i < photons; ++i) {
        double depth = 0, mu = mu0, azimuth = 0;
        for (bool scattered = false;; scattered = true) {
            depth -= mu * std::log(1 - uniform(random));
            if (depth >= layer.optical_depth || depth < 0) {
                (depth < 0 ? sum.reflected : scattered ? sum.diffuse : sum.direct) += 1.0 / photons;
                break;
            }
            if (uniform(random) > layer.single_scattering_albedo) break;
            const double s = (1 - g * g) / (1 - g + 2 * g * uniform(random));
            const double turn = (1 + g * g - s * s) / (2 * g);
            azimuth = 2 * M_PI * uniform(random);
            mu = mu * turn +
                 std::sqrt(std::max((1 - mu * mu) * (1 - turn * turn), 0.0)) * std::cos(azimuth);
        }
    }
    return sum;
}

TEST(TwoStream, AgreesWithPhotonsFollowed) {
    std::vector<double> errors;
    for (const double tau : {0.3, 1.0, 4.0, 16.0, 64.0})
        for (const double mu : {0.3, 0.6, 1.0})
            for (const double omega : {1.0, 0.95}) {
                const CloudLayerOptics layer{tau, 0.85, omega};
                const LayerLight exact = followed(layer, mu, 8000);
                const LayerLight made = beam_through(layer, mu);
                errors.push_back(std::abs(made.transmitted() - exact.transmitted()));
                errors.push_back(std::abs(made.reflected - exact.reflected));
            }
    test::print_accuracy("delta-Eddington against photons", errors, "of the irradiance", 0.07);
    EXPECT_LT(*std::ranges::max_element(errors), 0.07);
    EXPECT_LT(std::accumulate(errors.begin(), errors.end(), 0.0) / 60, 0.015);
}

TEST(TwoStream, StormsAreNotBlack) {
    // A deck of tau 100 lets some 12 % through; the beam alone would be 1e-43.
    const LayerLight light = over_ground(beam_through({100}, 0.9), sky_through({100}), 0.2);
    EXPECT_GT(light.transmitted(), 0.1);
    EXPECT_LT(light.transmitted(), 0.2);
    EXPECT_EQ(sky_through({0}).diffuse, 1);
}

TEST(TwoStream, RefusesWhatIsNoLayer) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(error_of([&] { beam_through({nan}, 1); }),
              "exit 3: clouds: expected an optical depth of 0 or more but got nan");
    EXPECT_EQ(error_of([&] { sky_through({-1}); }),
              "exit 3: clouds: expected an optical depth of 0 or more but got -1");
    EXPECT_EQ(error_of([&] { beam_through({1}, 0); }),
              "exit 3: clouds: expected a cosine above 0 and at most 1 but got 0");
    EXPECT_EQ(error_of([&] {
                  beam_through({1, 0.85, 2}, 1);
              }),
              "exit 3: clouds: expected a single-scattering albedo of 0 to 1 but got 2");
}

}  // namespace
}  // namespace relevo::weather

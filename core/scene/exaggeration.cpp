#include "scene/exaggeration.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel_for.h"

namespace relevo::scene {

bool may_exaggerate(const Scene& scene) {
    const View& view = scene.view;
    const effect::Switches& switches = scene.effects.switches;
    const bool from_the_air = view.orbit.aerial && !view.eye && !scene.ortho &&
                              view.panorama == Panorama::None && view.stereo == Stereo::None;
    const bool default_time = scene.time.at.empty() && scene.time.date.empty();
    const bool default_effects = switches.enable.empty() && !switches.only &&
                                 scene.effects.presets.empty() && scene.effects.settings.empty();
    return from_the_air && default_time && default_effects && !scene.overlay;
}

namespace {

constexpr int kColumns = 300;  // the grid that slopes are measured on

/// Means of squares of posts.
Array2d<float> reduced(const Array2d<float>& height_m) {
    const int step = std::max(1, std::max(height_m.width(), height_m.height()) / kColumns);
    Array2d<float> means((height_m.width() + step - 1) / step,
                         (height_m.height() + step - 1) / step, std::nanf(""));
    const auto take_row = [&](int y) {
        for (int x = 0; x < means.width(); ++x) {
            double sum = 0;
            int count = 0;
            for (int row = y * step; row < std::min((y + 1) * step, height_m.height()); ++row)
                for (int column = x * step; column < std::min((x + 1) * step, height_m.width());
                     ++column)
                    if (const float h = height_m.at(column, row); std::isfinite(h)) {
                        sum += h;
                        ++count;
                    }
            if (count > 0) means.at(x, y) = static_cast<float>(sum / count);
        }
    };
    parallel_for(0, means.height(), 8, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            take_row(y);
    });
    return means;
}

/// The value that a share of them does not exceed.
double quantile(std::vector<float>& values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Tangents of slopes of the ground, but of a level sea, which has none to count.
std::vector<float> slopes(const Array2d<float>& height_m, const glm::dvec2& sides_m) {
    const double across_m = sides_m.x / height_m.width(), along_m = sides_m.y / height_m.height();
    std::vector<float> tangents;
    for (int y = 1; y + 1 < height_m.height(); ++y)
        for (int x = 1; x + 1 < height_m.width(); ++x) {
            const double east = (height_m.at(x + 1, y) - height_m.at(x - 1, y)) / (2 * across_m);
            const double north = (height_m.at(x, y + 1) - height_m.at(x, y - 1)) / (2 * along_m);
            const double tangent = std::hypot(east, north);
            if (std::isfinite(tangent) && std::abs(height_m.at(x, y)) > 0.5)
                tangents.push_back(static_cast<float>(tangent));
        }
    return tangents;
}

}  // namespace

double chosen_exaggeration(const Array2d<float>& height_m, const glm::dvec2& sides_m) {
    // Chosen by eye on twenty DEMs: relief of 13 % of the width, and no slopes above 42 degrees but
    // the steepest tenth.
    constexpr double kRelief = 0.13, kSteepest = 0.9004, kMost = 4, kMostOfPlains = 20,
                     kPlain_m = 20;
    constexpr double kSteep = 0.12, kLeastPost_m = 5, kLeast = 1.15;
    const double width_m = std::sqrt(sides_m.x * sides_m.y);
    const Array2d<float> means = reduced(height_m);
    std::vector<float> found;
    std::ranges::copy_if(means, std::back_inserter(found),
                         [](float h) { return std::isfinite(h); });
    if (found.size() < 16 || !(width_m > 0)) return 1;
    const auto [lowest, highest] = std::ranges::minmax(found);
    // A lone summit counts half.
    const double relief_m =
        0.5 * (highest - lowest + quantile(found, 0.99) - quantile(found, 0.01));
    const double post_m = width_m / std::sqrt(static_cast<double>(height_m.size()));
    if (relief_m > kSteep * width_m || post_m < kLeastPost_m || relief_m <= 0) return 1;
    const bool plain = highest <= 0 || relief_m < kPlain_m;
    double times = std::min(std::sqrt(kRelief * width_m / relief_m), plain ? kMostOfPlains : kMost);
    std::vector<float> tangents = slopes(means, sides_m);
    if (!tangents.empty())
        times = std::min(times, kSteepest / std::max(quantile(tangents, 0.9), 1e-6));
    return times < kLeast ? 1 : std::round(times * 5) / 5;
}

}  // namespace relevo::scene

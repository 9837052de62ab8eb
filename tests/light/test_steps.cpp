// Hours of sun by shorter and longer steps of time.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "light/hills.h"
#include "light/raster/sun_hours.h"

namespace relevo::light::test_steps {
namespace {

TEST(Steps, ThatAreLongLoseNoLightAtDawnAndDusk) {
    const dem::Heightfield flat = test::field_of(40, 40, {500000, 30, 0, 5200000, 0, -30},
                                                 "EPSG:32632", [](int, int) { return 500.0; });
    const dem::Posts posts(flat);
    const sun::Instant begin = utc("2026-06-20T22:00Z");
    for (const double step_min : {1.0, 3.0, 15.0, 30.0, 60.0}) {
        SunHoursOptions options;
        options.step_s = 60 * step_min;
        const SunHours found = sun_hours(posts, begin, begin + 86400.0, options);
        fmt::print("[ accuracy ] flat ground, suns {} min apart: {:.4f} h, of {:.4f}\n", step_min,
                   found.hours.at(20, 20), found.level_hours);
        EXPECT_NEAR(found.hours.at(20, 20), found.level_hours, 0.02) << step_min;
    }
}

/// Of hours of one day, against those with suns 6 s apart.
struct StepError {
    double mean_min = 0, worst_min = 0;
    int far = 0;  // posts that are off by more than a minute
    std::size_t posts = 0;
};

std::vector<StepError> errors_of_steps(const dem::Posts& posts, sun::Instant begin,
                                       const Window& part, const std::vector<double>& steps_s) {
    const auto hours = [&](double step_s) {
        SunHoursOptions options;
        options.step_s = step_s;
        options.part = part;
        return sun_hours(posts, begin, begin + 86400.0, options).hours;
    };
    const Array2d<float> expected = hours(6);
    std::vector<StepError> errors;
    for (const double step_s : steps_s) {
        const Array2d<float> found = hours(step_s);
        StepError error{.posts = found.size()};
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double off_min = 60 * std::abs(double{found.data()[i]} - expected.data()[i]);
            error.mean_min += off_min / static_cast<double>(found.size());
            error.worst_min = std::max(error.worst_min, off_min);
            error.far += off_min > 1;
        }
        fmt::print(
            "[ accuracy ] suns {} s apart against 6 s: mean {:.3f} min, {:.3f} % beyond a "
            "minute, worst {:.2f}\n",
            step_s, error.mean_min, 100.0 * error.far / static_cast<double>(error.posts),
            error.worst_min);
        errors.push_back(error);
    }
    return errors;
}

/// What a minute between two suns is good for.
void expect_a_minute(const StepError& error) {
    EXPECT_LE(error.far, static_cast<int>(error.posts / 1000));
    EXPECT_LE(error.worst_min, 3);
}

TEST(Steps, ThatAreShortComeToOneResult) {
    const dem::Heightfield field = test::bundled("jacksboro.tif");
    const dem::Posts posts(field);
    const std::vector<StepError> errors =
        errors_of_steps(posts, utc("2026-12-21T06:00Z"), {120, 90, 160, 140}, {180, 60, 30});
    expect_a_minute(errors[1]);
    // They fall with the step, and faster.
    EXPECT_LE(errors[1].mean_min, errors[0].mean_min / 2.1);
    EXPECT_LE(errors[2].mean_min, errors[1].mean_min / 1.5);
    for (const char* const begin : {"2026-03-21T06:00Z", "2026-06-21T06:00Z"})
        expect_a_minute(errors_of_steps(posts, utc(begin), {160, 120, 80, 70}, {60}).front());
}

}  // namespace
}  // namespace relevo::light::test_steps

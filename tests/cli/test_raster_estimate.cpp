#include <gtest/gtest.h>

#include "figure/estimate.h"

namespace relevo::cli::test_raster_estimate {
namespace {

using figure::SampledTime;

TEST(SampledTime, WhatGetsReadyIsNotMultipliedByTheSteps) {
    // As sun hours of a day report: 6 s until the work begins, then 200 suns of 3 s each.
    SampledTime day;
    EXPECT_EQ(day.all_s(), 0);
    day.begin_part(1, 1);
    day.end_step(0, 7);
    EXPECT_FALSE(day.suffices()) << "no step has been made";
    day.end_step(0.005, 10);
    EXPECT_TRUE(day.suffices());
    EXPECT_NEAR(day.all_s(), 6 + 200 * 3, 1e-9);
    // Of five days: 180 directions of 6 s each; the first one reports with what comes before it.
    SampledTime days;
    days.begin_part(1, 0);
    days.end_step(1.0 / 180, 12);
    EXPECT_FALSE(days.suffices());
    days.end_step(1.0 / 180, 18);
    EXPECT_NEAR(days.all_s(), 12 + 179 * 6, 1e-9);
    EXPECT_LT(day.all_s(), days.all_s());
}

TEST(SampledTime, PartsOfOneStepAreAsLongAsTheirPosts) {
    SampledTime time;
    time.begin_part(0.25, 0);
    time.end_step(0.25, 5);
    EXPECT_TRUE(time.suffices());
    EXPECT_NEAR(time.all_s(), 20, 1e-9);
    time.begin_part(0.5, 6);  // what is between parts is none of their time
    time.end_step(0.5, 13);
    EXPECT_NEAR(time.all_s(), 16, 1e-9);
}

TEST(SampledTime, EveryPartGetsReady) {
    SampledTime time;
    for (const double begin_s : {0.0, 10.0}) {
        time.begin_part(0.1, begin_s);
        time.end_step(0, begin_s + 2);
        time.end_step(0.05, begin_s + 4);
        time.end_step(0.05, begin_s + 6);
    }
    EXPECT_NEAR(time.all_s(), 60, 1e-9);
}

}  // namespace
}  // namespace relevo::cli::test_raster_estimate

#pragma once

/// How accurate figures are over the heights that they are made of: what files say of themselves.
/// Tests and benches that measure it: docs/accuracy-sun-rasters.md, docs/sun.md.
namespace relevo::figure {

inline constexpr const char
    *kShadowAccuracy =
        "up to 0.3 % of the posts are lit otherwise than by a march over all heights, most of them "
        "next to an edge of shade",
    *kDaysAccuracy =
        "with suns 3 minutes apart a day is 0.5 min off in the mean, 99 % within 2.6, against the "
        "exact horizon",
    *kManyDaysAccuracy =
        "a day is 0.6 min off in the mean, 99 % within 2.9, a year 0.05 % in the median, 0.7 % at "
        "worst, against the exact horizon",
    *kSkyViewAccuracy = "0.003 off in the mean, 0.04 at worst, against topocalc",
    *kHorizonAccuracy =
        "0.01 degrees off in the median, 99 % within 1, 2 at worst, against the exact horizon";

}  // namespace relevo::figure

#pragma once

#include "figure/directions.h"

namespace relevo::figure {

/// The one band of a sky view.
output::RasterBand sky_view_band();

/// The sky-view factor of each post: `relevo sun sky-view`.
struct SkyView : Directions {
    SkyView() : Directions(kSkyDirections) {}

    bool level = false;  ///< of a level plane at each post instead of the ground
    /// Shown each part.
    std::function<void(const light::SkyView& part)> seen{};

    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts& posts) const override;
    int bytes_a_post() const override { return 22; }
    PartMaker maker(Work work) const override;
};

}  // namespace relevo::figure

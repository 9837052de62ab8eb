#pragma once

#include "figure/figure.h"
#include "light/raster/horizons.h"

namespace relevo::figure {

/// Azimuths of evenly spread directions, from true north [rad].
std::vector<double> azimuths_of(int directions);

/// The one band of a sky view.
output::RasterBand sky_view_band();

/// The sky-view factor of each post: `relevo sun sky-view`.
struct SkyView : Figure {
    int directions = static_cast<int>(kSkyDirections.value);
    bool level = false;  ///< of a level plane at each post instead of the ground
    /// Shown each part.
    std::function<void(const light::SkyView& part)> seen{};

    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts& posts) const override;
    int bytes_a_post() const override { return 22; }
    double halo_m(const dem::Posts& posts) const override;
    std::optional<light::Beyond> beyond(const dem::Posts& posts,
                                        const dem::Window& window) const override;
    const char* would() const override { return light::kStandsOver; }
    PartMaker maker(Work work) const override;
};

}  // namespace relevo::figure

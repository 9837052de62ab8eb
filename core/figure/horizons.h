#pragma once

#include "figure/figure.h"
#include "figure/sky_view.h"

namespace relevo::figure {

/// The apparent horizon of each post, a band for each azimuth: `relevo sun horizons`.
struct Horizons : Figure {
    int directions = static_cast<int>(kHorizonDirections.value);

    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts&) const override { return {}; }
    std::size_t calls() const override { return static_cast<std::size_t>(directions); }
    int bytes_a_post() const override { return 12; }
    double halo_m(const dem::Posts& posts) const override;
    std::optional<light::Beyond> beyond(const dem::Posts& posts,
                                        const dem::Window& window) const override;
    const char* would() const override { return light::kStandsOver; }
    PartMaker maker(Work work) const override;
};

}  // namespace relevo::figure

#pragma once

#include "figure/directions.h"

namespace relevo::figure {

/// The apparent horizon of each post, a band for each azimuth: `relevo sun horizons`.
struct Horizons : Directions {
    Horizons() : Directions(kHorizonDirections) {}

    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts&) const override { return {}; }
    std::size_t calls() const override { return static_cast<std::size_t>(directions); }
    int bytes_a_post() const override { return 12; }
    PartMaker maker(Work work) const override;
};

}  // namespace relevo::figure

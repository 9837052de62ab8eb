#pragma once

#include <memory>
#include <vector>

#include "figure/accuracy.h"
#include "figure/figure.h"
#include "light/raster/horizons.h"

namespace relevo::figure {

/// A figure of horizons in evenly spread directions around each post.
struct Directions : Figure {
    explicit Directions(const Option& option) : directions(static_cast<int>(option.value)) {}

    int directions;

    double halo_m(const dem::Posts& posts) const override;
    std::optional<light::Beyond> beyond(const dem::Posts& posts,
                                        const dem::Window& window) const override;
    const char* would() const override { return light::kStandsOver; }

  protected:
    /// Their azimuths, from true north [rad].
    std::vector<double> azimuths() const;
    /// Without directions yet.
    std::shared_ptr<light::SunPlan> plan(const Work& work) const;
};

/// The sky-view factor of each post: `relevo sun sky-view`.
struct SkyView : Directions {
    SkyView() : Directions(kSkyDirections) {}

    bool level = false;  ///< of a level plane at each post instead of the ground
    /// Shown each part.
    std::function<void(const light::SkyView& part)> seen{};

    std::vector<output::RasterBand> bands() const override { return {{"sky-view factor", "1"}}; }
    output::RasterMetadata metadata(const dem::Posts& posts) const override;
    const char* accuracy() const override { return kSkyViewAccuracy; }
    int bytes_a_post() const override { return 22; }
    PartMaker maker(Work work) const override;
};

/// The apparent horizon of each post, a band for each azimuth: `relevo sun horizons`.
struct Horizons : Directions {
    Horizons() : Directions(kHorizonDirections) {}

    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts&) const override { return {}; }
    std::size_t calls() const override { return static_cast<std::size_t>(directions); }
    const char* accuracy() const override { return kHorizonAccuracy; }
    int bytes_a_post() const override { return 12; }
    PartMaker maker(Work work) const override;
};

}  // namespace relevo::figure

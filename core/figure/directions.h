#pragma once

#include <memory>
#include <vector>

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

}  // namespace relevo::figure

#pragma once

#include <utility>
#include <vector>

#include "effect/manifest.h"
#include "shader/param_store.h"

namespace relevo::render {

/// How far the enabled effects move the ground at most, in metres of the DEM's heights: what they
/// move into sight has to be drawn, and lit.
struct Displacement {
    double down_m = 0, up_m = 0;  ///< along the vertical, each 0 or above
    double aside_m = 0;           ///< across it, in any direction
    std::vector<double> to_m;     ///< and anywhere between the ground and each of these heights

    bool any() const { return down_m > 0 || up_m > 0 || aside_m > 0 || !to_m.empty(); }

    /// Heights that ground of these heights may be drawn at, before exaggeration; its own are among
    /// them, as a vertex glides to its coarser level by where it is not displaced.
    /// @returns lowest and highest
    std::pair<double, double> range_m(double lowest_m, double highest_m) const;

    friend bool operator==(const Displacement&, const Displacement&) = default;
};

/// What the bounds of several effects come to, whatever their order.
/// @param values  of the parameters that the bounds name
/// @throws Error (BadInput) for a parameter that is not declared
Displacement displacement_of(const std::vector<effect::DisplaceSpec>& specs,
                             const shader::ParamStore& values);

}  // namespace relevo::render

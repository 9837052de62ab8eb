#pragma once

#include <utility>
#include <vector>

#include "effect/manifest.h"
#include "shader/param_store.h"

namespace relevo::render {

/// Bounds of displacement by the enabled effects, in metres of the DEM's heights. Displaced ground
/// has to be drawn and lit.
struct Displacement {
    double down_m = 0, up_m = 0;  ///< along the vertical, not negative
    double aside_m = 0;           ///< horizontal, in any direction
    std::vector<double> to_m;     ///< heights that ground may be moved to, fully or partly

    bool any() const { return down_m > 0 || up_m > 0 || aside_m > 0 || !to_m.empty(); }

    /// Range of drawn heights of ground between two heights, without exaggeration. It includes
    /// these, because vertices morph to coarser levels at undisplaced positions.
    /// @returns lowest and highest
    std::pair<double, double> range_m(double lowest_m, double highest_m) const;

    friend bool operator==(const Displacement&, const Displacement&) = default;
};

/// Combined bounds of several effects, in any order.
/// @param values  of the parameters that bounds refer to
/// @throws Error (BadInput) for an undeclared parameter
Displacement displacement_of(const std::vector<effect::DisplaceSpec>& specs,
                             const shader::ParamStore& values);

}  // namespace relevo::render

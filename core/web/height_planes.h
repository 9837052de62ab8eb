#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/array2d.h"

/// Heights as bytes that deflate well.
namespace relevo::web {

/// Heights in whole steps: metres = min_m + step_m * value.
struct Heights {
    double min_m = 0, step_m = 1;
    Array2d<std::uint16_t> value;
};
inline constexpr std::uint16_t kVoid = 65535;

/// Rounds heights to whole steps, within half a step. A relief of more than 65534 steps gets longer
/// ones.
/// @param height_m  NaN in voids
/// @param step_m    above 0
Heights in_steps(const Array2d<float>& height_m, double step_m);

/// Differences of each value from left + upper - upper left, modulo 65536; values outside of the
/// grid count as 0. First the low bytes of all, then the high bytes, rows from the top.
std::vector<std::byte> planes_of(const Array2d<std::uint16_t>& values);

}  // namespace relevo::web

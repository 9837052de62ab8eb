#pragma once

#include <functional>
#include <span>

#include "base/window.h"
#include "zones/even_odd.h"

namespace relevo::zones {

/// The cells that edges reach into, of those in `all`. @param edges  in cells, as coverage()
Window cells_of(std::span<const Edge> edges, const Window& all);

/// Shares of cells that outlines enclose, 0 to 1, exact but for rounding (1e-12 in a window 10,000
/// cells wide).
/// @param edges   x in columns, y in rows: cell (c, r) is from c to c + 1 and from r to r + 1
/// @param window  of cells; what lies outside of it counts for nothing
/// @returns row by row
std::vector<double> coverage(std::span<const Edge> edges, const Window& window);

}  // namespace relevo::zones

#pragma once

#include "chart/legend.h"

namespace relevo::viewer {

/// Draws a legend in a panel, in its width: a bar with its ends and unit, or classes with names.
void layer_legend(const chart::Legend& legend);

}  // namespace relevo::viewer

#pragma once

#include <string>

#include "geo/proj.h"

// Inside of the layer only.

namespace relevo::geo {

/// What body a CRS is of, by the size of its ellipsoid: "the Moon"; empty for the Earth.
std::string other_body(PJ_CONTEXT* context, const PJ* crs);

}  // namespace relevo::geo

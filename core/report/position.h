#pragma once

#include <string>
#include <vector>

#include "report/asked.h"
#include "sun/position.h"
#include "sun/time.h"

namespace relevo::report {

/// A figure of a position: its key, and how a table writes it.
struct Number {
    const char* key;
    double value;
    const char* format;
};

/// Where the sun or the moon stands.
struct BodyPosition {
    sun::Body body;
    geo::Geodetic place;
    sun::ParsedTime when;
    sun::SkyPosition sky;
    sun::Refraction air;
    double apparent_deg = 0;
    std::vector<Number> more;  ///< only this body has
    std::string phase;         ///< of the moon

    /// In the unit that the body's distance is usually given in.
    Number distance() const;
};

/// Without the age of the moon, which takes ten times as long.
/// @param air  over the place
BodyPosition position(sun::Body body, const sun::Refraction& air, const geo::Geodetic& place,
                      const sun::ParsedTime& when);
std::string json_of(const BodyPosition& result);

}  // namespace relevo::report

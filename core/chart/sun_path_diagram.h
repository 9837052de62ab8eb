#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart/drawing.h"
#include "light/point/direct_light.h"
#include "sun/events.h"

namespace relevo::chart {

/// The sky of a place as a disc, zenith in the middle and north at the top, with the sun's paths of
/// a year and the hours on them.
struct SunPathDiagram {
    geo::Geodetic place;
    std::string place_name;  ///< for the title, where there is one
    sun::Zone zone;
    int year = 0;
    sun::Refraction refraction = sun::Refraction::none();
    /// The day to be drawn strongly, with its hours by the clock; none: the year alone.
    std::optional<sun::Day> day;
    const light::Skyline* terrain = nullptr;  ///< stands in the sky where there is one
    std::string terrain_definition;
    /// DirectLight::holes() of it; marked where there are any.
    std::vector<bool> holes;
    std::optional<light::LightDay> light;  ///< of `day`, where there is terrain
    std::string light_definition;

    /// 900 units wide. The sky is projected stereographically, so that the sun's daily circles
    /// remain circles.
    Drawing draw() const;
};

}  // namespace relevo::chart

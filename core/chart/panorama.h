#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart/drawing.h"
#include "chart/skyline_names.h"
#include "light/point/direct_light.h"

namespace relevo::chart {

/// The landscape round a viewpoint as it stands against the sky, ridge before ridge, with the paths
/// of the sun behind it.
struct HorizonPanorama {
    const light::TerrainHorizon* horizon = nullptr;
    const std::vector<light::HorizonPoint>* profile = nullptr;  ///< of that horizon, all round
    std::vector<SkylineName> names;  ///< of summits; other tops have their height alone
    std::string place_name;          ///< for the title, where there is one
    /// The sun's paths of a year by the clock of a zone; 0: the landscape alone.
    int year = 0;
    sun::Zone zone;
    sun::Refraction refraction = sun::Refraction::none();
    /// The day to be drawn strongly, with its direct light.
    std::optional<light::LightDay> day;
    std::string light_definition;
    /// Whose day it is; with the moon's there are no paths of the sun.
    sun::Body body = sun::Body::Sun;

    std::optional<PanelSize> panel;  ///< none: a sheet

    /// Where directions are in the drawing.
    struct Axes {
        Rect plot;
        double middle_rad = 0;  ///< azimuth
        double low_rad = 0, high_rad = 0;
        glm::dvec2 at(double azimuth_rad, double elevation_rad) const;
    };

    /// A sheet is 1500 units wide. Azimuths run evenly along it, the sun's side of the sky in the
    /// middle; elevations have a scale of their own, which is said.
    /// @param axes  filled if not null
    Drawing draw(Axes* axes = nullptr) const;
};

}  // namespace relevo::chart

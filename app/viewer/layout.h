#pragma once

#include <glm/vec2.hpp>

#include "scene/camera.h"
#include "viewer/settings.h"

/// Columns and rows of the window. Panels take their own place; what they leave is the picture's.
namespace relevo::viewer {

/// A part of the window [units of the mouse, from its upper left corner].
struct Area {
    glm::vec2 at{0}, size{0};

    glm::vec2 end() const { return at + size; }
};

/// What is at the lower edge.
enum class Lower {
    Bar,     ///< the time bar
    Charts,  ///< the charts of a point, above the time bar
    Film,    ///< the film panel, which has its own time line
};

struct Layout {
    Area side;        ///< the side panel; empty like those below: hidden
    Area bar;         ///< the time bar
    Area charts;      ///< beside the side panel
    Area picture;     ///< what is left
    float below = 0;  ///< lower part of the picture that views leave free

    /// What covers the picture, which is drawn as large as the window.
    scene::Insets insets(glm::vec2 window) const;
};

/// Least and greatest width of the side panel, and least height of the charts, as shares of the
/// window or in units of a layout for the default text size.
inline constexpr float kLeastPanel = 240, kMostPanelShare = 0.5f, kLeastCharts = 150,
                       kMostChartsShare = 0.5f;

/// @param window  its size
/// @param unit    size of a unit of a layout for the default text size
Layout lay_out(glm::vec2 window, float unit, const Settings& settings, Lower lower);

}  // namespace relevo::viewer

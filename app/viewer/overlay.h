#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <imgui.h>

#include "chart/drawing.h"
#include "viewer/command.h"
#include "viewer/layout.h"
#include "viewer/navigation.h"
#include "viewer/scene_thread.h"

/// Drawings over the image: scale, north arrow, sheets of help.
namespace relevo::viewer {

/// "440 m", "1.23 km".
std::string length_text(double length_m);
/// The largest 1, 2 or 5 times a power of ten that is not above `length`.
double round_length(double length);

/// "SSW", in the user's language.
const char* compass_text(double azimuth_deg);

/// "2.9 degrees, facing S".
/// @param slope_deg   NaN: the text is empty
/// @param aspect_deg  downhill, from true north; NaN on level ground
std::string slope_text(double slope_deg, double aspect_deg);

/// A text over the image, on a shade.
/// @param wrap_px  width of its lines; -1: one line
void label_over(ImVec2 at, const char* words, float wrap_px = -1);
/// Labels for both sides of a comparison's dividing line.
/// @param line_px  from the left edge
void draw_sides(float line_px, float top_px);

/// Where the north arrow is in the window. @param free  what panels leave of the picture
chart::Rect north_place(const Area& free);

/// @param middle_m  ground at the centre of the image; none: no scale bar
/// @param size_px   of the window
/// @param free      what panels leave of the picture
void draw_scale_and_north(const Picture& picture, const Land& land,
                          const std::optional<glm::dvec3>& middle_m, glm::vec2 size_px,
                          const Area& free);

/// A sheet of the menu Help. @param sheet  Keys, FirstSteps or About
void help_sheet(Command sheet, const std::string& device);

}  // namespace relevo::viewer

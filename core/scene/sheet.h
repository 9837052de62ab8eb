#pragma once

#include <filesystem>
#include <string>

#include <glm/vec2.hpp>

#include "dem/grid.h"
#include "scene/map_view.h"

/// Maps on paper: sizes of sheets, and maps at a scale 1 : n.
namespace relevo::scene {

/// @throws Error (BadInput) for what no map sheet can be, and for its options without one
/// @param output  the picture's file; empty: none
void check_sheet(const Scene& scene, const std::filesystem::path& output);

/// Whether a file of that name is a PDF, which only map sheets can be.
bool is_pdf(const std::filesystem::path& path);

/// Size of a scene's sheet. Without a direction in its name it lies or stands as the DEM does.
glm::dvec2 sheet_mm(const Sheet& sheet, const dem::Grid& grid);
/// The same at its dpi [px].
/// @throws Error (BadInput) if it takes more than 1 GiB
glm::ivec2 sheet_px(const Sheet& sheet, const dem::Grid& grid);

/// Pixels of a unit of what is stamped around the map (chart::stamp_scale() of other pictures):
/// letters of 11 units are 7.7 points on A4, and grow by the root of the sheet's shorter side.
double sheet_unit_px(const Sheet& sheet);
/// White edge of a sheet, where printers do not print: 5 mm of A4.
double sheet_edge_px(const Sheet& sheet);

/// The smallest round n (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6 or 7.5 times a power of ten) at which a
/// DEM fits into a room.
double fitting_scale(const dem::Grid& grid, double dpi, const glm::ivec2& room_px);

/// Size of the map at 1 : n within a room [px]: all of the DEM, or as much as there is room for.
/// @throws Error (BadInput) if the DEM is smaller than 16 px, or a post is larger than the room
glm::ivec2 sheet_map_px(const dem::Grid& grid, double scale, double dpi, const glm::ivec2& room_px);

/// The map at 1 : n about the DEM's middle, where its scale is true: pixels are as wide as they are
/// tall on the ground there. In degrees it is equirectangular.
MapArea sheet_area(const dem::Grid& grid, double scale, double dpi, const glm::ivec2& size_px);

/// "1 : 25 000".
std::string scale_text(double scale);

/// For people: "WGS 84 / UTM zone 32N", "equirectangular, true at 47.2°N, WGS 84".
std::string projection_text(const dem::Grid& grid);

}  // namespace relevo::scene

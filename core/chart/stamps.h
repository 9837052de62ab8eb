#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "chart/legend.h"
#include "image/image.h"

namespace relevo::chart {

/// What is put on a finished picture. Places are pixels, from the upper left corner.
struct Stamps {
    struct Scale {
        double px_per_m = 0;
        std::string where;    ///< where it holds: "at the picture's middle"; empty: everywhere
        std::string ratio{};  ///< "1 : 25 000", of maps on paper
    };
    /// A line of the graticule, where it ends in the picture.
    struct Label {
        glm::dvec2 at_px{0};
        glm::dvec2 away{0, 1};  ///< unit: from the line into the open
        std::string words;      ///< "47°30'N"
    };
    std::string title;
    std::vector<Legend> legends;
    std::optional<Scale> scale;
    std::optional<glm::dvec2> north;  ///< unit, right and down: where it points in the picture
    std::vector<std::string> lines;   ///< date, sun and exaggeration
    bool bare_lines = false;  ///< small and without a panel, for pictures without other stamps
    std::string attribution;
    std::vector<Label> graticule;
};

/// A length that a bar of at most so many pixels shows, 1, 2 or 5 times a power of ten metres.
struct ScaleBar {
    double length_m, length_px;
    std::string text() const;  ///< "2 km", "50 m", "20 cm"
};
ScaleBar scale_bar(double px_per_m, double most_px);

/// Pixels of a unit of what is stamped: letters are 11 units tall.
double stamp_scale(int width_px, int height_px);

/// Room around a map [px].
struct Margins {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// The room that stamps take around a map: title above, legends on the right, the others below.
/// @param stamps  with a scale, north and the longest label of the graticule, if there will be any
/// @param width_px, height_px  of the whole picture
Margins margins_for(const Stamps& stamps, int width_px, int height_px);
/// The same with another stamp_scale().
Margins margins_for(const Stamps& stamps, int width_px, double unit_px);

/// Where stamps stand in a picture: a picture and a PDF are drawn from the same.
struct LaidStamps {
    std::vector<Placed> drawings;
    std::vector<Rect> taken;  ///< by them and by labels of the graticule [px]
    /// What had no room: "title", "legend", "scale", "north", "date and sun", "attribution",
    /// "2 labels of the graticule".
    std::vector<std::string> missing;
};

/// Gives each stamp a place, whole and over none of the others.
/// @param size_px  of the picture
/// @param unit_px  as stamp_scale()
/// @param map      where the map is in the picture: they stand around it. nullopt: in the corners
///     of the picture
LaidStamps lay_out(const Stamps& stamps, const glm::ivec2& size_px, double unit_px,
                   const std::optional<Rect>& map = std::nullopt);

/// Puts them on a picture, RGB: lay_out() and paint().
/// @param taken  if not null, receives LaidStamps::taken
/// @returns LaidStamps::missing
/// @throws Error (Failed) as paint()
std::vector<std::string> stamp(const Stamps& stamps, image::Image8& picture,
                               std::vector<Rect>* taken = nullptr,
                               const std::optional<Rect>& map = std::nullopt);

}  // namespace relevo::chart

#include "session/panorama_parts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "base/units.h"

// Faces of a cube were rejected: their pixels are up to three times finer at the corners, so that
// lines and full-screen effects would be thinner there.
namespace relevo::session {
namespace {

constexpr double kPart_rad = radians(kPart_deg);
/// Narrower parts are not made for the sake of smaller frames.
constexpr int kFewest_px = 64;

/// Where a part begins, of so many along an axis.
int cut(int length_px, int part, int parts) {
    return static_cast<int>(std::int64_t{length_px} * part / parts);
}

/// A camera that looks along an azimuth and an elevation, upright.
glm::dmat3 axes_of(double azimuth, double elevation) {
    const glm::dvec3 level(std::sin(azimuth), std::cos(azimuth), 0), up(0, 0, 1);
    const glm::dvec3 right(std::cos(azimuth), -std::sin(azimuth), 0);
    return {right, std::cos(elevation) * up - std::sin(elevation) * level,
            std::cos(elevation) * level + std::sin(elevation) * up};
}

/// Points along the border of a rectangle, in which all that it maps to lies.
template <typename Visit>
void along_border(const PictureRect& rect, const Visit& visit) {
    constexpr int kSteps = 64;
    const glm::dvec2 low(rect.corner), size(rect.size);
    for (int i = 0; i <= kSteps; ++i) {
        const double at = static_cast<double>(i) / kSteps;
        for (const double side : {0.0, 1.0}) {
            visit(low + size * glm::dvec2(at, side));
            visit(low + size * glm::dvec2(side, at));
        }
    }
}

PanoramaPart part_of(const scene::PanoramaMap& map, const PictureRect& rect, bool level,
                     int margin_px) {
    const glm::dvec2 middle = glm::dvec2(rect.corner) + 0.5 * glm::dvec2(rect.size);
    PanoramaPart part{.rect = rect};
    part.axes = axes_of(map.azimuth_rad(middle.x), level ? 0 : map.elevation_rad(middle.y));
    // In pixels from the optical axis, right and up.
    glm::dvec2 low(1e300), high(-1e300);
    along_border(rect, [&](const glm::dvec2& at_px) {
        const glm::dvec3 seen = transpose(part.axes) * map.direction(at_px);
        const glm::dvec2 at = map.px_per_rad() * glm::dvec2(seen) / seen.z;
        low = min(low, at);
        high = max(high, at);
    });
    low = floor(low) - double(margin_px);
    high = ceil(high) + double(margin_px);
    const glm::ivec2 half(max(abs(low), abs(high)));
    part.picture_px = 2 * half;
    part.frame = {glm::ivec2(low) + half, glm::ivec2(high - low)};
    part.fov_y_rad = 2 * std::atan(half.y / map.px_per_rad());
    return part;
}

}  // namespace

glm::dvec2 PanoramaPart::project(const glm::dvec3& direction, double px_per_rad) const {
    const glm::dvec3 seen = transpose(axes) * direction;
    const glm::dvec2 at = 0.5 * glm::dvec2(picture_px) + px_per_rad * glm::dvec2(seen) / seen.z -
                          glm::dvec2(frame.corner);
    return {at.x, frame.size.y - at.y};
}

std::vector<PanoramaPart> parts_of(const scene::PanoramaMap& map, int margin_px, double most_px,
                                   int max_side_px) {
    const glm::ivec2 size = map.picture_px();
    const bool level = !map.is_equirectangular();
    const double across_rad = size.x / map.px_per_rad(), down_rad = size.y / map.px_per_rad();
    const int bands = level ? 1 : static_cast<int>(std::ceil(down_rad / kPart_rad - 1e-9));
    std::vector<PanoramaPart> parts;
    for (int band = 0; band < bands; ++band) {
        const int top = cut(size.y, band, bands), bottom = cut(size.y, band + 1, bands);
        const double upper = map.elevation_rad(top), lower = map.elevation_rad(bottom);
        // Of the band's longest row.
        const double nearest =
            level || upper * lower <= 0 ? 0 : std::min(std::abs(upper), std::abs(lower));
        int columns = std::max(
            1, static_cast<int>(std::ceil(across_rad * std::cos(nearest) / kPart_rad - 1e-9)));
        const auto at = [&](int column) {
            const int left = cut(size.x, column, columns);
            return part_of(map,
                           {{left, top}, {cut(size.x, column + 1, columns) - left, bottom - top}},
                           level, margin_px);
        };
        const auto pixels = [&](const glm::ivec2& frame) { return double{1} * frame.x * frame.y; };
        while (pixels(at(0).frame.size) > most_px && size.x / columns > kFewest_px)
            ++columns;
        for (int column = 0; column < columns; ++column) {
            parts.push_back(at(column));
            const glm::ivec2 frame = parts.back().frame.size;
            if (std::max(frame.x, frame.y) > max_side_px)
                bad_input(fmt::format(
                    "--panorama: {} x {} px need frames of {} px a side, more than the {} that "
                    "this device draws; use a smaller --size",
                    size.x, size.y, std::max(frame.x, frame.y), max_side_px));
        }
    }
    return parts;
}

}  // namespace relevo::session

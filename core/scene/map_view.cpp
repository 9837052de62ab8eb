#include "scene/map_view.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "scene/scene.h"
#include "scene/sheet.h"

// Rejected: an orthographic camera in the local frame, because the ground of a CRS is neither flat
// nor evenly scaled there (the corners of a degree at 47 N are off by hundreds of metres); and
// resampling a perspective picture. Maps of rotated DEMs are north-up, because many programs
// ignore rotated georeferences. Skirts draw the outermost half cells, so that a map has the edges
// of its source.
namespace relevo::scene {
namespace {

/// Bounding box of all cells, in the CRS.
struct Extent {
    glm::dvec2 low{1e300}, high{-1e300};

    glm::dvec2 sides() const { return high - low; }
};

Extent extent_of(const dem::Grid& grid) {
    Extent extent;
    for (const double column : {-0.5, grid.columns() - 0.5})
        for (const double row : {-0.5, grid.rows() - 0.5}) {
            const glm::dvec2 corner = grid.affine()(column, row);
            extent.low = glm::min(extent.low, corner);
            extent.high = glm::max(extent.high, corner);
        }
    return extent;
}

}  // namespace

MapArea map_area(const dem::Grid& grid, double pixel, const glm::ivec2& size_px) {
    const Extent extent = extent_of(grid);
    const glm::dvec2 side = pixel > 0 ? glm::dvec2(pixel) : extent.sides() / glm::dvec2(size_px);
    return {extent.low.x, extent.high.y, side.x, side.y, size_px.x, size_px.y};
}

glm::ivec2 map_size(const dem::Grid& grid, double pixel, const glm::ivec2& room_px) {
    const glm::dvec2 sides = extent_of(grid).sides(), room(room_px);
    const auto size_of = [&](double square) {
        return glm::max(glm::round(sides / square), glm::dvec2(1));
    };
    if (pixel > 0) {
        const glm::dvec2 size = size_of(pixel);
        if (std::max(size.x, size.y) > kMaxSide_px)
            bad_input(fmt::format(
                "--resolution: pixels of {:.10g} make a map of {:.0f} x {:.0f}; expected "
                "sides of at most {} px, use a larger one",
                pixel, size.x, size.y, kMaxSide_px));
        return glm::ivec2(size);
    }
    // A size that has been fitted before stays.
    for (const double square : {sides.x / room.x, sides.y / room.y})
        if (size_of(square) == room) return room_px;
    return glm::ivec2(size_of(std::max(sides.x / room.x, sides.y / room.y)));
}

void fit_map(Scene& scene, const dem::Grid& grid) {
    if (!scene.ortho && scene.resolution > 0)
        bad_input("--resolution: needs --ortho; --size is the size of other pictures");
    if (!scene.ortho) return;
    if (scene.sheet.is_on()) {
        const glm::ivec2 size = sheet_px(scene.sheet, grid);
        scene.width_px = size.x;
        scene.height_px = size.y;
        return;
    }
    if (scene.stamps.margin) {
        if (scene.resolution > 0)
            bad_input("--margin and --resolution exclude each other; use --size");
        return;  // the map is as large as its margins allow
    }
    const glm::ivec2 size = map_size(grid, scene.resolution, {scene.width_px, scene.height_px});
    scene.width_px = size.x;
    scene.height_px = size.y;
}

MapView::MapView(dem::Grid grid, const geo::LocalFrame& frame, const MapArea& area)
    : grid_(std::move(grid)), frame_(frame), area_(area) {}

glm::dvec2 MapView::post(const glm::dvec2& at_px) const {
    return grid_.affine().inverse(area_.point(at_px));
}

glm::dvec2 MapView::pixel(const glm::dvec2& post) const {
    const glm::dvec2 point = grid_.affine()(post.x, post.y);
    return {(point.x - area_.left) / area_.pixel_x, (area_.top - point.y) / area_.pixel_y};
}

glm::dvec2 MapView::pixel_of(const glm::dvec3& point_m) const {
    return pixel(grid_.post(frame_.to_geodetic(point_m)));
}

glm::dvec3 MapView::point_m(const glm::dvec2& at_px, double height_m) const {
    const glm::dvec2 at = post(at_px);
    geo::Geodetic place = grid_.place(at.x, at.y);
    place.height_m = height_m;
    return frame_.to_local(place);
}

glm::dvec3 MapView::up(const glm::dvec2& at_px) const {
    const glm::dvec2 at = post(at_px);
    const geo::Geodetic place = grid_.place(at.x, at.y);
    return frame_.up(place.lat_rad, place.lon_rad);
}

glm::dvec2 MapView::pixel_m(const glm::dvec2& at_px) const {
    const auto step_m = [&](const glm::dvec2& half) {
        return length(point_m(at_px + half, 0) - point_m(at_px - half, 0));
    };
    return {step_m({0.5, 0}), step_m({0, 0.5})};
}

Camera map_camera(const dem::Grid& grid, const geo::LocalFrame& frame, const MapArea& area) {
    const auto map = std::make_shared<const MapView>(grid, frame, area);
    const glm::dvec2 middle = 0.5 * map->size_px();
    const glm::dvec2 half_m = middle * map->pixel_m(middle);
    const double height_m = kMapEye * std::max(half_m.x, half_m.y);
    Camera camera;
    camera.forward = -map->up(middle);
    camera.eye_m = map->point_m(middle, height_m);
    const glm::dvec3 upwards =
        map->point_m(middle - glm::dvec2(0, 0.5), 0) - map->point_m(middle + glm::dvec2(0, 0.5), 0);
    camera.up = normalize(upwards - dot(upwards, camera.forward) * camera.forward);
    camera.fov_y_rad = 2 * std::atan(half_m.y / height_m);
    camera.map_aspect = half_m.x / half_m.y;
    camera.map = map;
    return camera;
}

}  // namespace relevo::scene

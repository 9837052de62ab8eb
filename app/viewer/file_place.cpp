#include "viewer/file_place.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "dem/lines.h"
#include "dem/places.h"
#include "names/summit_top.h"
#include "overlay/band_over.h"
#include "viewer/find_sheet.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// Corners, edges and inner places of a grid.
std::vector<geo::Geodetic> places_all_over(const dem::Grid& grid) {
    constexpr int kSide = 9;
    std::vector<geo::Geodetic> places;
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column)
            places.push_back(grid.place((grid.columns() - 1.0) * column / (kSide - 1),
                                        (grid.rows() - 1.0) * row / (kSide - 1)));
    return places;
}

/// Those of an image, and those of the DEM that the image covers: either may be far larger.
std::vector<geo::Geodetic> places_of_image(const std::string& path, const dem::Grid& dem) {
    const dem::Grid image = overlay::grid_of_raster(path);
    std::vector<geo::Geodetic> places = places_all_over(image);
    for (const geo::Geodetic& place : places_all_over(dem))
        if (names::is_on(image, place)) places.push_back(place);
    return places;
}

std::vector<geo::Geodetic> places_in(FileKind kind, const std::string& path, const dem::Grid& dem) {
    std::vector<geo::Geodetic> places;
    if (kind == FileKind::Places) {
        for (const dem::NamedPlace& place : dem::read_points(path, "open"))
            places.push_back(place.at.place);
    } else if (kind == FileKind::Lines) {
        for (const dem::PlacedLine& line : dem::read_lines(path, "open", "", dem))
            for (const glm::dvec2& post : line.posts)
                places.push_back(dem.place(post.x, post.y));
    } else {
        places = places_of_image(path, dem);
    }
    return places;
}

}  // namespace

geo::Geodetic FilePlace::middle() const {
    // The mean itself may lie beside a track that bends.
    glm::dvec3 mean(0);
    const auto on_sphere = [](const geo::Geodetic& place) {
        return glm::dvec3(std::cos(place.lat_rad) * std::cos(place.lon_rad),
                          std::cos(place.lat_rad) * std::sin(place.lon_rad),
                          std::sin(place.lat_rad));
    };
    for (const geo::Geodetic& place : on_dem)
        mean += on_sphere(place) / static_cast<double>(on_dem.size());
    return *std::ranges::min_element(on_dem, {}, [&](const geo::Geodetic& place) {
        return glm::distance(on_sphere(place), mean);
    });
}

FilePlace place_of_file(FileKind kind, const std::string& path, const dem::Grid& dem) {
    FilePlace place;
    for (geo::Geodetic& each : places_in(kind, path, dem)) {
        ++place.parts;
        each.height_m = 0;
        if (names::is_on(dem, each)) place.on_dem.push_back(each);
    }
    return place;
}

std::string words_of(const FilePlace& place, FileKind kind, const dem::Grid& dem) {
    if (place.on_dem.empty()) return tr("outside the DEM");
    const std::string way = way_text(place.middle(), dem);
    if (kind == FileKind::Places)
        return tr_format("{} of {} places are on the DEM, around {}", place.on_dem.size(),
                         place.parts, way);
    return tr_format("on the DEM around {}", way);
}

OutsideWork::OutsideWork(std::function<void()> on_change)
    : LatestWork(std::move(on_change),
                 [](const LayerFiles& of, const LayerFiles& now) { return of.dem == now.dem; }) {}

void OutsideWork::work_out(const LayerFiles* wanted) {
    if (!wanted || !wanted->dem) return;
    auto outside = std::make_shared<FilesOutside>(FilesOutside{.of = *wanted});
    for (const auto& [kind, path] : wanted->files) {
        if (is_given_up()) return;
        try {
            if (place_of_file(kind, path, wanted->dem->source->grid()).on_dem.empty())
                outside->files.insert(path);
        } catch (const std::exception&) {
            // The effect itself says what is wrong with its file.
        }
    }
    publish(outside, /*done=*/true);
}

}  // namespace relevo::viewer

#include "overlay/band_around.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/interpret.h"
#include "dem/places_over.h"
#include "geo/local_frame.h"
#include "overlay/band_over.h"

namespace relevo::overlay {
namespace {

constexpr int kSide = 33;          // places along a side, of the DEM and of what is around it
constexpr int kMostValues = 1024;  // along a side

struct Box {
    glm::dvec2 least{std::numeric_limits<double>::max()};
    glm::dvec2 most{std::numeric_limits<double>::lowest()};

    void add(const glm::dvec2& place) {
        least = glm::min(least, place);
        most = glm::max(most, place);
    }
};

/// Seen from far above the DEM's centre: x and y are those of the local frame for points of the
/// ellipsoid. Source: EPSG guidance note 7-2, method 9840.
geo::Crs local_crs(const geo::Geodetic& origin) {
    return geo::Crs::parse(fmt::format("+proj=ortho +lat_0={:.12f} +lon_0={:.12f} +ellps=WGS84 "
                                       "+units=m +type=crs",
                                       degrees(origin.lat_rad), degrees(origin.lon_rad)),
                           "field");
}

/// Posts at a square net of places. @param step_m  from place to place
dem::Grid net(const geo::Crs& crs, const glm::dvec2& first_m, const glm::dvec2& step_m,
              const glm::ivec2& count) {
    return {count.x, count.y, {first_m.x, step_m.x, 0, first_m.y, 0, step_m.y}, crs};
}

/// Where values are wanted, and how close [m].
struct Wanted {
    Box box;
    double step_m = 1;
};

/// The DEM, and what of its surroundings a raster covers.
Wanted wanted(const dem::Grid& raster, const geo::Crs& crs, const Box& dem) {
    const glm::dvec2 centre = 0.5 * (dem.least + dem.most);
    const glm::dvec2 around_m = glm::max(dem.most - centre, glm::dvec2(kAround_m));
    const glm::dvec2 step = 2.0 * around_m / double{kSide - 1};
    const dem::Grid places = net(crs, centre - around_m, step, {kSide, kSide});
    const dem::PlacesOver cells(places, raster, {.count = {kSide, kSide}});
    Wanted wanted{.box = dem};
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const glm::dvec2 at = cells(column, row);
            if (!(at.x >= -1 && at.y >= -1 && at.x <= raster.columns() && at.y <= raster.rows()))
                continue;
            const glm::dvec2 place = places.affine()(column, row);
            wanted.box.add(glm::max(place - step, centre - around_m));
            wanted.box.add(glm::min(place + step, centre + around_m));
        }
    // A hundredth of the net's step, so that the cells on the way are alike.
    const glm::dvec2 near_m = glm::max(0.01 * step, glm::dvec2(1));
    const dem::Grid near = net(crs, centre, near_m, {2, 2});
    const dem::PlacesOver at(near, raster, {.count = {2, 2}});
    const double cells_east = glm::length(at(1, 0) - at(0, 0)),
                 cells_north = glm::length(at(0, 1) - at(0, 0));
    const double step_m = std::min(near_m.x / cells_east, near_m.y / cells_north);
    wanted.step_m = step_m > 0 ? step_m : near_m.x;  // no number where the raster is elsewhere
    return wanted;
}

}  // namespace

float ValuesAround::at(const glm::dvec2& place_m) const {
    const glm::dvec2 cell = (place_m - first_m) / step_m;
    const glm::dvec2 first = glm::floor(cell);
    double sum = 0, weights = 0;
    for (int i = 0; i < 4; ++i) {
        const glm::ivec2 of = glm::ivec2(first) + glm::ivec2(i & 1, i >> 1);
        if (of.x < 0 || of.y < 0 || of.x >= values.width() || of.y >= values.height()) continue;
        const float value = values.at(of.x, of.y);
        if (std::isnan(value)) continue;
        const glm::dvec2 w = 1.0 - glm::abs(cell - glm::dvec2(of));
        sum += w.x * w.y * double{value};
        weights += w.x * w.y;
    }
    return weights > 0 ? static_cast<float>(sum / weights)
                       : std::numeric_limits<float>::quiet_NaN();
}

std::vector<glm::dvec2> places_over_dem(const dem::Grid& dem) {
    const geo::LocalFrame frame(dem.center());
    std::vector<glm::dvec2> places;
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const geo::Geodetic at =
                dem.place(double{1} * column * (dem.columns() - 1) / (kSide - 1),
                          double{1} * row * (dem.rows() - 1) / (kSide - 1));
            if (!std::isnan(at.lat_rad)) places.emplace_back(frame.to_local(at));
        }
    return places;
}

ValuesAround read_band_around(const dem::Grid& dem, const std::string& path, int band) {
    const dem::Grid raster = grid_of_raster(path);
    const geo::Crs crs = local_crs(dem.center());
    const std::vector<glm::dvec2> over_dem = places_over_dem(dem);
    Box box;
    for (const glm::dvec2& place : over_dem)
        box.add(place);
    const Wanted want = wanted(raster, crs, box);
    const glm::dvec2 size_m = want.box.most - want.box.least;
    const auto along = [&](double side_m) {
        return std::clamp(static_cast<int>(std::ceil(side_m / want.step_m)) + 1, 2, kMostValues);
    };
    const glm::ivec2 count(along(size_m.x), along(size_m.y));
    ValuesAround around{.first_m = want.box.least, .step_m = size_m / glm::dvec2(count - 1)};
    around.values =
        read_band_over(net(crs, around.first_m, around.step_m, count), path, band).values;
    if (std::ranges::all_of(over_dem,
                            [&](const glm::dvec2& at) { return std::isnan(around.at(at)); }))
        dem::refuse(path,
                    fmt::format("the raster has no value over this DEM; it is at {}, the DEM at {}",
                                extent_text(raster), extent_text(dem)));
    return around;
}

}  // namespace relevo::overlay

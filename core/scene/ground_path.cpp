#include "scene/ground_path.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "scene/series.h"
#include "scene/spline.h"

namespace relevo::scene {
namespace {

constexpr double kSame_m = 0.01;

geo::Geodetic first_of(std::span<const geo::Geodetic> places) {
    if (places.empty()) bad_input("expected two places or more but got none");
    for (std::size_t i = 0; i < places.size(); ++i)
        if (!std::isfinite(places[i].lon_rad) || !(std::abs(places[i].lat_rad) <= kPi / 2))
            bad_input(fmt::format("expected places but number {} is {},{}", i + 1,
                                  degrees(places[i].lat_rad), degrees(places[i].lon_rad)));
    return {places.front().lat_rad, places.front().lon_rad, 0};
}

/// Points at equal distances along a polyline, its ends included.
std::vector<glm::dvec3> evenly(const std::vector<glm::dvec3>& line, std::size_t count,
                               double& step_m) {
    std::vector<double> along_m{0};
    for (std::size_t i = 1; i < line.size(); ++i)
        along_m.push_back(along_m.back() + distance(line[i - 1], line[i]));
    step_m = along_m.back() / static_cast<double>(count - 1);
    std::vector<glm::dvec3> result;
    result.reserve(count);
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double wanted_m = step_m * static_cast<double>(i);
        while (at + 2 < line.size() && along_m[at + 1] < wanted_m)
            ++at;
        const double length_m = along_m[at + 1] - along_m[at];
        const double share = length_m > 0 ? std::min((wanted_m - along_m[at]) / length_m, 1.0) : 0;
        result.push_back(line[at] + share * (line[at + 1] - line[at]));
    }
    return result;
}

/// A dense polyline of a curve through points.
std::vector<glm::dvec3> curve_through(const std::vector<glm::dvec3>& points, double step_m) {
    std::vector<std::array<double, 3>> given;
    std::vector<double> lengths_m;
    for (const glm::dvec3& point : points) {
        if (!given.empty()) lengths_m.push_back(distance(points[given.size() - 1], point));
        given.push_back({point.x, point.y, point.z});
    }
    const CentripetalSpline<3> spline(std::move(given), lengths_m);
    std::vector<glm::dvec3> line{points.front()};
    for (std::size_t i = 0; i < spline.segments(); ++i) {
        const int pieces = std::max(1, static_cast<int>(std::ceil(lengths_m[i] / step_m)));
        for (int piece = 1; piece <= pieces; ++piece) {
            const auto point = spline.at(i, static_cast<double>(piece) / pieces);
            line.emplace_back(point[0], point[1], point[2]);
        }
    }
    return line;
}

std::vector<glm::dvec3> smoothed_points(const std::vector<glm::dvec3>& points, std::size_t radius) {
    std::vector<glm::dvec3> result = points;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        values.reserve(points.size());
        for (const glm::dvec3& point : points)
            values.push_back(point[axis]);
        values = smoothed(values, radius, Ends::Mirrored);
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i][axis] = values[i];
    }
    return result;
}

}  // namespace

GroundPath::GroundPath(std::span<const geo::Geodetic> places, double smoothing_m)
    : frame_(first_of(places)) {
    std::vector<glm::dvec3> points;
    double length_m = 0;
    for (const geo::Geodetic& place : places) {
        const glm::dvec3 point = frame_.to_local({place.lat_rad, place.lon_rad, 0});
        const double step_m = points.empty() ? 1 : distance(points.back(), point);
        if (step_m < kSame_m) continue;
        if (!points.empty()) length_m += step_m;
        points.push_back(point);
    }
    if (points.size() < 2)
        bad_input(fmt::format("expected two different places or more but got {}",
                              places.size() == 1 ? "one" : "the same one again"));
    constexpr double kFewest = 256, kMost = 50'000;
    const double fine_m =
        std::max(length_m / kMost, std::min(smoothing_m / 16, length_m / kFewest));
    std::vector<glm::dvec3> line = curve_through(points, fine_m);
    for (glm::dvec3& point : line)
        point = on_ellipsoid(point);
    const auto count = static_cast<std::size_t>(std::ceil(length_m / fine_m)) + 1;
    points_m_ = evenly(line, count, step_m_);
    // A line is longer for its noise, so that noise is smoothed over less of it: until that is
    // gone.
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
        const double before_m = step_m_;
        const auto radius = static_cast<std::size_t>(smoothing_m / step_m_);
        line = smoothed_points(points_m_, std::min(radius, count / 3));
        for (glm::dvec3& point : line)
            point = on_ellipsoid(point);
        points_m_ = evenly(line, count, step_m_);
        if (step_m_ > 0.95 * before_m) break;
    }
}

glm::dvec3 GroundPath::on_ellipsoid(const glm::dvec3& point_m) const {
    geo::Geodetic place = frame_.to_geodetic(point_m);
    place.height_m = 0;
    return frame_.to_local(place);
}

geo::Geodetic GroundPath::at(double along_m) const {
    const auto count = static_cast<std::ptrdiff_t>(points_m_.size());
    // Beyond an end, the straight line of its first or last steps.
    const auto point = [&](std::ptrdiff_t i) {
        const std::ptrdiff_t end = std::clamp<std::ptrdiff_t>(i, 0, count - 1);
        const glm::dvec3& at_end = points_m_[static_cast<std::size_t>(end)];
        if (end == i) return at_end;
        const glm::dvec3& inside = points_m_[static_cast<std::size_t>(end == 0 ? 1 : count - 2)];
        return at_end + static_cast<double>(std::abs(i - end)) * (at_end - inside);
    };
    const double steps = along_m / step_m_;
    const auto cell = static_cast<std::ptrdiff_t>(std::floor(steps));
    const double t = steps - static_cast<double>(cell);
    const glm::dvec3 p0 = point(cell - 1), p1 = point(cell), p2 = point(cell + 1),
                     p3 = point(cell + 2);
    const glm::dvec3 at_m =
        p1 +
        0.5 * t *
            (p2 - p0 + t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + t * (3.0 * (p1 - p2) + p3 - p0)));
    geo::Geodetic place = frame_.to_geodetic(at_m);
    place.height_m = 0;
    return place;
}

}  // namespace relevo::scene

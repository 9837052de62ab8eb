#include "session/graticule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "base/units.h"

namespace relevo::session {
namespace {

constexpr int kMostLines = 7;
constexpr double kNarrow = 6, kWide = 14;  // distance of lines, in stamp units: invisible, opaque
constexpr double kHalf = 0.55, kHalfEdge = 1.3;  // half widths in stamp units
constexpr double kOnPaper = 0.8;  // width of a line in half widths: thinner than on screens
constexpr float kLineOpacity = 0.85f, kEdgeOpacity = 0.35f;

constexpr std::array<int, 18> kSteps_s = {1,   2,   5,    10,   15,   30,    60,    120,   300,
                                          600, 900, 1800, 3600, 7200, 18000, 36000, 54000, 108000};

/// A coordinate at each pixel [degrees]; NaN without ground.
using Field = Array2d<double>;

struct Places {
    Field latitude, longitude;
};

/// Longitudes are within 180 degrees of the frame's origin, hence continuous.
Places places_of(const SeenGround& seen, const geo::LocalFrame& frame) {
    const Field none(seen.width_px(), seen.height_px(), std::numeric_limits<double>::quiet_NaN());
    Places places{none, none};
    const double middle_deg = degrees(frame.origin().lon_rad);
    parallel_for(0, seen.height_px(), 8, [&](int first, int end) {
        for (int y = first; y < end; ++y)
            for (int x = 0; x < seen.width_px(); ++x) {
                const auto point = seen.point(x, y);
                if (!point) continue;
                const geo::Geodetic place = frame.to_geodetic(*point);
                places.latitude.at(x, y) = degrees(place.lat_rad);
                places.longitude.at(x, y) =
                    middle_deg + std::remainder(degrees(place.lon_rad) - middle_deg, 360);
            }
    });
    return places;
}

double range_of(const Field& field) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : field) {
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    return std::max(high - low, 0.0);
}

/// Change of a coordinate per pixel. The smaller of the two neighbours' differences counts, because
/// the other neighbour may lie behind a silhouette.
double change_at(const Field& field, int x, int y) {
    const auto at = [&](int column, int row) {
        return column < 0 || row < 0 || column >= field.width() || row >= field.height()
                   ? std::numeric_limits<double>::quiet_NaN()
                   : field.at(column, row);
    };
    const double here = at(x, y);
    const auto least = [](double a, double b) { return std::isnan(a) || b < a ? b : a; };
    const double across = least(std::abs(at(x - 1, y) - here), std::abs(at(x + 1, y) - here));
    const double down = least(std::abs(at(x, y - 1) - here), std::abs(at(x, y + 1) - here));
    return std::hypot(std::isnan(across) ? 0 : across, std::isnan(down) ? 0 : down);
}

/// Extent of one line in the image.
struct Course {
    glm::ivec2 left{0}, right{0}, top{0}, bottom{0};  // its outermost pixels
};

using Courses = std::map<long, Course>;  // key: multiple of the step

void note(Courses& courses, long number, const glm::ivec2& at) {
    const auto [found, fresh] = courses.try_emplace(number, Course{at, at, at, at});
    if (fresh) return;
    Course& course = found->second;
    if (at.x < course.left.x) course.left = at;
    if (at.x > course.right.x) course.right = at;
    if (at.y < course.top.y) course.top = at;
    if (at.y > course.bottom.y) course.bottom = at;
}

/// Draws the parallels or the meridians, and returns their extents.
template <typename IsGround>
Courses draw(const Field& field, double step_deg, const SeenGround& seen, const IsGround& is_ground,
             Graticule& result) {
    const int width = seen.width_px(), height = seen.height_px();
    const double unit = chart::stamp_scale(width, height);
    Courses courses;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (std::isnan(field.at(x, y))) continue;
            const double value = field.at(x, y) / step_deg;
            const double away = std::abs(value - std::round(value));
            const double change = change_at(field, x, y) / step_deg;
            if (away > change * (kHalfEdge * unit + 0.5)) continue;
            const double wide =
                std::clamp((1 / change / unit - kNarrow) / (kWide - kNarrow), 0.0, 1.0);
            if (wide <= 0 || !is_ground(*seen.point(x, y))) continue;
            const double away_px = away / change;
            const auto share = [&](double half) {
                return static_cast<float>(wide * std::clamp(half * unit + 0.5 - away_px, 0.0, 1.0));
            };
            const auto raise = [&](float& opacity, float to) { opacity = std::max(opacity, to); };
            raise(result.line.at(x, y), kLineOpacity * share(kHalf));
            raise(result.edge.at(x, y), kEdgeOpacity * share(kHalfEdge));
            // A line between two rows is half a pixel from both.
            if (away_px <= 0.501 && wide >= 1) note(courses, std::lround(value), {x, y});
        }
    return courses;
}

/// "47°30'"; the angle is not negative.
std::string angle_text(double angle_deg, double step_deg) {
    const auto whole_s = static_cast<long>(std::lround(angle_deg * 3600));
    const auto step_s = static_cast<long>(std::lround(step_deg * 3600));
    std::string text = fmt::format("{}°", whole_s / 3600);
    if (step_s % 3600 != 0) text += fmt::format("{:02}'", whole_s / 60 % 60);
    if (step_s % 60 != 0) text += fmt::format("{:02}\"", whole_s % 60);
    return text;
}

/// Labels horizontal lines at their left end, vertical ones at their bottom end.
void name(const Courses& courses, double step_deg, std::string (*text)(double, double),
          std::vector<chart::Stamps::Label>& labels) {
    for (const auto& [number, course] : courses) {
        const int wide = course.right.x - course.left.x, tall = course.bottom.y - course.top.y;
        const bool across = wide > tall;
        const glm::ivec2 end = across ? course.left : course.bottom;
        const glm::ivec2 other = across ? course.right : course.top;
        glm::dvec2 away = across ? glm::dvec2(-1, 0) : glm::dvec2(0, 1);
        if (end != other) away = glm::normalize(glm::dvec2(end - other));
        labels.push_back(
            {glm::dvec2(end) + 0.5, away, text(static_cast<double>(number) * step_deg, step_deg)});
    }
}

/// Latitudes and longitudes of a map [degrees], from a sample of its places. Longitudes are within
/// 180 degrees of its middle.
struct MapRange {
    glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-low};
    double middle_deg;

    explicit MapRange(const scene::MapView& map) {
        constexpr int kSamples = 64;
        const auto place = [&](double across, double down) {
            const glm::dvec2 post = map.post(glm::dvec2(across, down) * map.size_px());
            return map.grid().place(post.x, post.y);
        };
        middle_deg = degrees(place(0.5, 0.5).lon_rad);
        for (int i = 0; i <= kSamples; ++i)
            for (int j = 0; j <= kSamples; ++j) {
                const geo::Geodetic at = place(double(i) / kSamples, double(j) / kSamples);
                const glm::dvec2 here(
                    degrees(at.lat_rad),
                    middle_deg + std::remainder(degrees(at.lon_rad) - middle_deg, 360));
                if (std::isnan(here.x + here.y)) continue;
                low = glm::min(low, here);
                high = glm::max(high, here);
            }
    }
};

/// The part of a line that is in a map. Source: Y.-D. Liang and B. Barsky, ACM Transactions on
/// Graphics 3 (1984), 1.
std::optional<std::pair<glm::dvec2, glm::dvec2>> within(const glm::dvec2& from,
                                                        const glm::dvec2& to,
                                                        const glm::dvec2& size_px) {
    double begin = 0, end = 1;
    const glm::dvec2 way = to - from;
    for (const int axis : {0, 1})
        for (const bool is_high : {false, true}) {
            const double step = is_high ? way[axis] : -way[axis];
            const double room = is_high ? size_px[axis] - from[axis] : from[axis];
            if (step == 0 && room < 0) return std::nullopt;
            if (step > 0) end = std::min(end, room / step);
            if (step < 0) begin = std::max(begin, room / step);
        }
    if (!(begin < end)) return std::nullopt;
    return std::pair(from + begin * way, from + end * way);
}

/// A parallel or a meridian in a map: its pieces, with NaN between them.
/// @param place_at  from 0 to 1
template <typename PlaceAt>
std::vector<glm::dvec2> line_of(const scene::MapView& map, const PlaceAt& place_at) {
    constexpr int kPoints = 512;
    const glm::dvec2 size = map.size_px(), none(std::numeric_limits<double>::quiet_NaN());
    std::vector<glm::dvec2> line;
    glm::dvec2 before = none;
    for (int k = 0; k <= kPoints; ++k) {
        const glm::dvec2 at = map.pixel(map.grid().post(place_at(double(k) / kPoints)));
        // Where the map's ends meet the line goes from one to the other.
        const bool leaps = glm::distance(at, before) > 0.5 * std::max(size.x, size.y);
        const auto part = leaps ? std::nullopt : within(before, at, size);
        before = at;
        if (!part || !(part->first.x + part->second.y < 1e300)) continue;
        if (line.empty() || line.back() != part->first) {
            line.push_back(none);
            line.push_back(part->first);
        }
        line.push_back(part->second);
    }
    return line;
}

}  // namespace

MapGraticule make_graticule(const scene::MapView& map, double unit_px) {
    const glm::dvec2 size = map.size_px();
    MapGraticule result{chart::Drawing(size.x, size.y), {}};
    const MapRange range(map);
    if (!(range.low.x < range.high.x && range.low.y < range.high.y)) return result;
    std::vector<std::vector<glm::dvec2>> lines;
    const auto add = [&](int axis, auto text) {
        const double step_deg = graticule_step_deg(range.high[axis] - range.low[axis], kMostLines);
        Courses courses;
        const auto first = static_cast<long>(std::ceil(range.low[axis] / step_deg));
        for (long k = first; static_cast<double>(k) * step_deg <= range.high[axis]; ++k) {
            const auto place_at = [&](double part) {
                glm::dvec2 deg = glm::mix(range.low, range.high, 1.02 * part - 0.01);
                deg[axis] = static_cast<double>(k) * step_deg;
                return geo::Geodetic{radians(std::clamp(deg.x, -90.0, 90.0)), radians(deg.y), 0};
            };
            lines.push_back(line_of(map, place_at));
            for (const glm::dvec2& at : lines.back())
                if (!std::isnan(at.x)) note(courses, k, glm::ivec2(glm::min(at, size - 1.0)));
        }
        name(courses, step_deg, text, result.labels);
    };
    add(0, latitude_text);
    add(1, longitude_text);
    for (const auto& [half, color] : {std::pair(kHalfEdge, chart::Color{0x000000, kEdgeOpacity}),
                                      std::pair(kHalf, chart::Color{0xffffff, kLineOpacity})})
        for (const std::vector<glm::dvec2>& line : lines)
            result.drawing.path(line, {.stroke = color, .width = kOnPaper * half * unit_px});
    return result;
}

double graticule_step_deg(double range_deg, int most) {
    for (const int step_s : kSteps_s)
        if (range_deg * 3600 / step_s <= most) return step_s / 3600.0;
    return kSteps_s.back() / 3600.0;
}

std::string latitude_text(double latitude_deg, double step_deg) {
    const bool equator = std::abs(latitude_deg) < step_deg / 2;
    return angle_text(std::abs(latitude_deg), step_deg) + (equator            ? ""
                                                           : latitude_deg > 0 ? "N"
                                                                              : "S");
}

std::string longitude_text(double longitude_deg, double step_deg) {
    const double within = std::remainder(longitude_deg, 360);
    const bool plain = std::abs(within) < step_deg / 2 || std::abs(within) > 180 - step_deg / 2;
    return angle_text(std::abs(within), step_deg) + (plain ? "" : within > 0 ? "E" : "W");
}

Graticule make_graticule(const SeenGround& seen, const geo::LocalFrame& frame,
                         const std::function<bool(const glm::dvec3& point_m)>& is_ground) {
    const Places places = places_of(seen, frame);
    Graticule result;
    result.line = result.edge = Array2d<float>(seen.width_px(), seen.height_px(), 0);
    const double range_lat = range_of(places.latitude), range_lon = range_of(places.longitude);
    if (!(range_lat > 0 && range_lon > 0)) return result;
    result.latitude_step_deg = graticule_step_deg(range_lat, kMostLines);
    result.longitude_step_deg = graticule_step_deg(range_lon, kMostLines);
    name(draw(places.latitude, result.latitude_step_deg, seen, is_ground, result),
         result.latitude_step_deg, latitude_text, result.labels);
    name(draw(places.longitude, result.longitude_step_deg, seen, is_ground, result),
         result.longitude_step_deg, longitude_text, result.labels);
    return result;
}

void draw_lines(const Graticule& graticule, image::Image8& picture) {
    for (std::size_t at = 0; at < graticule.line.size(); ++at) {
        const float line = graticule.line.data()[at], edge = graticule.edge.data()[at];
        if (line <= 0 && edge <= 0) continue;
        for (int channel = 0; channel < 3; ++channel) {
            std::uint8_t& value = picture.values[at * 3 + static_cast<std::size_t>(channel)];
            const float darkened = static_cast<float>(value) * (1 - edge);
            value = static_cast<std::uint8_t>(std::lround(darkened + line * (255.0f - darkened)));
        }
    }
}

}  // namespace relevo::session

#include "render/ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/parallel_for.h"
#include "geo/ellipsoid.h"

namespace relevo::render {
namespace {

constexpr int kPiecesAcross = 48;  // pieces of a DEM along each axis
constexpr int kRimLines = 256;     // rows and columns whose ends are kept
/// Squares along a footprint's longer side, and of its margin on each side.
constexpr int kFootprintSquares = 96, kFootprintRoom = 16;
constexpr int kFootprintSamples = 192;  // of the grid along each axis
/// Depth of the block as a fraction of the DEM's width.
constexpr double kBlockShare = 0.07;
/// Wider DEMs are globes without sides [m].
constexpr double kWidestBlock_m = 8e6;

/// Samples are less than a square apart.
Footprint make_footprint(const dem::Heightfield& dem, const Ground& ground) {
    const glm::dvec2 sides_m = ground.north_east_m - ground.south_west_m;
    Footprint footprint;
    footprint.square_m =
        std::max({sides_m.x, sides_m.y, 1.0}) / (kFootprintSquares - 2 * kFootprintRoom);
    const auto squares = [&](double side_m) {
        return static_cast<int>(std::ceil(side_m / footprint.square_m)) + 2 * kFootprintRoom;
    };
    footprint.share = Array2d<float>(squares(sides_m.x), squares(sides_m.y), 0);
    footprint.south_west_m = ground.south_west_m - kFootprintRoom * footprint.square_m;
    Array2d<float> samples(footprint.share.width(), footprint.share.height(), 0);
    const int columns = dem.grid.columns(), rows = dem.grid.rows();
    struct Sample {
        glm::ivec2 square{-1};
        bool there = false;
    };
    Array2d<Sample> found(kFootprintSamples, kFootprintSamples);
    parallel_for(0, kFootprintSamples, 8, [&](int first, int last) {
        std::vector<glm::dvec2> posts(kFootprintSamples);
        std::vector<geo::Geodetic> places(kFootprintSamples);
        for (int j = first; j < last; ++j) {
            const double row = (rows - 1.0) * j / (kFootprintSamples - 1);
            for (int i = 0; i < kFootprintSamples; ++i)
                posts[static_cast<std::size_t>(i)] = {(columns - 1.0) * i / (kFootprintSamples - 1),
                                                      row};
            dem.grid.place(posts, places);
            for (int i = 0; i < kFootprintSamples; ++i) {
                const auto k = static_cast<std::size_t>(i);
                if (!std::isfinite(places[k].lat_rad)) continue;
                const glm::dvec2 at(ground.frame.to_local(places[k]));
                found.at(i, j) = {
                    floor((at - footprint.south_west_m) / footprint.square_m),
                    !std::isnan(dem.height_m.at(static_cast<int>(std::lround(posts[k].x)),
                                                static_cast<int>(std::lround(posts[k].y))))};
            }
        }
    });
    for (const Sample& sample : found) {
        const auto [x, y] = std::pair(sample.square.x, sample.square.y);
        if (x < 0 || y < 0 || x >= samples.width() || y >= samples.height()) continue;
        samples.at(x, y) += 1;
        footprint.share.at(x, y) += sample.there ? 1 : 0;
    }
    for (int y = 0; y < samples.height(); ++y)
        for (int x = 0; x < samples.width(); ++x)
            if (samples.at(x, y) > 0) footprint.share.at(x, y) /= samples.at(x, y);
    return footprint;
}

/// Sets the footprint and the block.
void make_block(const dem::Heightfield& dem, Ground& ground) {
    const glm::dvec2 sides_m = ground.north_east_m - ground.south_west_m;
    ground.footprint = make_footprint(dem, ground);
    if (std::max(sides_m.x, sides_m.y) > kWidestBlock_m) return;
    ground.block_m = kBlockShare * std::sqrt(sides_m.x * sides_m.y);
    // On the curved Earth the rim is below the centre.
    const double columns = dem.grid.columns() - 1, rows = dem.grid.rows() - 1;
    std::array<double, kPiecesAcross + 1> lowest{};
    parallel_for(0, kPiecesAcross + 1, 4, [&](int first, int last) {
        for (int j = first; j < last; ++j)
            for (int i = 0; i <= kPiecesAcross; ++i) {
                const geo::Geodetic place =
                    dem.grid.place(columns * i / kPiecesAcross, rows * j / kPiecesAcross);
                double& of_row = lowest[static_cast<std::size_t>(j)];
                if (std::isfinite(place.lat_rad))
                    of_row = std::min(of_row, ground.frame.to_local(place).z);
            }
    });
    ground.floor_m = *std::ranges::min_element(lowest);
}

}  // namespace

namespace {

/// Of heights along the edge, that which two fifths are below; the lowest of all if all are voids.
double rim_m(const dem::Heightfield& dem) {
    const Array2d<float>& heights = dem.height_m;
    std::vector<float> rim;
    const auto take = [&](int column, int row) {
        if (const float height = heights.at(column, row); std::isfinite(height))
            rim.push_back(height);
    };
    for (int column = 0; column < heights.width(); ++column)
        for (const int row : {0, heights.height() - 1})
            take(column, row);
    for (int row = 0; row < heights.height(); ++row)
        for (const int column : {0, heights.width() - 1})
            take(column, row);
    if (rim.empty()) return dem.about.statistics.min_m;
    const auto at = rim.begin() + 2 * std::ssize(rim) / 5;
    std::nth_element(rim.begin(), at, rim.end());
    return *at;
}

}  // namespace

Ground make_ground(const dem::Heightfield& dem) {
    return make_ground(dem, dem.grid);
}

Ground make_ground(const dem::Heightfield& dem, const dem::Grid& whole) {
    Ground ground{.frame = geo::LocalFrame(whole.center())};
    ground.lowest_m = dem.about.statistics.min_m;
    ground.highest_m = dem.about.statistics.max_m;
    ground.rim_m = rim_m(dem);
    const double columns = whole.columns() - 1, rows = whole.rows() - 1;
    ground.south_west_m = glm::dvec2(1e300);
    ground.north_east_m = glm::dvec2(-1e300);
    // Corners of a world map may be off the Earth; then more samples are taken.
    for (const int steps : {2, kPiecesAcross}) {
        bool all_on_earth = true;
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; j <= steps; ++j) {
                const geo::Geodetic place = whole.place(columns * i / steps, rows * j / steps);
                all_on_earth = all_on_earth && std::isfinite(place.lat_rad);
                if (!std::isfinite(place.lat_rad)) continue;
                const glm::dvec2 at(ground.frame.to_local(place));
                ground.south_west_m = glm::min(ground.south_west_m, at);
                ground.north_east_m = glm::max(ground.north_east_m, at);
            }
        }
        if (all_on_earth) break;
    }
    make_block(dem, ground);
    return ground;
}

namespace {

/// Computes drawn positions of posts.
class Collector {
  public:
    Collector(const dem::Heightfield& dem, const Ground& ground, double exaggeration)
        : dem_(dem), ground_(ground), exaggeration_(exaggeration) {}

    bool has(int column, int row) const { return !std::isnan(dem_.height_m.at(column, row)); }

    glm::dvec3 at(int column, int row) const {
        geo::Geodetic place = dem_.grid.place(column, row);
        if (!std::isfinite(place.lat_rad)) return glm::dvec3(std::nan(""));
        place.height_m = dem_.height_m.at(column, row) * exaggeration_;
        return ground_.frame.to_local(place);
    }

    void add(int column, int row, std::vector<glm::dvec3>& points) const {
        const glm::dvec3 point = at(column, row);
        if (!std::isnan(point.x)) points.push_back(point);
    }

    /// Adds the first and the last valid post of rows and columns.
    void add_ends(std::vector<glm::dvec3>& rim) const {
        const int width = dem_.height_m.width(), height = dem_.height_m.height();
        const auto ends = [&](int lines, int length, const auto& place) {
            const int step = std::max(1, lines / kRimLines);
            for (int next = 0; next < lines + step - 1; next += step) {
                const int line = std::min(next, lines - 1);  // includes the last one
                const auto there = [&](int along) {
                    const glm::ivec2 post = place(line, along);
                    return has(post.x, post.y);
                };
                int first = 0, last = length - 1;
                while (first < length && !there(first))
                    ++first;
                if (first == length) continue;
                while (!there(last))
                    --last;
                for (const int along : {first, last}) {
                    const glm::ivec2 post = place(line, along);
                    add(post.x, post.y, rim);
                }
            }
        };
        ends(height, width, [](int row, int column) { return glm::ivec2(column, row); });
        ends(width, height, [](int column, int row) { return glm::ivec2(column, row); });
    }

  private:
    const dem::Heightfield& dem_;
    const Ground& ground_;
    double exaggeration_;
};

/// Where this share of the posts is a level sea, aerial views frame the land alone.
constexpr double kMostlySea = 0.6, kLevelSea_m = 0.5, kLand_m = 1;
/// Less land than this share of the posts is framed with its sea.
constexpr double kLeastLand = 0.002;
/// Of long DEMs fewer posts have to be in the picture, so that enough of it is ground.
constexpr double kElongated = 1.8, kLeastOfElongated = 0.77;

/// Where water is drawn over a sea's floor, its points are on the water.
void lift_to_sea(std::vector<glm::dvec3>& points, const Ground& ground) {
    if (ground.sea_floor_share <= 0) return;
    for (glm::dvec3& point : points) {
        geo::Geodetic place = ground.frame.to_geodetic(point);
        if (place.height_m >= 0) continue;
        place.height_m = 0;
        point = ground.frame.to_local(place);
    }
}

/// @param rim  its posts along the edges, drawn as the net's are
scene::AerialGround aerial_ground(const scene::GroundNet& net, std::vector<glm::dvec3> rim,
                                  const Ground& ground, double exaggeration) {
    scene::AerialGround all{.rim = std::move(rim)}, land;
    std::size_t sea = 0;
    for (const glm::dvec3& post : net) {
        if (std::isnan(post.x)) continue;
        all.posts.push_back(post);
        const double height_m = ground.frame.to_geodetic(post).height_m / exaggeration;
        if (std::abs(height_m) <= kLevelSea_m) ++sea;
        if (height_m > kLand_m) land.posts.push_back(post);
    }
    const auto count = static_cast<double>(all.posts.size());
    land.land_alone = static_cast<double>(sea) > kMostlySea * count &&
                      static_cast<double>(land.posts.size()) > kLeastLand * count;
    if (land.land_alone) return land;
    const scene::GroundBox box = scene::box_of(net);
    const auto [shorter_m, longer_m] = std::minmax(box.size_m.x, box.size_m.y);
    if (longer_m >= kElongated * shorter_m) all.least_in_picture = kLeastOfElongated;
    lift_to_sea(all.posts, ground);
    lift_to_sea(all.rim, ground);
    return all;
}

}  // namespace

GroundToShow ground_to_show(const dem::Heightfield& dem, const Ground& ground,
                            double exaggeration) {
    const Array2d<float>& height_m = dem.height_m;
    const Collector collector(dem, ground, exaggeration), as_it_is(dem, ground, 1);
    GroundToShow result;
    const int step_x = std::max(1, height_m.width() / kPiecesAcross);
    const int step_y = std::max(1, height_m.height() / kPiecesAcross);
    result.net =
        scene::GroundNet((height_m.width() + step_x - 1) / step_x,
                         (height_m.height() + step_y - 1) / step_y, glm::dvec3(std::nan("")));
    scene::GroundNet drawn = result.net;
    std::vector<std::vector<glm::dvec3>> rows(static_cast<std::size_t>(result.net.height()));
    const auto take_row = [&](int j) {
        std::vector<glm::dvec3>& points = rows[static_cast<std::size_t>(j)];
        const int y0 = j * step_y, y1 = std::min(y0 + step_y, height_m.height());
        for (int x0 = 0; x0 < height_m.width(); x0 += step_x) {
            const int x1 = std::min(x0 + step_x, height_m.width());
            glm::ivec2 lowest(-1), highest(-1);
            for (int y = y0; y < y1; ++y) {
                for (int x = x0; x < x1; ++x) {
                    const float h = height_m.at(x, y);
                    if (std::isnan(h)) continue;
                    if (lowest.x < 0 || h < height_m.at(lowest.x, lowest.y)) lowest = {x, y};
                    if (highest.x < 0 || h > height_m.at(highest.x, highest.y)) highest = {x, y};
                }
            }
            if (lowest.x < 0) continue;
            collector.add(lowest.x, lowest.y, points);
            collector.add(highest.x, highest.y, points);
            const glm::ivec2 middle((x0 + x1) / 2, (y0 + y1) / 2);
            const glm::ivec2 post = collector.has(middle.x, middle.y) ? middle : highest;
            result.net.at(x0 / step_x, j) = as_it_is.at(post.x, post.y);
            drawn.at(x0 / step_x, j) = collector.at(post.x, post.y);
        }
    };
    parallel_for(0, result.net.height(), 1, [&](int first, int last) {
        for (int j = first; j < last; ++j)
            take_row(j);
    });
    for (const std::vector<glm::dvec3>& points : rows)
        result.points.insert(result.points.end(), points.begin(), points.end());
    collector.add_ends(result.rim);
    std::vector<glm::dvec3> true_rim;
    as_it_is.add_ends(true_rim);
    result.aerial = aerial_ground(drawn, result.rim, ground, exaggeration);
    result.true_aerial = aerial_ground(result.net, std::move(true_rim), ground, 1);
    result.points.insert(result.points.end(), result.rim.begin(), result.rim.end());
    return result;
}

std::vector<glm::dvec3> points_to_show(const dem::Heightfield& dem, const Ground& ground,
                                       double exaggeration) {
    return ground_to_show(dem, ground, exaggeration).points;
}

std::vector<glm::dvec3> block_below(std::span<const glm::dvec3> rim, const Ground& ground,
                                    double exaggeration) {
    std::vector<glm::dvec3> base;
    if (ground.block_m <= 0) return base;
    for (const glm::dvec3& point : rim) {
        geo::Geodetic place = ground.frame.to_geodetic(point);
        place.height_m = ground.base_m(exaggeration);
        base.push_back(ground.frame.to_local(place));
    }
    return base;
}

double Footprint::at(const glm::dvec2& point_m) const {
    const glm::dvec2 square = floor((point_m - south_west_m) / square_m);
    if (!(square.x >= 0 && square.y >= 0 && square.x < share.width() && square.y < share.height()))
        return 0;
    return share.at(static_cast<int>(square.x), static_cast<int>(square.y));
}

bool is_outside(const Ground& ground, const FrameInputs& inputs) {
    return !inputs.in_the_air && is_outside(ground, inputs.camera.eye_m, inputs.exaggeration);
}

bool is_outside(const Ground& ground, const glm::dvec3& eye_m, double exaggeration) {
    const glm::dvec2 sides_m = ground.north_east_m - ground.south_west_m;
    const double above_m =
        ground.frame.to_geodetic(eye_m).height_m - ground.highest_m * exaggeration;
    constexpr double kHigh = 0.35;  // as a fraction of the DEM's width
    // The extent of a globe is not its width.
    const double width_m =
        ground.block_m > 0 ? std::min(sides_m.x, sides_m.y) : 2 * geo::kEquatorialRadius_m;
    if (above_m > kHigh * width_m) return true;
    // A globe has no outside at ground level.
    return ground.block_m > 0 && ground.footprint.at(glm::dvec2(eye_m)) < 0.5;
}

std::vector<glm::dvec3> points_moved_to(std::span<const glm::dvec3> points, const Ground& ground,
                                        double exaggeration, const Displacement& displacement) {
    std::vector<glm::dvec3> moved;
    if (!displacement.any()) return moved;
    for (const glm::dvec3& point : points) {
        const geo::Geodetic place = ground.frame.to_geodetic(point);
        const double own_m = place.height_m / exaggeration;
        const auto [lowest_m, highest_m] = displacement.range_m(own_m, own_m);
        for (const double height_m : {lowest_m, highest_m}) {
            const glm::dvec3 at =
                ground.frame.to_local({place.lat_rad, place.lon_rad, height_m * exaggeration});
            for (const glm::dvec2 aside :
                 {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
                moved.push_back(at + glm::dvec3(displacement.aside_m * aside, 0));
        }
    }
    return moved;
}

SunLight make_sun_light(const sun::SkyPosition& position, const sun::Refraction& refraction,
                        const Ground& ground, const dem::Grid& grid) {
    SunLight light;
    light.direction = position.direction;
    light.refraction_rad = [refraction](double elevation_rad) {
        return refraction.apparent_rad(elevation_rad) - elevation_rad;
    };
    light.ground_height_m = ground.air_height_m();
    light.highest_m = ground.highest_m;
    light.semidiameter_rad = position.semidiameter_rad;
    light.lowest_sine = 1;
    light.highest_sine = -1;
    constexpr int kSamples = 8;
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i) {
            const geo::Geodetic place = grid.place((grid.columns() - 1) * i / double{kSamples},
                                                   (grid.rows() - 1) * j / double{kSamples});
            const double sine = dot(light.direction, ground.frame.up(place.lat_rad, place.lon_rad));
            light.lowest_sine = std::min(light.lowest_sine, sine);
            light.highest_sine = std::max(light.highest_sine, sine);
        }
    }
    return light;
}

}  // namespace relevo::render

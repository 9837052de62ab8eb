#include "light/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/units.h"
#include "base/wide_loops.h"
#include "geo/ellipsoid.h"

namespace relevo::light {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kAirTolerance_rad = radians(0.02);  // five seconds of the sun's way
constexpr double kTwilight_rad = radians(0.25);  // a sun so much too low is looked at all the same
constexpr int kLeastTile = 2;                    // posts a side
constexpr int kLarge = 64;                       // likewise

/// @param soft  shares of discs are asked for
float floor_under(float lowest_m, double relief_m, double curvature, bool soft) {
    // Rays of the disc's upper and lower limb part by its width with each metre, and meet ground no
    // farther off than that which sees the smooth Earth's horizon from both sides.
    constexpr double kDisc_rad = 0.0095;
    const double farthest_m = 2 * std::sqrt(2 * relief_m / curvature);
    const double under_m = 50 + relief_m / 4 + (soft ? kDisc_rad * farthest_m : 0);
    return static_cast<float>(lowest_m - under_m);
}

std::array<geo::Geodetic, 9> marks_of(const dem::Grid& grid) {
    std::array<geo::Geodetic, 9> marks;
    for (int i = 0; i < 9; ++i)
        marks[static_cast<std::size_t>(i)] =
            grid.place((grid.columns() - 1) * (i % 3) / 2.0, (grid.rows() - 1) * (i / 3) / 2.0);
    return marks;
}

glm::dvec2 moved(const dem::Grid& grid, const geo::Geodetic& from, double azimuth_rad,
                 double distance_m) {
    return grid.post(geo::destination(from, azimuth_rad, distance_m));
}

[[noreturn]] void no_tile(const dem::Grid& grid) {
    bad_input(
        fmt::format("sun: {}: the sun's direction on this grid changes by more than 0.05 "
                    "degrees within {} posts; "
                    "expected a map on which it does not, such as UTM: gdalwarp -t_srs",
                    grid.crs().name(), kLeastTile));
}

constexpr double kNearLevel = 1e-5;  // tangent: what is over that is over level in floats, too
constexpr int kRun = TileEdges::kRun;

/// The edge that the smooth Earth makes: where a post sees the sun, from some post on. It is as
/// high as the DEM's edge where the sun is lower than level there, too, and never lower than the
/// lowest post.
struct EarthLine {
    float base, a_post, from, scale, lowest;
    float curvature;
    RayEdges::OfRun edges;
};
[[gnu::always_inline]] inline void add_earth_to_all(const EarthLine& line, int count,
                                                    float* edge_m) {
    const auto from_m = static_cast<float>(line.edges.from_m);
    for (int i = 0; i < count; ++i) {
        const float t = line.base + line.a_post * (line.from + static_cast<float>(i));
        const float at_edge = t + line.curvature * (line.edges.distance_m[i] - from_m);
        const float beyond_m = at_edge < 0 ? line.edges.height_m[i] : line.lowest;
        const float earth_m = std::max(beyond_m, line.lowest) + t * t * line.scale;
        edge_m[i] = (t < 0) & (earth_m > edge_m[i]) ? earth_m : edge_m[i];
    }
}

struct EdgesToMix {
    const float *height_m, *low_edge_m;
    float bottom_m, share;
};
[[gnu::always_inline]] inline void mix_all(const EdgesToMix& with, int count, float* edge_m) {
    for (int i = 0; i < count; ++i) {
        const float low = with.low_edge_m[i], high = edge_m[i];
        const float between = low + (with.height_m[i] - with.bottom_m) * with.share * (high - low);
        edge_m[i] = (low > -kInfinity) & (high > -kInfinity) ? between : low;
    }
}

/// Both by the processor's vectors; the bits are the same for any width.
struct Loops {
    void (*add_earth)(const EarthLine& line, int count, float* edge_m);
    void (*mix)(const EdgesToMix& with, int count, float* edge_m);
};

#define RELEVO_SKY_LOOPS(name, ...)                                                      \
    __VA_ARGS__ void add_earth_##name(const EarthLine& line, int count, float* edge_m) { \
        add_earth_to_all(line, count, edge_m);                                           \
    }                                                                                    \
    __VA_ARGS__ void mix_##name(const EdgesToMix& with, int count, float* edge_m) {      \
        mix_all(with, count, edge_m);                                                    \
    }                                                                                    \
    constexpr Loops kLoops_##name {                                                      \
        add_earth_##name, mix_##name                                                     \
    }

RELEVO_SKY_LOOPS(any);
#if defined(__x86_64__)
RELEVO_SKY_LOOPS(256, [[gnu::target("avx2")]]);
RELEVO_SKY_LOOPS(512, [[gnu::target("avx512f")]]);
#endif
#undef RELEVO_SKY_LOOPS

const Loops& loops() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) return kLoops_512;
    if (__builtin_cpu_supports("avx2")) return kLoops_256;
#endif
    return kLoops_any;
}

/// The smooth Earth around the DEM hides a sun that is lower than level. From the reference on, so
/// that bits do not hang on where a run begins.
void add_earth(const SweepSun& sun, const SweepRun& run, double lowest_m, double curvature,
               const RayEdges& edges, float* edge_m) {
    const GridPair& middle = sun.reference;
    const auto is_over = [&](int at) {
        return run.along_column ? sun.tangent_at(run.line, at) > kNearLevel
                                : sun.tangent_at(at, run.line) > kNearLevel;
    };
    if (is_over(run.first) && is_over(run.first + run.count)) return;
    const auto base =
                   static_cast<float>(run.along_column ? sun.tangent_at(run.line, middle.row)
                                                       : sun.tangent_at(middle.column, run.line)),
               a_post = static_cast<float>(run.along_column ? sun.tangent_a_post.row
                                                            : sun.tangent_a_post.column),
               from =
                   static_cast<float>(run.first - (run.along_column ? middle.row : middle.column)),
               scale = static_cast<float>(1 / (2 * curvature)),
               lowest = static_cast<float>(lowest_m);
    loops().add_earth(
        {base, a_post, from, scale, lowest, static_cast<float>(curvature), edges.of(run)},
        run.count, edge_m);
}

/// Edges between those for the air of the lowest post and of the highest one, by a post's height.
void mix(const SweepRun& run, const float* low_edge_m, double low_m, double span_m, float* edge_m) {
    loops().mix(
        {run.height_m, low_edge_m, static_cast<float>(low_m), static_cast<float>(1 / span_m)},
        run.count, edge_m);
}

/// Calls `use` with parts of a run, figures for which `fill` puts into an array of the part's
/// length.
template <typename Fill>
void each_part(const SweepRun& run, const Fill& fill, const Sweep::Use& use) {
    std::array<float, kRun> figures;
    for (int done = 0; done < run.count; done += kRun) {
        SweepRun part = run;
        part.first += done;
        part.count = std::min(run.count - done, kRun);
        part.height_m += done;
        part.found += done;
        fill(part, figures.data());
        part.found = figures.data();
        use(part);
    }
}

/// How far off the suns of a window are at most [rad].
/// @param enough  as SunSky::error_rad() has it
double error_rad(const std::vector<SunSky>& suns, const SweepWindow& window,
                 double enough_rad = kPi) {
    double worst = 0;
    for (const SunSky& sun : suns) {
        const std::optional<SunTile> tile = sun.tile(window);
        worst = std::max(worst, tile ? sun.error_rad(*tile, enough_rad) : kPi);
        if (worst > enough_rad) break;
    }
    return worst;
}

/// Both halves of a window.
std::array<SweepWindow, 2> halves(const SweepWindow& window, bool of_columns) {
    std::array<SweepWindow, 2> halves{window, window};
    if (of_columns) {
        halves[0].columns = window.columns / 2;
        halves[1].column += halves[0].columns;
        halves[1].columns -= halves[0].columns;
    } else {
        halves[0].rows = window.rows / 2;
        halves[1].row += halves[0].rows;
        halves[1].rows -= halves[0].rows;
    }
    return halves;
}

/// @param most  no more windows are wanted
void divide(const std::vector<SunSky>& suns, double tolerance_rad, const SweepWindow& window,
            const SweepWindow& part, std::size_t most, std::vector<SweepWindow>& windows) {
    const SweepWindow wanted = common(window, part);
    if (wanted.columns == 0 || wanted.rows == 0 || windows.size() >= most) return;
    if (error_rad(suns, window, tolerance_rad) <= tolerance_rad) return windows.push_back(window);
    const bool wide = window.columns > kLeastTile, high = window.rows > kLeastTile;
    if (!wide && !high) no_tile(suns.front().dem().grid());
    // Across that way across which the sun differs more; a small one across its length.
    const glm::dvec2 size_m =
        suns.front().dem().spacing_m() * glm::dvec2(window.columns, window.rows);
    const bool large = wide && high && (window.columns > kLarge || window.rows > kLarge);
    const bool by_columns = large ? error_rad(suns, halves(window, true)[0]) <=
                                        error_rad(suns, halves(window, false)[0])
                                  : wide && (!high || size_m.x > size_m.y);
    for (const SweepWindow& half : halves(window, by_columns))
        divide(suns, tolerance_rad, half, part, most, windows);
}

}  // namespace

Sweep sweep_over(const dem::Posts& posts) {
    const dem::Grid& grid = posts.grid();
    if (!posts.in_memory())
        return Sweep(
            [&posts](const SweepWindow& window, std::vector<float>& height_m) {
                posts.view({window.column, window.row, window.columns, window.rows}, height_m);
            },
            grid.columns(), grid.rows(), posts.lowest_m(), posts.highest_m());
    std::vector<float> unused;
    const dem::Posts::View all = posts.view({0, 0, grid.columns(), grid.rows()}, unused);
    return Sweep(all.first_m, grid.columns(), grid.rows(), all.stride);
}

PartHeights::PartHeights(const dem::Posts& posts, const SweepWindow& part) {
    const SweepWindow w = common({part.column - 1, part.row - 1, part.columns + 2, part.rows + 2},
                                 whole(posts.grid()));
    view = posts.view({w.column, w.row, w.columns, w.rows}, buffer);
}

DemSky::DemSky(const dem::Posts& posts, const ShadowOptions& options)
    : posts_(posts),
      spacing_m_(posts.grid().post_spacing_m()),
      marks_(marks_of(posts.grid())),
      frame_(posts.grid().center()),
      curvature_((1 - options.refraction) / geo::kEquatorialRadius_m),
      relief_m_(double{posts.highest_m()} - posts.lowest_m()),
      floor_m_(floor_under(posts.lowest_m(), relief_m_, curvature_, options.soft)) {
    if (!(options.refraction >= -1 && options.refraction <= 0.9))
        bad_input(
            fmt::format("horizon: refraction {:.10g}: impossible, expected -1 to 0.9 of the "
                        "Earth's curvature; 0.13 is the mean",
                        options.refraction));
    if (!options.air) return;
    for (const float height_m : {posts.lowest_m(), posts.highest_m()}) {
        geo::Geodetic place = grid().center();
        place.height_m = height_m;
        airs_.push_back(options.air(place));
    }
}

double DemSky::horizon_reach_m() const {
    // Both at the highest post see each other no farther than this, and any others less far.
    return 2.05 * std::sqrt(2 * relief_m_ / curvature_);
}

double DemSky::lowest_sun_rad() const {
    return -std::sqrt(2 * curvature_ * relief_m_) - radians(0.7);
}

std::size_t DemSky::levels(double elevation_rad) const {
    const bool differ = !airs_.empty() &&
                        std::abs(apparent_rad(elevation_rad, 1) - apparent_rad(elevation_rad, 0)) >
                            2 * kAirTolerance_rad;
    return differ ? 2 : 1;
}

double DemSky::level_height_m(std::size_t level) const {
    return level == 0 ? posts_.lowest_m() : posts_.highest_m();
}

double DemSky::apparent_rad(double elevation_rad, std::size_t level) const {
    if (airs_.empty()) return elevation_rad;
    if (level == kBetween)
        return (airs_[0].apparent_rad(elevation_rad) + airs_[1].apparent_rad(elevation_rad)) / 2;
    return airs_[level].apparent_rad(elevation_rad);
}

SunSky::SunSky(const DemSky& dem, const SunOverDem& sun) : SunSky(dem, dem.grid().center(), sun) {}

SunSky::SunSky(const DemSky& dem, const geo::Geodetic& place, const SunOverDem& sun)
    : dem_(dem), levels_(dem.levels(sun.elevation_rad)) {
    const geo::Axes axes = dem.frame().axes(place.lat_rad, place.lon_rad);
    const double c = std::cos(sun.elevation_rad);
    direction_ = c * std::sin(sun.azimuth_rad) * axes.east +
                 c * std::cos(sun.azimuth_rad) * axes.north + std::sin(sun.elevation_rad) * axes.up;
    find_way();
}

SunSky::SunSky(const DemSky& dem, double azimuth_rad)
    : dem_(dem), levels_(1), azimuth_rad_(azimuth_rad) {
    find_way();
}

glm::dvec3 SunSky::direction(double column, double row) const {
    const Local sun = at(column, row);
    const double level = std::cos(sun.elevation_rad);
    return {level * std::sin(sun.azimuth_rad), level * std::cos(sun.azimuth_rad),
            std::sin(sun.elevation_rad)};
}

/// Towards the sun from the middle of the DEM.
glm::dvec2 SunSky::middle_step() const {
    const dem::Grid& grid = dem_.grid();
    return step({(grid.columns() - 1) / 2.0, (grid.rows() - 1) / 2.0});
}

void SunSky::find_way() {
    const glm::dvec2 step = middle_step();
    along_columns_ = std::abs(step.y) < std::abs(step.x);
    from_first_ = (along_columns_ ? step.x : step.y) < 0;
}

std::optional<SunSky> SunSky::going_like(const SunSky& other) const {
    constexpr double kMost = 1.25;  // posts aside from each to the next
    const glm::dvec2 step = middle_step();
    const double along = other.along_columns_ ? step.x : step.y,
                 aside = other.along_columns_ ? step.y : step.x;
    if (!(std::abs(aside) <= kMost * std::abs(along)) || (along < 0) != other.from_first_)
        return std::nullopt;
    SunSky turned = *this;
    turned.along_columns_ = other.along_columns_;
    turned.from_first_ = other.from_first_;
    return turned;
}

SunSky::Local SunSky::at(const geo::Geodetic& place) const {
    if (azimuth_rad_) return {*azimuth_rad_, place.lat_rad * 0};  // no number where there is none
    const geo::Axes axes = dem_.frame().axes(place.lat_rad, place.lon_rad);
    const double east = glm::dot(direction_, axes.east), north = glm::dot(direction_, axes.north);
    return {std::atan2(east, north),
            std::atan2(glm::dot(direction_, axes.up), std::hypot(east, north))};
}

double SunSky::reach_m(double apparent_rad) const {
    const double t = std::tan(std::min(apparent_rad, radians(89.9)));
    const double risen_m =
        (std::sqrt(t * t + 2 * dem_.curvature() * dem_.relief_m()) - t) / dem_.curvature();
    const dem::Grid& grid = dem_.grid();
    const glm::dvec2 side_m = dem_.spacing_m() * glm::dvec2(grid.columns(), grid.rows());
    return std::max(4 * dem_.widest_spacing_m(), std::min(risen_m, glm::length(side_m)));
}

bool SunSky::is_night() const {
    const double night_rad = dem_.lowest_sun_rad() - kTwilight_rad;
    return std::all_of(dem_.marks().begin(), dem_.marks().end(), [&](const geo::Geodetic& place) {
        return at(place).elevation_rad < night_rad;
    });
}

/// The path of a band, and tangents that are linear over it.
SweepSun SunSky::fitted(const SunTile& tile,
                        const std::function<double(const GridPair&)>& of) const {
    const GridPair& p = tile.path.reference;
    const glm::dvec2 size(tile.window.columns, tile.window.rows);
    glm::dmat3 sums(0);  // least squares
    glm::dvec3 found(0);
    for (const GridPair& mark : tile.marks) {
        const glm::dvec3 terms(1, (mark.column - p.column) / size.x, (mark.row - p.row) / size.y);
        sums += glm::outerProduct(terms, terms);
        found += terms * of(mark);
    }
    const glm::dvec3 fit = glm::inverse(sums) * found;
    SweepSun sun = tile.path;
    sun.tangent = fit.x;
    sun.tangent_a_post = {fit.y / size.x, fit.z / size.y};
    return sun;
}

SweepSun SunSky::sun(const SunTile& tile, std::size_t level, double offset_rad) const {
    const GridPair& p = tile.path.reference;
    const auto tangent_at = [&](double column, double row) {
        const double e = at(column, row).elevation_rad + offset_rad;
        return std::tan(std::min(dem_.apparent_rad(e, level), radians(89.99)));
    };
    if (!tile.marks.empty())
        return fitted(tile, [&](const GridPair& at) { return tangent_at(at.column, at.row); });
    const auto tangent = [&](double column, double row) {
        return tangent_at(p.column + column, p.row + row);
    };
    const double across = std::max(0.5, tile.window.columns / 2.0);
    const double down = std::max(0.5, tile.window.rows / 2.0);
    SweepSun sun = tile.path;
    sun.tangent = tangent(0, 0);
    sun.tangent_a_post = {(tangent(across, 0) - tangent(-across, 0)) / (2 * across),
                          (tangent(0, down) - tangent(0, -down)) / (2 * down)};
    return sun;
}

/// A cubic over the grid through where the ray at a post is after shares of a way.
std::optional<SweepSun> SunSky::cubic(const glm::dvec2& middle, double far_m,
                                      const glm::dvec3& s) const {
    const dem::Grid& grid = dem_.grid();
    const geo::Geodetic place = grid.place(middle.x, middle.y);
    const double azimuth_rad = at(place).azimuth_rad;
    glm::dmat3 powers;
    for (int k = 0; k < 3; ++k)
        powers[k] = {s[k], s[k] * s[k], s[k] * s[k] * s[k]};
    const glm::dmat3 inverse = glm::inverse(powers);  // of columns (s, s^2, s^3)
    glm::dmat3x2 there;
    for (int k = 0; k < 3; ++k)
        there[k] = moved(grid, place, azimuth_rad, s[k] * far_m) - middle;
    const glm::dmat3x2 terms = there * inverse;
    if (!std::isfinite(terms[0].x + terms[0].y + terms[1].x + terms[1].y + terms[2].x + terms[2].y))
        return std::nullopt;
    const auto pair = [](const glm::dvec2& v) { return GridPair{v.x, v.y}; };
    SweepSun path;
    path.columns_set = along_columns_;
    path.reference = pair(middle);
    path.towards = pair(terms[0] / far_m);
    path.bend = pair(2.0 * terms[1] / (far_m * far_m));
    path.twist = pair(6.0 * terms[2] / (far_m * far_m * far_m));
    return path;
}

std::optional<SunTile> SunSky::tile(const SweepWindow& window) const {
    const dem::Grid& grid = dem_.grid();
    const glm::dvec2 middle(window.column + (window.columns - 1) / 2.0,
                            window.row + (window.rows - 1) / 2.0);
    const geo::Geodetic place = grid.place(middle.x, middle.y);
    if (!std::isfinite(place.lat_rad)) return std::nullopt;
    const Local sun = at(place);
    // Through where the ray is before the window, and behind it for as far as that goes.
    const glm::dvec2 size_m = dem_.spacing_m() * glm::dvec2(window.columns, window.rows);
    const double behind_m = std::max(4 * dem_.widest_spacing_m(), glm::length(size_m) / 2);
    double far_m = std::max(reach_m(dem_.apparent_rad(sun.elevation_rad, 0)), behind_m);
    for (int tries = 0; tries < 8; ++tries, far_m /= 2) {
        const glm::dvec3 shares = behind_m < far_m / 3
                                      ? glm::dvec3(1 / 3.0, 2 / 3.0, 1)
                                      : glm::dvec3(-std::min(1.0, behind_m / far_m), 0.5, 1);
        if (const std::optional<SweepSun> path = cubic(middle, far_m, shares))
            return SunTile{window, window, *path};
    }
    return std::nullopt;
}

/// Towards the sun, posts for each metre.
glm::dvec2 SunSky::step(const glm::dvec2& post) const {
    const geo::Geodetic place = dem_.grid().place(post.x, post.y);
    const double way_m = 4 * dem_.widest_spacing_m();
    return (moved(dem_.grid(), place, at(place).azimuth_rad, way_m) - post) / way_m;
}

/// How far a way from a post stays in a window.
static double way_in(const SweepWindow& w, const glm::dvec2& post, const glm::dvec2& a_metre) {
    const glm::dvec2 first(w.column, w.row), last(w.column + w.columns - 1, w.row + w.rows - 1);
    double way_m = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 2; ++k)
        if (a_metre[k] != 0)
            way_m = std::min(way_m, ((a_metre[k] > 0 ? last : first)[k] - post[k]) / a_metre[k]);
    return way_m;
}

/// The ray through a post of a window: towards the sun for as far as ground shades the window, and
/// to its end away from the sun.
std::optional<SweepSun> SunSky::ray(const glm::dvec2& middle, const SweepWindow& window) const {
    constexpr double kLonger = 1.1;  // rays are bent
    const glm::dvec2 a_metre = step(middle);
    if (!std::isfinite(a_metre.x + a_metre.y)) return std::nullopt;
    const double more_m = 8 * dem_.widest_spacing_m();
    const double reach = reach_m(dem_.apparent_rad(at(middle.x, middle.y).elevation_rad, 0));
    const double before_m =
        more_m + kLonger * std::min(way_in(window, middle, a_metre) + reach,
                                    way_in(whole(dem_.grid()), middle, a_metre));
    const double behind_m = more_m + kLonger * way_in(window, middle, -a_metre);
    if (behind_m < before_m / 3) return cubic(middle, before_m, {1 / 3.0, 2 / 3.0, 1});
    if (before_m < behind_m / 3) return cubic(middle, behind_m, {-1 / 3.0, -2 / 3.0, -1});
    return cubic(middle, before_m, {-behind_m / before_m, 0.5, 1});
}

/// Divides a window into bands, each of which is divided further until its sun is one.
class SunSky::BandMaker {
  public:
    BandMaker(const SunSky& sky, const SweepWindow& window, double tolerance_rad)
        : sky_(sky), window_(window), tolerance_rad_(tolerance_rad) {
        first_ = {window.column, window.row};
        more_ = {window.columns - 1, window.rows - 1};
        const glm::dvec2 middle = first_ + 0.5 * more_;
        const glm::dvec2 a_metre = sky.step(middle);
        falls_ = a_metre.x * a_metre.y > 0;
    }

    /// One band after the other, each as wide as the error of the last one lets it be.
    std::optional<SunBands> make() {
        constexpr double kSafe = 0.97, kWider = 1.5;
        const double posts = std::max(1.0, more_[across()]);
        double from = 0, width = 1;  // shares of the diagonal
        std::optional<Firsts> begin, end;
        for (int tries = 0; tries < kMostTries; ++tries) {
            const int left = static_cast<int>(std::ceil((1 - from) / width - 1e-9));
            const bool is_last = left <= 1;
            const double to = is_last ? 1 : from + (1 - from) / left;
            end.reset();
            std::optional<SweepSun> ray;
            if (!is_last) {
                if (ray = sky_.ray(post(to), window_); ray) end = first_posts(*ray, window_);
                if (!end) return std::nullopt;
            }
            std::optional<SunTile> tile =
                this->tile((from + to) / 2, begin ? &*begin : nullptr, end ? &*end : nullptr);
            if (!tile) return std::nullopt;
            const double error_rad = tile->window.columns > 0 ? sky_.error_rad(*tile) : 0;
            const double share = kSafe * tolerance_rad_ / std::max(error_rad, 1e-9);
            if (error_rad > tolerance_rad_) {
                width = (to - from) * share;
                if (width * posts < kLeast) return std::nullopt;
                continue;
            }
            bands_.tiles.push_back(std::move(*tile));
            if (is_last) return std::move(bands_);
            bands_.rays.push_back(*ray);
            width = (to - from) * std::min(kWider, share);
            from = to;
            begin = std::move(end);
        }
        return std::nullopt;
    }

  private:
    using Firsts = std::vector<int>;
    static constexpr int kLeast = 6;  // posts across
    static constexpr int kMostTries = 200;

    int across() const { return sky_.along_columns_ ? 1 : 0; }

    /// On the diagonal, or next to it: figures of floats are counted from there on, and must not
    /// hang on where they begin.
    glm::dvec2 post(double share) const {
        glm::dvec2 shares(share);
        if (falls_) shares[1 - across()] = 1 - share;
        return glm::round(first_ + shares * more_);
    }

    /// With some more lines, so that a ray that turns back just beyond it is none.
    SweepWindow longer() const {
        constexpr int kMore = 64;
        SweepWindow w = window_;
        (across() == 0 ? w.row : w.column) -= kMore;
        (across() == 0 ? w.rows : w.columns) += 2 * kMore;
        return w;
    }

    /// One without columns where no post is between the rays.
    std::optional<SunTile> tile(double share, const Firsts* begin, const Firsts* end) const {
        const std::optional<SweepSun> path = sky_.ray(post(share), window_);
        if (!path || !first_posts(*path, longer())) return std::nullopt;
        const int a = across(), least = static_cast<int>(first_[a]),
                  most = least + static_cast<int>(more_[a]) + 1;
        const auto lines = static_cast<int>(more_[1 - a]) + 1;
        const auto range = [&](int line) {
            const auto i = static_cast<std::size_t>(line);
            return std::pair(begin ? (*begin)[i] : least, end ? (*end)[i] : most);
        };
        int first_line = lines, last_line = -1, first = most, last = least;
        for (int line = 0; line < lines; ++line) {
            const auto [from, to] = range(line);
            if (from >= to) continue;
            first_line = std::min(first_line, line), last_line = line;
            first = std::min(first, from), last = std::max(last, to - 1);
        }
        SunTile tile{{}, {}, *path};
        if (last_line < 0) return tile;
        const auto at = [&](double x, double line) {
            line += first_[1 - a];
            return a == 0 ? GridPair{x, line} : GridPair{line, x};
        };
        const GridPair corner = at(first, first_line);
        const int columns = a == 0 ? last - first + 1 : last_line - first_line + 1,
                  rows = a == 0 ? last_line - first_line + 1 : last - first + 1;
        tile.window = {static_cast<int>(corner.column), static_cast<int>(corner.row), columns,
                       rows};
        // The sun of a small one is as a window's.
        if (std::min(columns, rows) < kSmall) return tile;
        for (const int line : {first_line, (first_line + last_line) / 2, last_line}) {
            const auto [from, to] = range(line);
            for (int i = 0; i < 3; ++i)
                tile.marks.push_back(at(from + (to - 1 - from) * i / 2.0, line));
        }
        return tile;
    }

    static constexpr int kSmall = 16;  // posts

    const SunSky& sky_;
    SweepWindow window_;
    double tolerance_rad_;
    glm::dvec2 first_, more_;
    bool falls_;  // the diagonal goes from the last line to the first
    SunBands bands_;
};

std::optional<SunBands> SunSky::bands(const SweepWindow& window, double tolerance_rad) const {
    return BandMaker(*this, window, tolerance_rad).make();
}

std::vector<Sweep::Blocks::Band> SunBands::over(const SweepWindow& part) const {
    std::vector<Sweep::Blocks::Band> bands(tiles.size());
    std::shared_ptr<const std::vector<int>> before;
    for (std::size_t k = 0; k + 1 < bands.size(); ++k) {
        std::vector<int> first = *first_posts(rays[k], part);
        if (before)
            for (std::size_t i = 0; i < first.size(); ++i)
                first[i] = std::max(first[i], (*before)[i]);
        bands[k].begin = before;
        bands[k].end = before = std::make_shared<const std::vector<int>>(std::move(first));
    }
    bands.back().begin = before;
    return bands;
}

/// The largest angle between the rays that shade a post and the tile's lines.
double SunSky::path_error_rad(const SunTile& tile, const glm::dvec2& post, const Local& sun) const {
    const dem::Grid& grid = dem_.grid();
    // As Sweep goes: from row to row or from column to column, all lines being moved along the
    // other.
    const bool by_rows = !along_columns_;
    const SweepSun path = by_rows ? tile.path : tile.path.transposed();
    const int step = by_rows ? 1 : 0, across = 1 - step;
    const geo::Geodetic place = grid.place(post.x, post.y);
    const double apparent = dem_.apparent_rad(sun.elevation_rad, 0);
    const double reach = reach_m(apparent), least_m = 2 * dem_.widest_spacing_m();
    const double s0 = path.distance_m(post[step]);
    const double moved_by = post[across] - path.way(s0).column;
    const double across_m = dem_.spacing_m()[across];
    double worst = 0;
    for (const double share : {0.02, 0.2, 0.6, 1.0}) {
        // Nearer than some posts an angle is of no account, and PROJ's millimetre would be one.
        const double s = std::max(share * reach, least_m);
        const glm::dvec2 at = moved(grid, place, sun.azimuth_rad, s);
        if (!(at.x > -1 && at.y > -1 && at.x < grid.columns() && at.y < grid.rows())) continue;
        const double s1 = path.distance_m(at[step]);
        if (std::isnan(s1)) return kPi;
        // A tenth of a post is less than lines are apart, whatever the angle.
        const auto angle_rad = [&](double off_m) {
            return std::abs(off_m) < across_m / 10 ? 0 : std::abs(off_m) / s;
        };
        const double aside_m = (path.way(s1).column + moved_by - at[across]) * across_m;
        const double longer_m = s1 - s0 - s;
        worst = std::max(worst, angle_rad(aside_m) * std::cos(apparent));
        worst = std::max(worst, angle_rad(longer_m) * std::sin(2 * apparent) / 2);
    }
    return worst;
}

double SunSky::error_rad(const SunTile& tile, double enough_rad) const {
    double worst = 0;
    const SweepWindow& w = tile.window;
    for (std::size_t k = 0; k < levels_; ++k) {
        const std::size_t level = k == 0 ? first_level() : 1;
        const SweepSun model = sun(tile, level, 0);
        for (int i = 0; i < 9; ++i) {
            glm::dvec2 post(w.column + (w.columns - 1) * (i % 3) / 2.0,
                            w.row + (w.rows - 1) * (i / 3) / 2.0);
            if (!tile.marks.empty()) {
                const GridPair& mark = tile.marks[static_cast<std::size_t>(i)];
                post = {mark.column, mark.row};
            }
            const Local local = at(post.x, post.y);
            const double tangent = model.tangent_at(post.x, post.y);
            const double seen =
                std::min(dem_.apparent_rad(local.elevation_rad, level), radians(89.99));
            worst = std::max(worst, std::abs(std::atan(tangent) - seen));
            if (k == 0) worst = std::max(worst, path_error_rad(tile, post, local));
            if (std::isnan(worst + local.elevation_rad)) return kPi;
            if (worst > enough_rad) return worst;
        }
    }
    return worst;
}

std::vector<SweepWindow> divide(const std::vector<SunSky>& suns, const SweepWindow& window,
                                const SweepWindow& part, double tolerance_rad) {
    std::vector<SweepWindow> windows;
    divide(suns, tolerance_rad, window, part, std::numeric_limits<std::size_t>::max(), windows);
    return windows;
}

static void divide_in_bands(std::span<const SunSky> suns, const SweepWindow& window,
                            const SweepWindow& part, int depth,
                            std::vector<BandedWindow>& windows) {
    constexpr int kDeepest = 3;
    const SweepWindow wanted = common(window, part);
    if (wanted.columns == 0 || wanted.rows == 0) return;
    const std::vector<SunSky> ends{suns.front(), suns.back()};
    BandedWindow banded{window, {}};
    for (const SunSky& sun : suns) {
        std::optional<SunBands> bands = sun.bands(window, kSunTolerance_rad);
        if (!bands) break;
        banded.bands.push_back(std::move(*bands));
    }
    if (banded.bands.size() == suns.size()) return windows.push_back(std::move(banded));
    const bool by_columns = suns.front().along_columns();
    if (depth < kDeepest && (by_columns ? window.columns : window.rows) > kLarge) {
        for (const SweepWindow& half : halves(window, by_columns))
            divide_in_bands(suns, half, part, depth + 1, windows);
        return;
    }
    for (const SweepWindow& each : divide(ends, window, part))
        windows.push_back({each, {}});
}

std::vector<BandedWindow> divide_in_bands(std::span<const SunSky> suns, const SweepWindow& window,
                                          const SweepWindow& part) {
    // A few windows are swept nearly as fast as one, and where they are large much is left out.
    constexpr std::size_t kFew = 8;
    const std::vector<SunSky> ends{suns.front(), suns.back()};
    std::vector<SweepWindow> few;
    divide(ends, kSunTolerance_rad, window, window, kFew + 1, few);
    std::vector<BandedWindow> windows;
    if (few.size() > kFew) {
        divide_in_bands(suns, window, part, 0, windows);
        return windows;
    }
    for (const SweepWindow& each : few)
        if (const SweepWindow wanted = common(each, part); wanted.columns > 0 && wanted.rows > 0)
            windows.push_back({each, {}});
    return windows;
}

SweepWindow common(const SweepWindow& a, const SweepWindow& b) {
    const int column = std::max(a.column, b.column), row = std::max(a.row, b.row);
    return {column, row, std::max(0, std::min(a.column + a.columns, b.column + b.columns) - column),
            std::max(0, std::min(a.row + a.rows, b.row + b.rows) - row)};
}

SunTile tile_of(const SunSky& sky, const SweepWindow& window, const SweepWindow& part) {
    SunTile tile = *sky.tile(window);
    tile.part = common(window, part);
    return tile;
}

void each_window(const std::vector<SweepWindow>& windows,
                 const std::function<void(const SweepWindow&)>& body) {
    parallel_for(0, static_cast<int>(windows.size()), 1, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            body(windows[static_cast<std::size_t>(i)]);
    });
}

/// The lowest tangent of a sun over a window.
static double lowest_tangent(const SweepSun& sun, const SweepWindow& w) {
    double lowest = sun.tangent;
    for (const int column : {w.column, w.column + w.columns})
        for (const int row : {w.row, w.row + w.rows})
            lowest = std::min(lowest, sun.tangent_at(column, row));
    return lowest;
}

TileEdges::TileEdges(const SunSky& sky, const SunTile& tile, double offset_rad)
    : dem_(sky.dem()), suns_{sky.sun(tile, sky.first_level(), offset_rad)} {
    if (sky.levels() == 2) suns_.push_back(sky.sun(tile, 1, offset_rad));
    double lowest = 0;
    for (const SweepSun& sun : suns_)
        lowest = std::min(lowest, lowest_tangent(sun, tile.window));
    over_earth_ = lowest >= 0;
    if (!over_earth_)
        edges_.emplace(dem_.posts(), tile.path, tile.window, tile.marks,
                       -lowest / dem_.curvature());
}

const float* TileEdges::find(const SweepRun& run, const float* other_m, float* room) const {
    const bool two = suns_.size() == 2;
    if (over_earth_ && !two) return run.found;
    const double low_m = dem_.level_height_m(0), span_m = dem_.level_height_m(1) - low_m;
    const auto add_ground_beyond = [&](const SweepSun& sun, float* edge_m) {
        if (!over_earth_) add_earth(sun, run, low_m, dem_.curvature(), *edges_, edge_m);
    };
    std::copy_n(run.found, run.count, room);
    add_ground_beyond(suns_.back(), room);
    if (!two) return room;
    std::array<float, kRun> other;
    std::copy_n(other_m, run.count, other.data());
    add_ground_beyond(suns_.front(), other.data());
    mix(run, other.data(), low_m, span_m, room);
    return room;
}

void TileEdges::each(const std::function<void(std::size_t, const Sweep::Use&)>& sweep,
                     TileValues& scratch, const Sweep::Use& use) const {
    const bool two = suns_.size() == 2;
    if (over_earth_ && !two) return sweep(0, use);
    if (two)
        sweep(0, [&](const SweepRun& run) { std::copy_n(run.found, run.count, scratch.of(run)); });
    const auto find_part = [&](const SweepRun& part, float* edge_m) {
        find(part, two ? scratch.of(part) : nullptr, edge_m);
    };
    sweep(suns_.size() - 1, [&](const SweepRun& run) { each_part(run, find_part, use); });
}

void each_edge(const SunSky& sky, const Sweep& sweep, const SunTile& tile, double offset_rad,
               TileValues& scratch, const Sweep::Use& use) {
    const TileEdges edges(sky, tile, offset_rad);
    edges.each(
        [&](std::size_t sun, const Sweep::Use& each) {
            sweep.each_edge(edges.suns()[sun], tile.part, each, Sweep::kMostLanes,
                            sky.dem().floor_m());
        },
        scratch, use);
}

/// The horizon is no lower than that of the ground beyond the edge, as tangent_beyond() has it,
/// nor than the dip of a smooth Earth as high as the lowest post.
RELEVO_WIDE_LOOPS static void add_dip(const SweepRun& run, const RayEdges::OfRun& edges,
                                      float lowest_m, float curvature, float* tangent) {
    const auto from_m = static_cast<float>(edges.from_m);
    for (int i = 0; i < run.count; ++i) {
        const float eye_m = run.height_m[i];
        const auto dip = [&](float height_m) {
            return std::sqrt(2 * curvature * std::max(0.0F, eye_m - height_m));
        };
        const float beyond =
            std::max(dip(edges.height_m[i]), curvature * (edges.distance_m[i] - from_m));
        tangent[i] = std::max(run.found[i], -std::min(dip(lowest_m), beyond));
    }
}

void each_horizon(const SunSky& direction, const Sweep& sweep, const SunTile& tile,
                  const Sweep::Use& use) {
    const DemSky& dem = direction.dem();
    const auto curvature = static_cast<float>(dem.curvature());
    const auto lowest_m = static_cast<float>(dem.level_height_m(0));
    const RayEdges edges(dem.posts(), tile.path, tile.window, tile.marks, dem.horizon_reach_m());
    const auto fill = [&](const SweepRun& part, float* tangent) {
        add_dip(part, edges.of(part), lowest_m, curvature, tangent);
    };
    sweep.each_horizon(tile.path, dem.curvature(), dem.horizon_reach_m(), tile.part,
                       [&](const SweepRun& run) { each_part(run, fill, use); });
}

TileValues::TileValues(const SweepWindow& window, float value, bool along_columns)
    : window_(window),
      along_columns_(along_columns),
      values_(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows),
              value) {}

void TileValues::cover(const SweepWindow& window, float value, bool along_columns) {
    window_ = window;
    along_columns_ = along_columns;
    values_.assign(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows),
                   value);
}

void TileValues::turn(bool along_columns) {
    if (along_columns == along_columns_) return;
    const int rows = along_columns_ ? window_.columns : window_.rows;
    const int columns = along_columns_ ? window_.rows : window_.columns;
    std::vector<float> turned(values_.size());
    transpose(values_.data(), columns, rows, columns, turned.data(), rows);
    values_ = std::move(turned);
    along_columns_ = along_columns;
}

TileValues TileValues::part(const SweepWindow& window, bool along_columns) const {
    TileValues part(window, 0, along_columns);
    const SweepRun first{along_columns_,
                         along_columns_ ? window.column : window.row,
                         along_columns_ ? window.row : window.column,
                         0,
                         nullptr,
                         nullptr};
    const float* const from = of(first);
    const int lines = along_columns_ ? window.columns : window.rows,
              length = along_columns_ ? window.rows : window.columns,
              stride = along_columns_ ? window_.rows : window_.columns;
    if (along_columns == along_columns_)
        for (int line = 0; line < lines; ++line)
            std::copy_n(from + std::ptrdiff_t{line} * stride, length,
                        part.values_.data() + std::ptrdiff_t{line} * length);
    else
        transpose(from, stride, lines, length, part.values_.data(), lines);
    return part;
}

void TileValues::put(Array2d<float>& all, const SweepWindow& of) const {
    float* const to = &all.at(window_.column - of.column, window_.row - of.row);
    if (along_columns_)
        return transpose(values_.data(), window_.rows, window_.columns, window_.rows, to,
                         all.width());
    parallel_for(0, window_.rows, 64, [&](int first, int last) {
        for (int row = first; row < last; ++row)
            std::copy_n(values_.data() + std::ptrdiff_t{row} * window_.columns, window_.columns,
                        to + std::ptrdiff_t{row} * all.width());
    });
}

}  // namespace relevo::light

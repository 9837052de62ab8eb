#include "dem.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "options.h"

namespace relevo::c {

Dem::Dem(scene::Scene named, std::optional<dem::MemoryRaster> held)
    : held_(std::move(held)),
      named_(std::move(named)),
      source_(std::make_shared<dem::Source>(dem::Source::open(named_.dems, named_.dem))) {}

const dem::Posts& Dem::posts() {
    const std::lock_guard lock(mutex_);
    if (!posts_) posts_.emplace(dem::Posts::load(named_.dems, named_.dem));
    return *posts_;
}

std::shared_ptr<Dem> Dem::around() {
    const std::lock_guard lock(mutex_);
    return around_;
}

void Dem::set_around(std::shared_ptr<Dem> around) {
    const std::lock_guard lock(mutex_);
    around_ = std::move(around);
}

std::shared_ptr<const session::LoadedDem> Dem::loaded(const scene::Scene& scene) {
    const std::lock_guard lock(mutex_);
    if (!loaded_ || loaded_holes_ != scene.holes) {
        loaded_ = session::load_dem(source_, scene);
        loaded_holes_ = scene.holes;
    }
    return loaded_;
}

Handles<relevo_dem, Dem>& dems() {
    static auto& all = *new Handles<relevo_dem, Dem>;  // closed by nobody else
    return all;
}

geo::Geodetic place_of(const relevo_place* given) {
    const relevo_place place = read_struct(given, "place");
    if (!(std::abs(place.lat_deg) <= 90) || !(std::abs(place.lon_deg) <= 360) ||
        !std::isfinite(place.height_m))
        bad_input(
            fmt::format("place: {:.10g}, {:.10g}: expected a latitude from -90 to 90, a "
                        "longitude from -360 to 360 and a height",
                        place.lat_deg, place.lon_deg));
    return geo::geodetic_deg(place.lat_deg, place.lon_deg, place.height_m);
}

namespace {

/// Takes the members of the options that say how numbers in memory become heights.
dem::Stored take_stored(json::Value& options) {
    const json::Value own = take_members(options, {"scale", "offset", "voids_known"});
    json::ObjectReader reader("heights", "options", "", own);
    constexpr double kMost = 1e7;
    dem::Stored stored{.scale = reader.number("scale", 1, -kMost, kMost, false),
                       .offset = reader.number("offset", 0, -kMost, kMost, false),
                       .unit = {},  // as files without one
                       .voids_declared = reader.boolean("voids_known", false)};
    if (stored.scale == 0) reader.fail(reader.line_of("scale"), "scale", "expected another than 0");
    return stored;
}

std::shared_ptr<Dem> dem_of(const relevo_raster* given) {
    const relevo_raster heights = read_struct(given, "heights");
    need(heights.heights_m, "heights.heights_m");
    if (heights.columns < 2 || heights.rows < 2)
        throw BadCall{fmt::format("heights: expected 2 columns and rows or more but got {} and {}",
                                  heights.columns, heights.rows)};
    check_count("heights.count", heights.count,
                static_cast<std::size_t>(heights.columns) * static_cast<std::size_t>(heights.rows));
    const geo::Crs crs = geo::Crs::parse(&need(heights.crs, "heights.crs"), "crs");
    json::Value options = parse_dem(heights.options);
    const dem::Stored stored = take_stored(options);
    dem::MemoryRaster held(heights.heights_m, heights.columns, heights.rows,
                           dem::Affine::of_geotransform(heights.transform), stored);
    scene::Scene named = read_dem({held.name()}, std::move(options));
    if (!named.dem.crs.empty()) throw BadCall{"heights.options: crs: expected none"};
    named.dem.crs = crs.text();
    if (named.dem.unit.empty() && crs.vertical() && crs.vertical()->unit_m != 1)
        log::info(fmt::format(
            "heights: are in {} by the vertical part of the CRS; --unit m takes them as metres",
            crs.vertical()->unit_name));
    return std::make_shared<Dem>(std::move(named), std::move(held));
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_dem_open(const char* const* files, size_t count, const char* options,
                              relevo_dem** dem) {
    return c::guarded("relevo_dem_open", [&] {
        c::need(dem, "dem") = nullptr;
        if (count == 0) throw c::BadCall{"count: expected one file or more"};
        c::need(files, "files");
        std::vector<std::string> names;
        for (size_t i = 0; i < count; ++i)
            names.emplace_back(&c::need(files[i], "files"));
        *dem = c::dems().add(std::make_shared<c::Dem>(c::read_dem(names, options)));
    });
}

relevo_result relevo_dem_from_heights(const relevo_raster* heights, relevo_dem** dem) {
    return c::guarded("relevo_dem_from_heights", [&] {
        c::need(dem, "dem") = nullptr;
        *dem = c::dems().add(c::dem_of(heights));
    });
}

void relevo_dem_close(relevo_dem* dem) {
    c::dems().remove(dem);
}

relevo_result relevo_dem_around(relevo_dem* dem, relevo_dem* around) {
    return c::guarded("relevo_dem_around", [&] {
        const auto of = c::dems().get(dem, "dem");
        if (dem == around) throw c::BadCall{"around: expected another DEM"};
        if (!of->named().dem.surroundings.empty())
            throw c::BadCall{"dem: was opened with surroundings already"};
        of->set_around(around ? c::dems().get(around, "around") : nullptr);
    });
}

relevo_result relevo_dem_grid(relevo_dem* dem, relevo_grid* grid) {
    return c::guarded("relevo_dem_grid", [&] {
        c::read_struct(grid, "grid");
        const dem::Grid& of = c::dems().get(dem, "dem")->grid();
        const geo::Geodetic centre = of.center();
        const glm::dvec2 spacing_m = of.post_spacing_m();
        relevo_grid result{};
        result.columns = of.columns();
        result.rows = of.rows();
        std::ranges::copy(of.affine().geotransform(), result.transform);
        result.centre_lat_deg = degrees(centre.lat_rad);
        result.centre_lon_deg = degrees(centre.lon_rad);
        result.column_spacing_m = spacing_m.x;
        result.row_spacing_m = spacing_m.y;
        c::write_struct(result, grid);
    });
}

relevo_result relevo_dem_crs(relevo_dem* dem, const char** crs) {
    return c::guarded("relevo_dem_crs", [&] {
        c::need(crs, "crs") = nullptr;
        *crs = c::returned_text(c::dems().get(dem, "dem")->grid().crs().text());
    });
}

relevo_result relevo_dem_wkt(relevo_dem* dem, const char** wkt) {
    return c::guarded("relevo_dem_wkt", [&] {
        c::need(wkt, "wkt") = nullptr;
        *wkt = c::returned_text(c::dems().get(dem, "dem")->grid().crs().wkt());
    });
}

relevo_result relevo_dem_read(relevo_dem* dem, float* heights_m, size_t count) {
    return c::guarded("relevo_dem_read", [&] {
        c::need(heights_m, "heights_m");
        const auto of = c::dems().get(dem, "dem");
        const auto columns = static_cast<size_t>(of->grid().columns());
        const auto rows = static_cast<size_t>(of->grid().rows());
        c::check_count("count", count, columns * rows);
        const int block = std::max(1, of->source().block_rows());
        for (int row = 0; row < of->grid().rows(); row += block) {
            const dem::Window window{0, row, of->grid().columns(),
                                     std::min(block, of->grid().rows() - row)};
            const Array2d<float> read = of->source().read(window, window.columns, window.rows);
            std::copy(read.begin(), read.end(), heights_m + columns * static_cast<size_t>(row));
        }
    });
}

relevo_result relevo_dem_height(relevo_dem* dem, double lat_deg, double lon_deg, double* height_m) {
    return c::guarded("relevo_dem_height", [&] {
        c::need(height_m, "height_m") = std::nan("");
        relevo_place place{};
        place.size = sizeof place;
        place.lat_deg = lat_deg;
        place.lon_deg = lon_deg;
        *height_m = c::dems().get(dem, "dem")->source().height_at(c::place_of(&place));
    });
}

relevo_result relevo_dem_heights(relevo_dem* dem, const double* lat_deg, const double* lon_deg,
                                 size_t count, double* height_m) {
    return c::guarded("relevo_dem_heights", [&] {
        const auto of = c::dems().get(dem, "dem");
        if (count == 0) return;
        c::need(lat_deg, "lat_deg");
        c::need(lon_deg, "lon_deg");
        c::need(height_m, "height_m");
        for (size_t i = 0; i < count; ++i) {
            const relevo_place place{sizeof place, lat_deg[i], lon_deg[i], 0};
            height_m[i] = of->source().height_at(c::place_of(&place));
        }
    });
}

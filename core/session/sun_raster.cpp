#include "session/sun_raster.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "light/raster/beyond.h"
#include "light/raster/horizons.h"
#include "light/raster/sun_hours.h"
#include "session/hours_bands.h"
#include "session/words.h"
#include "sun/position.h"

namespace relevo::session {
namespace {

/// The ground at the DEM's centre.
geo::Geodetic middle_of(const dem::Posts& posts) {
    geo::Geodetic ground = posts.grid().center();
    const double height_m =
        posts.height_at((posts.grid().columns() - 1) / 2.0, (posts.grid().rows() - 1) / 2.0);
    ground.height_m = std::isnan(height_m) ? posts.lowest_m() : height_m;
    return ground;
}

std::function<sun::Refraction(const geo::Geodetic&)> air_of(const std::string& refraction) {
    return [refraction](const geo::Geodetic& place) { return refraction_at(refraction, place); };
}

/// Options common to all kinds of rasters.
template <typename Options>
Options options_for(const dem::Window& part, const std::function<void(double)>& done) {
    Options options;
    options.refraction = kTerrestrialRefraction;
    options.part = part;
    options.done = done;
    return options;
}

SunRasterMaker hours_of(const dem::Posts& posts, const SunRasterWanted& wanted,
                        const dem::Window& window, const std::function<void(double)>& done) {
    const std::string_view word = hours_word(wanted.figure);
    auto options = options_for<light::SunHoursOptions>(window, done);
    options.air = air_of(wanted.refraction);
    options.step_s = kSunStep_s;
    options.spells = needs_spells(word);
    if (needs_irradiation(word)) options.irradiation.emplace();
    const auto plan =
        std::make_shared<light::SunHoursPlan>(posts, wanted.begin, wanted.end, options);
    return [plan, word, irradiation = options.irradiation](const dem::Window& part) {
        light::SunHours hours = plan->part(part);
        std::string definition = std::move(hours.definition);
        if (irradiation) definition += "; " + definition_of(*irradiation);
        return SunRaster{hours_values(word, hours), hours.holes, std::move(definition)};
    };
}

SunRasterMaker shadow_of(const dem::Posts& posts, const SunRasterWanted& wanted,
                         const dem::Window& window, const std::function<void(double)>& done) {
    auto options = options_for<light::ShadowOptions>(window, done);
    options.air = air_of(wanted.refraction);
    const auto plan = std::make_shared<light::SunPlan>(
        posts, light::LightPath{options.refraction, options.air}, window);
    plan->add_suns(posts.grid().center(),
                   {sun_over_middle(posts, wanted.begin, wanted.refraction).sun});
    return [plan, options](const dem::Window& part) mutable {
        options.part = part;
        light::Shadows shadows = light::shadows(*plan, plan->suns().front(), options);
        return SunRaster{std::move(shadows.lit), shadows.holes, std::move(shadows.definition)};
    };
}

SunRasterMaker sky_of(const dem::Posts& posts, const dem::Window& window,
                      const std::function<void(double)>& done) {
    auto options = options_for<light::SkyViewOptions>(window, done);
    options.directions = kSkyDirections;
    const auto plan =
        std::make_shared<light::SunPlan>(posts, light::LightPath{options.refraction, {}}, window);
    light::add_sky_view_directions(*plan, options.directions);
    return [plan, options](const dem::Window& part) mutable {
        options.part = part;
        light::SkyView view = light::sky_view(*plan, options);
        return SunRaster{std::move(view.share), view.holes, std::move(view.definition)};
    };
}

/// Metadata of one kind of raster.
output::RasterMetadata metadata_of(const dem::Posts& posts, const SunRasterWanted& wanted) {
    const auto air = [&] { return air_of_posts(wanted.refraction, posts); };
    if (wanted.figure == SunFigure::SkyView)
        return {{"DIRECTIONS", fmt::format("{}", kSkyDirections)}};
    if (is_of_period(wanted.figure))
        return {{"TIME_FROM", sun::to_iso(wanted.begin, wanted.zone)},
                {"TIME_TO", sun::to_iso(wanted.end, wanted.zone)},
                {"TIME_ZONE", wanted.zone.name()},
                {"REFRACTION", air()}};
    output::RasterMetadata about{{"REFRACTION", air()}};
    for (auto& item : metadata_of(sun_over_middle(posts, wanted.begin, wanted.refraction)))
        about.push_back(std::move(item));
    return about;
}

/// Unmodelled terrain beyond the DEM that could change the result.
std::optional<light::Beyond> beyond_of(const dem::Posts& posts, const SunRasterWanted& wanted) {
    const dem::Grid& grid = posts.grid();
    const dem::Window all{0, 0, grid.columns(), grid.rows()};
    if (wanted.figure == SunFigure::SkyView) {
        std::vector<double> azimuth_rad;
        for (int i = 0; i < kSkyDirections; ++i)
            azimuth_rad.push_back(2 * kPi * i / kSkyDirections);
        return light::terrain_beyond(posts, all, azimuth_rad, kTerrestrialRefraction);
    }
    light::ShadowOptions options;
    options.refraction = kTerrestrialRefraction;
    options.air = air_of(wanted.refraction);
    if (is_of_period(wanted.figure))
        return light::terrain_beyond(posts, all, light::suns_of(grid, wanted.begin, wanted.end),
                                     options);
    return light::terrain_beyond(
        posts, all, {sun_over_middle(posts, wanted.begin, wanted.refraction).sun}, options);
}

}  // namespace

bool is_of_period(SunFigure figure) {
    return figure < SunFigure::Shadow;
}

std::string_view hours_word(SunFigure figure) {
    switch (figure) {
        case SunFigure::FirstLight:
            return "first";
        case SunFigure::LastLight:
            return "last";
        case SunFigure::Irradiation:
            return "global";
        default:
            return "hours";
    }
}

output::RasterBand shadow_band(bool soft) {
    return {soft ? "visible fraction of the solar disc" : "direct sun", "1"};
}

output::RasterBand sky_view_band() {
    return {"sky-view factor", "1"};
}

output::RasterBand band_of(SunFigure figure) {
    if (is_of_period(figure)) return hours_band(hours_word(figure));
    return figure == SunFigure::Shadow ? shadow_band(false) : sky_view_band();
}

std::optional<OverlayTime> time_of(const dem::Posts& posts, const SunRasterWanted& wanted) {
    const output::RasterMetadata about = metadata_of(posts, wanted);
    return overlay_time({about.begin(), about.end()});
}

SunOverMiddle sun_over_middle(const dem::Posts& posts, sun::Instant utc,
                              const std::string& refraction) {
    const sun::Position position = sun::position(utc, posts.grid().center());
    const sun::Refraction air = refraction_at(refraction, middle_of(posts));
    return {light::SunOverDem::of(position), air.apparent_rad(position.elevation_rad), utc};
}

output::RasterMetadata metadata_of(const SunOverMiddle& sun) {
    output::RasterMetadata about{
        {"SUN_AZIMUTH_DEG", fmt::format("{:.5f}", degrees(sun.sun.azimuth_rad))},
        {"SUN_APPARENT_ELEVATION_DEG", fmt::format("{:.5f}", degrees(sun.apparent_rad))},
        {"SUN_PLACE", "the middle of the DEM; azimuth from true north"}};
    if (sun.utc) {
        about.emplace_back("TIME_UTC", sun::to_iso(*sun.utc, 3));
        about.emplace_back("SUN_ELEVATION_DEG",
                           fmt::format("{:.5f}", degrees(sun.sun.elevation_rad)));
    }
    return about;
}

std::string air_of_posts(const std::string& refraction, const dem::Posts& posts) {
    if (refraction == "standard") return "integrated ICAO standard atmosphere over each post";
    return refraction_at(refraction, middle_of(posts)).description();
}

output::RasterMetadata raster_metadata(const dem::Posts& posts, const std::string& version,
                                       const std::string& definition, double terrestrial_refraction,
                                       std::int64_t holes, const std::optional<dem::Window>& clip) {
    output::RasterMetadata about{
        {"TIFFTAG_SOFTWARE", "Relevo " + version},
        {"DEFINITION", definition},
        {"DEM", posts.about().path},
        {"TERRESTRIAL_REFRACTION", fmt::format("{:.4g}", terrestrial_refraction)},
        {"HOLES", fmt::format("{}", holes)}};
    const dem::TileReport& tiles = posts.about().tiles;
    if (tiles.missing.count > 0)
        about.emplace_back("TILES_MISSING",
                           fmt::format("{} of {}", tiles.missing.text(), tiles.tiles));
    if (tiles.broken.count > 0)
        about.emplace_back("TILES_BROKEN",
                           fmt::format("{} of {}", tiles.broken.text(), tiles.tiles));
    if (clip)
        about.emplace_back(
            "CLIP",
            fmt::format("columns {} to {} and rows {} to {} of the DEM, from 0", clip->column,
                        clip->column + clip->columns - 1, clip->row, clip->row + clip->rows - 1));
    return about;
}

Array2d<std::uint8_t> mask_of(const Array2d<float>& lit) {
    Array2d<std::uint8_t> mask(lit.width(), lit.height());
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask.data()[i] = std::isnan(lit.data()[i]) ? 255 : lit.data()[i] > 0;
    return mask;
}

std::vector<dem::Window> raster_parts(const dem::Window& window, std::int64_t most_posts) {
    constexpr int kBlock = 512;  // blocks of the output file [posts]
    const int fitting = static_cast<int>(std::sqrt(static_cast<double>(most_posts)));
    const int side = std::max(kBlock, fitting / kBlock * kBlock);
    std::vector<dem::Window> parts;
    for (int row = 0; row < window.rows; row += side)
        for (int column = 0; column < window.columns; column += side)
            parts.push_back({window.column + column, window.row + row,
                             std::min(side, window.columns - column),
                             std::min(side, window.rows - row)});
    return parts;
}

bool same_figures(const SunRasterWanted& a, const SunRasterWanted& b) {
    if (a.figure != b.figure) return false;
    if (a.figure == SunFigure::SkyView) return true;
    return a.begin == b.begin && a.refraction == b.refraction &&
           (a.figure == SunFigure::Shadow || (a.end == b.end && a.zone.name() == b.zone.name()));
}

SunRasterMaker sun_raster_maker(const dem::Posts& posts, const SunRasterWanted& wanted,
                                const dem::Window& window,
                                const std::function<void(double)>& done) {
    if (is_of_period(wanted.figure)) return hours_of(posts, wanted, window, done);
    if (wanted.figure == SunFigure::Shadow) return shadow_of(posts, wanted, window, done);
    return sky_of(posts, window, done);
}

SunRaster sun_raster(const dem::Posts& posts, const SunRasterWanted& wanted,
                     const dem::Window& part, const std::function<void(double)>& done) {
    return sun_raster_maker(posts, wanted, part, done)(part);
}

void write_sun_raster(OutputFile& file, const dem::Posts& posts, const SunRasterWanted& wanted,
                      const SunRaster* whole, std::int64_t most, const std::string& version,
                      const std::function<void(double)>& done) {
    const dem::Grid& grid = posts.grid();
    const bool is_mask = wanted.figure == SunFigure::Shadow;
    output::RasterWriter writer(file, grid,
                                is_mask ? output::RasterType::Byte : output::RasterType::Float,
                                {band_of(wanted.figure)});
    const auto put = [&](const dem::Window& part, const SunRaster& raster) {
        if (is_mask)
            writer.put(0, part.column, part.row, mask_of(raster.values));
        else
            writer.put(0, part.column, part.row, raster.values);
    };
    const dem::Window all{0, 0, grid.columns(), grid.rows()};
    std::string definition = whole ? whole->definition : "";
    std::int64_t holes = whole ? whole->holes : 0;
    if (whole) {
        put(all, *whole);
    } else {
        double share = 1;
        const SunRasterMaker make = sun_raster_maker(posts, wanted, all, [&](double of_part) {
            if (done) done(share * of_part);
        });
        for (const dem::Window& part :
             posts.in_memory() ? std::vector{all} : raster_parts(all, most)) {
            share = double{1} * part.columns * part.rows / all.columns / all.rows;
            const SunRaster raster = make(part);
            put(part, raster);
            definition = raster.definition;
            holes += raster.holes;
        }
    }
    output::RasterMetadata about =
        raster_metadata(posts, version, definition, kTerrestrialRefraction, holes);
    for (auto& item : metadata_of(posts, wanted))
        about.push_back(std::move(item));
    if (const auto beyond = beyond_of(posts, wanted))
        about.emplace_back(
            "BEYOND_DEM",
            beyond->text(wanted.figure == SunFigure::SkyView ? light::kStandsOver : light::kHides));
    writer.finish(about);
}

}  // namespace relevo::session

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "light/shadows.h"

namespace relevo::cli {
namespace {

struct Arguments {
    RasterArguments raster;
    TimeArguments time;
    RefractionArguments refraction;
    std::string sun;
    bool soft = false;
};

/// A sun, and what is to be said of it.
struct Asked {
    light::SunOverDem sun;
    light::ShadowOptions options;
    double apparent_rad = 0;  ///< elevation as seen from the ground in the middle of the DEM
    std::optional<sun::ParsedTime> when;
    std::string air = "none, the sun was given as seen";
};

/// "AZ,EL" or "grid:AZ,EL". @throws Error (Usage)
light::SunOverDem parse_sun(const std::string& text, const dem::Grid& grid) {
    constexpr std::string_view kGrid = "grid:";
    const bool on_grid = text.starts_with(kGrid);
    const std::vector<std::string> parts =
        split(std::string_view(text).substr(on_grid ? kGrid.size() : 0), ',');
    const auto azimuth_deg = parts.size() == 2 ? parse_number(parts[0]) : std::nullopt;
    const auto elevation_deg = parts.size() == 2 ? parse_number(parts[1]) : std::nullopt;
    if (!azimuth_deg || !elevation_deg || std::abs(*elevation_deg) > 90)
        bad_usage(
            fmt::format("--sun: {}: expected AZ,EL in degrees, clockwise from true north and -90 "
                        "to 90 above the horizon, or grid:AZ,EL from the north of the DEM's map",
                        text));
    light::SunOverDem sun;
    // Whole turns leave no trace: 360 and -720 are 0, without a sign.
    const double within_deg = std::fmod(*azimuth_deg, 360) + 0.0;
    const double turned_rad = radians(within_deg < 0 ? within_deg + 360 : within_deg);
    sun.azimuth_rad = on_grid ? light::true_azimuth_rad(grid, turned_rad) : turned_rad;
    sun.elevation_rad = radians(*elevation_deg);
    sun.semidiameter_rad = sun::semidiameter_rad(1);
    return sun;
}

Asked asked(const Arguments& arguments, const dem::Posts& posts) {
    Asked asked;
    asked.options.refraction = arguments.raster.terrestrial_refraction;
    asked.options.soft = arguments.soft;
    if (!arguments.sun.empty()) {
        asked.sun = parse_sun(arguments.sun, posts.grid());
        asked.apparent_rad = asked.sun.elevation_rad;
        return asked;
    }
    const geo::Geodetic middle = posts.grid().center();
    asked.when = session::parse(
        arguments.time.moment(),
        {.middle = [&] { return middle; }, .posts = [&]() -> const dem::Posts& { return posts; }});
    const sun::Position position = sun::position(asked.when->utc, middle);
    asked.sun = light::SunOverDem::of(position);
    asked.options.air = [&arguments](const geo::Geodetic& place) {
        return arguments.refraction.at(place);
    };
    geo::Geodetic ground = middle;
    const double height_m =
        posts.height_at((posts.grid().columns() - 1) / 2.0, (posts.grid().rows() - 1) / 2.0);
    ground.height_m = std::isnan(height_m) ? posts.lowest_m() : height_m;
    const sun::Refraction air = arguments.refraction.at(ground);
    asked.apparent_rad = air.apparent_rad(position.elevation_rad);
    asked.air = air_of_posts(arguments.refraction, posts);
    return asked;
}

light::RasterFile about(const Arguments& arguments, const Asked& asked,
                        const light::Shadows& shadows, const dem::Posts& posts) {
    light::RasterMetadata more{
        {"SUN_AZIMUTH_DEG", fmt::format("{:.5f}", degrees(asked.sun.azimuth_rad))},
        {"SUN_APPARENT_ELEVATION_DEG", fmt::format("{:.5f}", degrees(asked.apparent_rad))},
        {"SUN_PLACE", "the middle of the DEM; azimuth from true north"},
        {"REFRACTION", asked.air}};
    if (asked.when) {
        more.emplace_back("TIME_UTC", sun::to_iso(asked.when->utc, 3));
        more.emplace_back("SUN_ELEVATION_DEG",
                          fmt::format("{:.5f}", degrees(asked.sun.elevation_rad)));
    }
    return arguments.raster.about(posts, shadows.definition, shadows.holes, std::move(more));
}

void print(const Arguments& arguments, const Asked& asked, const light::Shadows& shadows) {
    if (asked.when)
        fmt::print("time                {}  ({})\n", sun::to_iso(asked.when->utc, asked.when->zone),
                   sun::to_iso(asked.when->utc));
    const double azimuth_deg = degrees(asked.sun.azimuth_rad);
    fmt::print(
        "sun                 azimuth {:.3f} deg ({}), elevation {:.3f} deg as seen, in the "
        "middle of the DEM\n",
        azimuth_deg, compass_point(azimuth_deg), degrees(asked.apparent_rad));
    const auto posts = static_cast<double>(shadows.lit_posts + shadows.shaded_posts);
    fmt::print("{}            {} posts, {:.2f} %\n", arguments.soft ? "some sun" : "lit     ",
               shadows.lit_posts, 100 * static_cast<double>(shadows.lit_posts) / posts);
    fmt::print("in the shade        {} posts, {:.2f} %\n", shadows.shaded_posts,
               100 * static_cast<double>(shadows.shaded_posts) / posts);
    fmt::print("\n{}\nrefraction of the sun: {}\n", shadows.definition, asked.air);
}

light::RasterBand band_of(light::Shadows shadows, bool soft) {
    if (soft) return {"share of the sun's disc", "1", std::move(shadows.lit)};
    Array2d<std::uint8_t> mask(shadows.lit.width(), shadows.lit.height());
    for (std::size_t i = 0; i < mask.size(); ++i) {
        const float lit = shadows.lit.data()[i];
        mask.data()[i] = std::isnan(lit) ? 255 : lit > 0;
    }
    return {"direct sun", "1", std::move(mask)};
}

void run(const Arguments& arguments) {
    const bool timed = arguments.time.given();
    if (timed == !arguments.sun.empty())
        bad_usage(timed ? "--time and --sun exclude each other; give one of them"
                        : "--time: missing; pass --time 2026-06-21T18:30+02:00, or --sun AZ,EL");
    if (!timed && arguments.refraction.given())
        bad_usage("--refraction: goes with --time; --sun is where the sun is seen");
    FilesInUse files;
    OutputFile& file = arguments.raster.open(files);
    const dem::Posts posts = arguments.raster.load();
    const Asked sun = asked(arguments, posts);
    const light::Shadows shadows = light::shadows(posts, sun.sun, sun.options);
    warn_of_holes(shadows.holes);
    light::write_raster(file, posts.grid(), {band_of(shadows, arguments.soft)},
                        about(arguments, sun, shadows, posts));
    print(arguments, sun, shadows);
}

}  // namespace

void add_sun_shadow(CLI::App& sun_verb) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& verb = *sun_verb.add_subcommand(
        "shadow", "What of a DEM lies in the sun at a moment, as a raster");
    arguments->raster.add_to(verb);
    arguments->time.add_to(verb);
    verb.add_option("--sun", arguments->sun,
                    "Instead of a time: AZ,EL in degrees, from true north and as seen in the "
                    "middle of the DEM; grid:AZ,EL from the map's north");
    arguments->refraction.add_to(verb);
    verb.add_flag("--soft", arguments->soft,
                  "How much of the sun's disc is seen, 0 to 1, instead of whether its centre is");
    verb.callback([arguments] { run(*arguments); });
}

}  // namespace relevo::cli

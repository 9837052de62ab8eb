#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "dem/load.h"
#include "dem/pyramid.h"
#include "dem/summary.h"
#include "dem/water.h"
#include "geo/local_frame.h"
#include "render/patch_net.h"
#include "session/climate_words.h"
#include "sun/position.h"

namespace relevo::cli {
namespace {

/// The air over the middle of a DEM.
sun::Refraction air_over(const dem::Summary& summary) {
    // The air over a sea floor begins at the sea; outliers have none.
    const double middle_m = std::clamp(0.5 * (summary.min_m + summary.max_m), 0.0, 9000.0);
    return sun::Refraction::standard({summary.center.lat_rad, summary.center.lon_rad, middle_m});
}

/// How far the net that terrain is drawn on is from the places themselves.
struct NetError {
    int posts = 0;  ///< along a side of a piece of the net
    double worst_m = 0;
};

/// Over pieces all over the DEM, at a height [m], that of its highest post. The pieces are those of
/// ground that is drawn post by post; what is drawn coarser counts its larger error as part of
/// --pixel-error.
NetError net_error(const dem::Grid& grid, double height_m) {
    constexpr int kPosts = dem::Pyramid::kTileQuads, kPieces = 4, kPoints = 16;
    const geo::LocalFrame frame(grid.center());
    const auto place = [&](double column, double row) { return grid.place(column, row); };
    NetError error;
    error.posts = std::min(kPosts, std::max(grid.columns(), grid.rows()) - 1);
    for (int k = 0; k < kPieces * kPieces; ++k) {
        const auto first = [&](int index, int count) {
            return std::max(0.0, (count - 1.0 - error.posts) * index / (kPieces - 1));
        };
        const glm::dvec2 corner(first(k % kPieces, grid.columns()),
                                first(k / kPieces, grid.rows()));
        const render::PatchNet net =
            render::fit_patch_net(place, frame, corner, glm::dvec2(error.posts));
        for (int i = 0; i <= kPoints * kPoints; ++i) {
            const glm::dvec2 at = glm::dvec2(i % kPoints, i / kPoints) / double{kPoints};
            geo::Geodetic exact =
                place(corner.x + at.x * error.posts, corner.y + at.y * error.posts);
            exact.height_m = height_m;
            const double off_m =
                glm::distance(net.place(at.x, at.y, height_m), frame.to_local(exact));
            // Corners of whole-Earth maps are in space.
            if (std::isfinite(off_m)) error.worst_m = std::max(error.worst_m, off_m);
        }
    }
    return error;
}

/// Water as pictures have it; none of DEMs that are too large to be held for this alone, whatever
/// --memory is: what is told of a DEM does not hang on it.
std::optional<dem::Water> water_of(const dem::Source& source) {
    constexpr std::int64_t kMost = std::int64_t{1} << 24;  // 64 MiB
    const dem::Grid& grid = source.grid();
    if (std::int64_t{1} * grid.columns() * grid.rows() > kMost) return std::nullopt;
    return dem::find_water(source.read(), grid);
}

double share(std::int64_t posts, const dem::Grid& grid) {
    return static_cast<double>(posts) / grid.columns() / grid.rows();
}

nlohmann::ordered_json json_of(const std::optional<dem::Water>& water, const dem::Grid& grid) {
    if (!water) return nullptr;
    return {{"sea_share", share(water->sea_posts, grid)},
            {"lake_share", share(water->lake_posts, grid)},
            {"lakes", water->lakes},
            {"assumptions", water->assumptions}};
}

/// A line with its end; empty where there is no water.
std::string text_of(const std::optional<dem::Water>& water, const dem::Grid& grid) {
    if (!water || !water->any()) return "";
    return fmt::format("{:<10} {:.3g} % sea, {:.3g} % lakes ({}), as drawn in pictures\n", "water",
                       100 * share(water->sea_posts, grid), 100 * share(water->lake_posts, grid),
                       water->lakes);
}

/// Parses a time that requires the DEM.
/// @param field  loaded if the time requires heights
sun::ParsedTime parse_over(const scene::TimeSpec& spec, const dem::Source& source,
                           const MemoryBudget& memory, std::optional<dem::Heightfield>& field) {
    if (!sun::is_event_time(spec.at))  // only the time zone is missing
        return session::parse(spec, {.middle = [&] { return source.grid().center(); }});
    field = dem::load(source, memory);
    return session::parse_over(spec, source, *field);
}

/// At the middle of a DEM and of its heights.
session::ClimateReport climate_over(const dem::Summary& summary, sun::Instant utc) {
    geo::Geodetic middle = summary.center;
    middle.height_m = session::middle_height_m(summary.min_m, summary.max_m);
    return session::climate_report(climate::ClimateMap::shipped(), middle, utc);
}

nlohmann::ordered_json to_json(const session::ClimateReport& report) {
    const auto line = [](const std::optional<double>& line_m) {
        return line_m ? nlohmann::ordered_json(std::round(*line_m)) : nlohmann::ordered_json();
    };
    return {{"height_m", report.height_m},
            {"january_c", report.january_c},
            {"july_c", report.july_c},
            {"year_mm", report.year_mm},
            {"tree_line_m", line(report.tree_line_m)},
            {"ice_line_m", line(report.ice_line_m)},
            {"date", sun::to_string(report.date)},
            {"snow_line_m", line(report.snow_line_m)},
            {"ground_cover", climate::name_of(report.cover)},
            {"land_cover", session::kLandCoverText}};
}

/// What depends on the time.
struct Moment {
    sun::Instant utc;
    sun::Position sun;
    sun::Refraction air;
    session::ClimateReport climate;
};

/// At the time given, else now; none, with a notice, where the computer's clock is outside of the
/// years that are computed.
std::optional<Moment> moment_of(const dem::Summary& summary,
                                const std::optional<sun::ParsedTime>& given) {
    const sun::Instant utc = given ? given->utc : sun::Instant::now();
    if (!given && !sun::is_in_years(utc)) {
        log::warning(fmt::format(
            "sun and climate are computed for the years {} to {}, but this computer's clock says "
            "{}; set it, or add --time",
            sun::kFirstYear, sun::kLastYear, sun::to_iso(utc)));
        return std::nullopt;
    }
    return Moment{utc, sun::position(utc, summary.center), air_over(summary),
                  climate_over(summary, utc)};
}

nlohmann::ordered_json sun_json(const Moment& at) {
    return {{"utc", sun::to_iso(at.utc)},
            {"azimuth_deg", degrees(at.sun.azimuth_rad)},
            {"elevation_deg", degrees(at.sun.elevation_rad)},
            {"apparent_elevation_deg", degrees(at.air.apparent_rad(at.sun.elevation_rad))}};
}

}  // namespace

void add_info(Verb app) {
    struct InfoArguments {
        DemArguments dem;
        TimeArguments time;
        bool json = false;
    };
    const auto arguments = std::make_shared<InfoArguments>();
    const Verb verb = app.add_verb("info", "Describes a DEM and all assumptions about it");
    arguments->dem.add_to(verb);
    arguments->time.add_to(verb);
    verb.add_flag("--json", arguments->json, "One JSON object on standard output");
    verb.callback([arguments] {
        const scene::TimeSpec spec = arguments->time.spec();
        std::optional<sun::ParsedTime> given_time;
        if (arguments->time.given() && !session::needs_dem(spec)) given_time = session::parse(spec);
        const MemoryBudget memory = arguments->dem.options().memory;
        const dem::Source source =
            dem::Source::open(arguments->dem.paths, arguments->dem.options());
        std::optional<dem::Heightfield> field;
        if (arguments->time.given() && !given_time)
            given_time = parse_over(spec, source, memory, field);
        // Means would hide the lowest and the highest post.
        const dem::Summary summary = field && field->reduction == 1
                                         ? dem::summarize(*field)
                                         : dem::summarize(source, memory.posts);
        const std::optional<Moment> moment = moment_of(summary, given_time);
        const std::optional<dem::Water> water = water_of(source);
        if (arguments->json) {
            const NetError net = net_error(source.grid(), summary.max_m);
            auto json = nlohmann::ordered_json::parse(dem::to_json(summary));
            if (moment) {
                json["sun"] = sun_json(*moment);
                json["climate"] = to_json(moment->climate);
            }
            if (given_time && !given_time->assumption.empty())
                json["assumptions"].push_back(given_time->assumption);
            json["position_net"] = {{"piece_posts", net.posts}, {"error_m", net.worst_m}};
            json["water"] = json_of(water, source.grid());
            fmt::print("{}", json_text(with_schema("relevo-info-1", json)));
            return;
        }
        fmt::print("{}", dem::to_text(summary));
        fmt::print("{}", text_of(water, source.grid()));
        if (moment) {
            fmt::print("{:<10} {} at {}\n", "sun", session::sun_text(moment->sun, moment->air),
                       sun::to_iso(moment->utc));
            fmt::print("{:<10} {}\n", "climate", session::climate_text(moment->climate));
            fmt::print("{:<10} {}\n", "ground", session::ground_text(moment->climate));
            fmt::print("{:<10} {}\n", "land cover", session::kLandCoverText);
        }
        if (log::level() == log::Level::Debug) {
            const NetError net = net_error(source.grid(), summary.max_m);
            const double spacing_m = std::min(summary.post_spacing_m.x, summary.post_spacing_m.y);
            fmt::print(
                "{:<10} pieces of {} posts: drawn positions are within {:.2g} m, {:.2g} of the "
                "post spacing\n",
                "net", net.posts, net.worst_m, net.worst_m / spacing_m);
        }
    });
}

}  // namespace relevo::cli

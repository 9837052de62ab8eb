#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/day_verb.h"
#include "cli/plane_table.h"
#include "cli/sun.h"
#include "light/plane/horizon_file.h"
#include "light/plane/irradiance_file.h"
#include "light/point/clear_sky.h"
#include "light/raster/ground_slope.h"

namespace relevo::cli {
namespace {

using light::SkyModel;
using light::SumBy;

struct PlaneArguments : DayArguments {
    std::string tilt = "0", azimuth, horizon, irradiance, interval, by = "hour", sky = "isotropic";
    std::optional<double> albedo;
    std::vector<std::string> linke;
};

std::string fault_of_linke(const std::string& text) {
    return fault_in(figure::kLinke, text, " but got {}");
}

struct SkyWord {
    const char *word, *text;
    SkyModel model;
};
constexpr std::array kSkies{
    SkyWord{"isotropic", "isotropic", SkyModel::Isotropic},
    SkyWord{"hay-davies", "Hay and Davies 1980", SkyModel::HayDavies},
    SkyWord{"perez", "Perez et al. 1990, all sites, air mass of Kasten and Young 1989",
            SkyModel::Perez}};

const SkyWord& sky_of(const PlaneArguments& arguments) {
    return *std::ranges::find(kSkies, arguments.sky,
                              [](const SkyWord& sky) { return std::string_view(sky.word); });
}

std::optional<SumBy> sum_by(const PlaneArguments& arguments) {
    const std::string& by = arguments.by;
    if (by == "hour") return std::nullopt;
    return by == "day"     ? SumBy::Day
           : by == "month" ? SumBy::Month
           : by == "year"  ? SumBy::Year
                           : SumBy::HourOfMonth;
}

/// What is the same for all places of a run.
struct PlaneRun {
    const PlaneArguments& arguments;
    std::optional<light::IrradianceTable> table;
    /// Of --horizon, for places of the northern and of the southern half of the Earth.
    std::optional<std::array<light::FileHorizon, 2>> horizons;
    std::optional<dem::Posts> posts;

    double linke(sun::Instant utc, const sun::Zone& zone) const {
        const auto month = static_cast<std::size_t>(zone.local(utc).wall.date.month - 1);
        const std::vector<std::string>& given = arguments.linke;
        if (given.empty()) return figure::kLinke.value;
        return *parse_number(given.size() == 1 ? given.front() : given[month]);
    }
};

/// What can be said before any file is read.
void check(const PlaneArguments& arguments) {
    if (arguments.irradiance.empty()) {
        if (!arguments.interval.empty()) bad_usage("--interval: needs --irradiance");
        if (!arguments.days.given())
            bad_usage(
                "--date: missing; pass --date, --from and --to, or --year, or a table with "
                "--irradiance");
    } else if (!arguments.linke.empty()) {
        bad_usage("--linke: for a clear sky; --irradiance has the light of its own sky");
    }
    if (arguments.linke.size() > 1 && arguments.linke.size() != 12)
        bad_usage(fmt::format("--linke: {} values, expected one, or twelve for the months",
                              arguments.linke.size()));
    if (!arguments.interval.empty() && !light::RowTime::parse(arguments.interval))
        bad_usage(
            fmt::format("--interval: expected end, begin, instant, or instant+H with H from 0 to "
                        "less than 1 hour, but got {}",
                        arguments.interval));
    if (arguments.days.given()) arguments.days.parse({}, false);
    if (arguments.terrain.given()) return;
    if (arguments.tilt == "ground") bad_usage("--tilt: ground needs a DEM");
    if (arguments.place.eye_height_m) bad_usage("--eye-height: needs a DEM");
}

light::IrradianceTable read_table(const PlaneArguments& arguments) {
    light::IrradianceOptions options;
    if (!arguments.interval.empty()) options.interval = light::RowTime::parse(arguments.interval);
    if (!sun::is_zone_by_place(arguments.days.zone))
        options.zone = sun::choose_zone(arguments.days.zone, {}).zone;
    light::IrradianceTable table =
        light::read_irradiance(arguments.irradiance, "--irradiance", options);
    if (table.sparse && sum_by(arguments))
        bad_usage(fmt::format("--by: {}: instants more than an hour apart have no sums; use hour",
                              arguments.by));
    return table;
}

/// A plane as options or columns of --points say.
light::Plane plane_of(const PlaneArguments& arguments, const dem::NamedPlace& point,
                      const light::TerrainHorizon* ground) {
    const bool own = !point.tilt.empty() || !point.azimuth.empty();  // by a line of the points
    const auto refuse = [&](const std::string& what) {
        if (own) bad_input(fmt::format("--points: line {}: {}", point.line, what));
        bad_usage(what);
    };
    const std::string& tilt = point.tilt.empty() ? arguments.tilt : point.tilt;
    const std::string& azimuth = point.azimuth.empty() ? arguments.azimuth : point.azimuth;
    if (const std::string fault = fault_of_tilt(tilt); !fault.empty()) refuse("tilt: " + fault);
    if (const std::string fault = azimuth.empty() ? "" : fault_of_azimuth(azimuth); !fault.empty())
        refuse("azimuth: " + fault);
    if (tilt != "ground") {
        const double tilt_deg = *parse_number(tilt);
        if (azimuth.empty() && tilt_deg > 0)
            refuse("--azimuth: missing; where the plane faces: 0 north, 90 east, 180 south");
        return {radians(tilt_deg), azimuth.empty() ? 0 : radians(*parse_number(azimuth))};
    }
    if (!ground) refuse("--tilt: ground needs a DEM");
    if (!azimuth.empty()) refuse("--azimuth: a tilt of ground has the azimuth of the DEM");
    const glm::dvec2 post = ground->post();
    const glm::dvec2 rise = light::rise_at(ground->posts(), static_cast<int>(std::lround(post.x)),
                                           static_cast<int>(std::lround(post.y)));
    const double azimuth_rad = std::atan2(-rise.x, -rise.y);
    return {std::atan(std::hypot(rise.x, rise.y)),
            azimuth_rad < 0 ? azimuth_rad + 2 * kPi : azimuth_rad};
}

/// The rows that the dates select, by the file's clock.
std::vector<light::Irradiance> selected(const PlaneArguments& arguments,
                                        const light::IrradianceTable& table) {
    if (!arguments.days.given()) return table.rows;
    const report::Days asked = arguments.days.parse({}, false);
    std::vector<light::Irradiance> rows;
    for (const light::Irradiance& row : table.rows) {
        const sun::Date date = table.clock.local(row.span.begin).wall.date;
        if (date >= asked.first && date <= asked.last) rows.push_back(row);
    }
    if (rows.empty())
        bad_input(fmt::format("--irradiance: {}: no rows from {} to {}; it has {} to {}",
                              arguments.irradiance, sun::to_string(asked.first),
                              sun::to_string(asked.last),
                              sun::to_iso(table.rows.front().span.begin, table.clock),
                              sun::to_iso(table.rows.back().span.end, table.clock)));
    return rows;
}

std::vector<sun::TimeSpan> hours_of(const report::Days& asked) {
    std::vector<sun::TimeSpan> hours;
    for (const sun::LocalDay& day : sun::local_days(asked.first, asked.last, asked.zone))
        for (sun::Instant begin = day.span.begin; begin < day.span.end; begin = begin + kHour_s)
            hours.push_back({begin, std::min(begin + kHour_s, day.span.end)});
    return hours;
}

/// The hours of one place, as the table or the clear sky has them.
light::PlaneLight::Result light_of(const PlaneRun& run, const light::PlaneLight& light,
                                   PlaneTable& result) {
    const PlaneArguments& arguments = run.arguments;
    if (!run.table) {
        const report::Days asked = arguments.days.parse(result.place, !arguments.points.given());
        result.zone = asked.zone;
        result.assumption = asked.assumption;
        return light.clear(hours_of(asked),
                           [&](sun::Instant utc) { return run.linke(utc, asked.zone); });
    }
    const light::IrradianceTable& table = *run.table;
    result.zone = table.clock;
    if (!arguments.days.zone.empty())
        result.zone = sun::choose_zone(arguments.days.zone, result.place).zone;
    result.typical = table.typical;
    if (const auto misfit = light.misfit(table.rows, table.instant_s))
        bad_input(fmt::format(
            "--irradiance: {}: {} {}: {}; times do not fit {}: check --at, --interval and the "
            "file's zone",
            arguments.irradiance, table.unit, misfit->line, misfit->what,
            geo::degrees_text(result.place)));
    return light.of(selected(arguments, table), table.instant_s);
}

using Remarks = std::vector<std::pair<std::string, std::string>>;

/// What is the same for all places of a run: key of the JSON, and text.
Remarks remarks_of(const PlaneRun& run) {
    const PlaneArguments& arguments = run.arguments;
    const std::string source =
        run.table ? fmt::format("{}: {}", printable(arguments.irradiance), run.table->description)
                  : fmt::format("clear sky of Rigollier et al. 2000 (ESRA), Linke turbidity {}",
                                arguments.linke.empty()
                                    ? fmt::format("{}", figure::kLinke.value)
                                    : fmt::format("{}", fmt::join(arguments.linke, ", ")));
    return {
        {"definition",
         fmt::format("{}; beam + diffuse + reflected = global; open_global: over a level horizon",
                     sum_by(arguments) ? "sums, kWh/m2, by the local time at which hours begin"
                                       : "means over the hour that begins at time, W/m2")},
        {"beam_definition",
         "beam: DNI, spread evenly over the seconds with the sun up, counts in the lit seconds; "
         "azimuth and elevation: in the middle of the hour's part with the sun up"},
        {"sky_definition", fmt::format("sky: {}; ground: albedo {}", sky_of(arguments).text,
                                       arguments.albedo.value_or(figure::kAlbedo.value))},
        {"source", "irradiance: " + source},
        {"solar_constant",
         fmt::format("solar constant: {} W/m2 at 1 au in the clear sky, {} in models of the sky",
                     light::ClearSky::kSolarConstant, light::kSkySolarConstant)}};
}

/// What is of one place.
void add_remarks(const light::PlaneLight& light, const light::DirectLight& level,
                 const std::string& horizon, PlaneTable& table) {
    table.remarks.emplace_back(
        "plane", fmt::format("plane: tilt {:.6g}, azimuth {:.6g} degrees clockwise from north; it "
                             "sees {:.7f} of an even sky, {:.7f} over a level horizon",
                             angle_deg(table.plane.tilt_rad), angle_deg(table.plane.azimuth_rad),
                             light.sky(), light.level_sky()));
    table.remarks.emplace_back("sun_definition", level.definition());
    table.remarks.emplace_back("horizon_definition", horizon);
}

PlaneTable table_of(const PlaneRun& run, const dem::NamedPlace& point) {
    const PlaneArguments& arguments = run.arguments;
    PlaneTable result;
    result.by = sum_by(arguments);
    result.place = point.at.place;
    std::unique_ptr<const light::TerrainHorizon> ground;
    if (run.posts) {
        ground = std::make_unique<light::TerrainHorizon>(*run.posts, point.at.place,
                                                         arguments.view().horizon(point.at));
        result.place = ground->place();
    } else {
        report::check_has_ground(point.at);
    }
    const light::LightOptions options = arguments.view().light(result.place);
    const light::DirectLight level(result.place, light::Skyline({0.0}), "a level horizon", options);
    std::unique_ptr<const light::DirectLight> over;
    std::string horizon = "horizon: level";
    if (run.horizons) {
        const light::FileHorizon& file = (*run.horizons)[result.place.lat_rad < 0 ? 1 : 0];
        horizon = "horizon: " + file.description;
        over = std::make_unique<light::DirectLight>(result.place, file.skyline(),
                                                    "the horizon of a file", options);
    } else if (ground) {
        horizon = ground->description();
        over = std::make_unique<light::DirectLight>(*ground, options);
    }
    result.plane = plane_of(arguments, point, ground.get());
    const light::PlaneLight light(
        {result.plane, sky_of(arguments).model, arguments.albedo.value_or(figure::kAlbedo.value)},
        level, over.get());
    light::PlaneLight::Result found = light_of(run, light, result);
    if (ground && arguments.horizon.empty())
        result.doubt = light::doubt_of(*over, found.lit, ground->profile(report::kDoubtDirections),
                                       arguments.terrain.highest_m);
    result.hours = std::move(found.hours);
    result.remarks = remarks_of(run);
    add_remarks(light, level, horizon, result);
    return result;
}

void warn_of_distance(const PlaneRun& run, const geo::Geodetic& place) {
    constexpr double kNear_m = 100e3;
    if (!run.table || !run.table->place) return;
    const double distance_m = geo::geodesic(place, *run.table->place).distance_m;
    if (distance_m > kNear_m)
        log::warning(fmt::format("--irradiance: {} is of {}, {:.0f} km away",
                                 run.arguments.irradiance, geo::degrees_text(*run.table->place),
                                 distance_m / 1000));
}

void run_points(PlaneRun& run, FilesInUse& files, const OpenResults& results) {
    const PlaneArguments& arguments = run.arguments;
    const auto points = arguments.points.read(files, arguments.output);
    if (arguments.terrain.given()) run.posts.emplace(arguments.terrain.load());
    const auto forms = [&](const dem::NamedPlace& point) {
        const auto table = std::make_shared<const PlaneTable>(table_of(run, point));
        return PointForms{.rows = [=] { return plane_rows(*table); },
                          .json = [=] { return plane_json(*table); },
                          .doubt = table->doubt};
    };
    std::vector<std::string> remarks;
    for (const auto& [key, text] : remarks_of(run))
        remarks.push_back(text);
    remarks.emplace_back("plane, sun and horizon of each point: --json");
    deliver_points(arguments.points, points, {plane_columns(sum_by(arguments)), remarks, forms},
                   arguments.output, results,
                   !run.table && sun::is_zone_by_place(arguments.days.zone));
}

void run_plane(const PlaneArguments& arguments) {
    check(arguments);
    FilesInUse files;
    const OpenResults results = arguments.output.open(files, arguments.terrain.dem);
    PlaneRun run{arguments, {}, {}, {}};
    if (!arguments.horizon.empty()) {
        files.add_input(arguments.horizon, "the horizon");
        run.horizons.emplace();
        for (const bool southern : {false, true})
            (*run.horizons)[southern ? 1 : 0] =
                light::read_horizon(arguments.horizon, "--horizon", southern);
    }
    if (!arguments.irradiance.empty()) {
        files.add_input(arguments.irradiance, "the irradiance");
        run.table = read_table(arguments);
    }
    if (arguments.points.given()) return run_points(run, files, results);
    const dem::NamedPlace point{.at = arguments.place.parse()};
    if (arguments.terrain.given()) run.posts.emplace(arguments.terrain.load());
    const PlaneTable table = table_of(run, point);
    warn_of_distance(run, table.place);
    report::warn_of(table.doubt);
    arguments.output.deliver({.csv = [&] { return plane_csv(table); },
                              .json = [&] { return plane_json(table); },
                              .print = [&] { fmt::print("{}", plane_csv(table)); }},
                             results);
}

void add_plane_options(Verb verb, PlaneArguments& arguments) {
    verb.add_option(
            "--tilt", arguments.tilt,
            "Tilt of the plane, degrees: 0 level, 90 a wall; or ground: slope and aspect of "
            "the DEM (0)")
        .check({fault_of_tilt, ""});
    verb.add_option("--azimuth", arguments.azimuth,
                    "Where the plane faces, degrees clockwise from true north; needed for a tilt")
        .check({fault_of_azimuth, ""});
    verb.add_option("--horizon", arguments.horizon,
                    "Horizon of a file instead of the DEM's: CSV (azimuth, elevation), pvlib, "
                    "PVGIS, PVsyst");
    verb.add_option("--irradiance", arguments.irradiance,
                    "Irradiance of a file instead of a clear sky: EPW, TMY of PVGIS or NSRDB, CSV "
                    "(time or begin,end; ghi,dni,dhi in W/m2); also .gz");
    verb.add_option("--interval", arguments.interval,
                    "What a CSV's time is: end or begin of a row, instant, or instant+H, H hours "
                    "later");
    verb.add_option("--by", arguments.by, "Rows: hour, day, month, year, hour-of-month (hour)")
        .check(one_of({"hour", "day", "month", "year", "hour-of-month"}));
    verb.add_option("--sky", arguments.sky,
                    "Model of the diffuse sky: isotropic, hay-davies, perez (isotropic)")
        .check(one_of({"isotropic", "hay-davies", "perez"}));
    verb.add_option("--albedo", arguments.albedo, "Albedo of the ground: 0.2 grass, 0.8 snow (0.2)")
        .check(in_range(figure::kAlbedo));
    verb.add_option("--linke", arguments.linke,
                    "Linke turbidity of the clear sky: 2 clean, 3 country, 5 city; or twelve, for "
                    "the months, with commas (3)")
        .delimiter(',')
        .one_word()
        .check({fault_of_linke, ""});
}

}  // namespace

void add_sun_plane(Verb sun_verb) {
    const auto arguments = std::make_shared<PlaneArguments>();
    const Verb verb = sun_verb.add_verb(
        "plane", "Irradiance on a plane at a point: beam, diffuse, reflected, hour by hour");
    arguments->terrain.add_to(verb);
    verb.option("DEM").required(false);
    arguments->place.add_to(verb);
    arguments->points.add_to(verb);
    add_plane_options(verb, *arguments);
    arguments->days.add_to(verb);
    verb.option("--tz").description(
        "Time zone of the rows: Europe/Zurich, +05:30, solar, or auto (the zone of the place); "
        "without it the zone of --irradiance, else auto");
    arguments->light.add_to(verb);
    arguments->output.add_to(verb, {"csv", "json"});
    verb.callback([arguments] { run_plane(*arguments); });
}

}  // namespace relevo::cli

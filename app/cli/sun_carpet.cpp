#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "chart/carpet_chart.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "geo/format.h"
#include "light/point/carpet.h"

namespace relevo::cli {
namespace {

using nlohmann::ordered_json;

struct CarpetArguments {
    TerrainArguments terrain;
    PlaceArguments place;
    DaysArguments days;
    std::string step = "3min";
    LightArguments light;
    OutputArguments output;
};

struct MonthSums {
    double lit_s = 0, level_s = 0;
};

std::vector<MonthSums> months_of(const light::Carpet& carpet) {
    std::vector<MonthSums> months(12);
    for (std::size_t i = 0; i < carpet.days.size(); ++i) {
        MonthSums& month = months[static_cast<std::size_t>(carpet.days[i].date.month - 1)];
        month.lit_s += carpet.days[i].lit_s;
        month.level_s += carpet.day_level_s[i];
    }
    return months;
}

/// Where holes of the DEM leave the light open; empty where they do not.
std::string holes_text(const light::Carpet& carpet, const light::Doubt& doubt) {
    if (doubt.holes.empty()) return {};
    return fmt::format(
        "not known: {:.2f} h of the direct sun, through voids of the DEM {}, where ground as high "
        "as its highest post would hide it",
        carpet.not_known_s / 3600, sectors_text(doubt.holes));
}

ordered_json json_of(const light::Carpet& carpet, const std::string& assumption,
                     const light::TerrainHorizon& horizon, const light::Doubt& doubt) {
    ordered_json json;
    json["place"] = place_json(horizon.place());
    json["zone"] = carpet.zone.name();
    add_assumption(json, assumption);
    json["year"] = carpet.year;
    json["light_definition"] = carpet.definition;
    json["horizon_definition"] = horizon.description();
    json["direct_sun_h"] = carpet.lit_s / 3600;
    json["level_horizon_h"] = carpet.level_s / 3600;
    const bool holes = !doubt.holes.empty();
    if (holes) {
        json["not_known_h"] = carpet.not_known_s / 3600;
        json["hole_sectors"] = sectors_json(doubt.holes);
    }
    ordered_json& months = json["months"] = ordered_json::array();
    for (const MonthSums& month : months_of(carpet))
        months.push_back(
            {{"direct_sun_h", month.lit_s / 3600}, {"level_horizon_h", month.level_s / 3600}});
    ordered_json& days = json["days"] = ordered_json::array();
    for (std::size_t i = 0; i < carpet.days.size(); ++i) {
        const light::LightDay& day = carpet.days[i];
        ordered_json lit = ordered_json::array();
        for (const light::LitInterval& interval : day.lit) {
            lit.push_back({{"first_utc", utc_json(interval.begin.utc)},
                           {"last_utc", utc_json(interval.end.utc)}});
            if (!interval.not_known.empty())
                lit.back()["not_known"] = spans_json(interval.not_known);
        }
        days.push_back({{"date", sun::to_string(day.date)},
                        {"direct_sun", lit},
                        {"direct_sun_h", day.lit_s / 3600},
                        {"level_horizon_h", carpet.day_level_s[i] / 3600}});
        if (holes) days.back()["not_known_h"] = day.not_known_s / 3600;
    }
    return json;
}

std::string csv_of(const light::Carpet& carpet, const light::TerrainHorizon& horizon,
                   const light::Doubt& doubt) {
    std::vector<std::string> remarks{
        fmt::format("{}, {:.1f} m; columns: what there is at that time of day in {}",
                    geo::degrees_text(horizon.place()), horizon.place().height_m,
                    carpet.zone.name()),
        carpet.definition, horizon.description()};
    if (!doubt.holes.empty()) remarks.push_back(holes_text(carpet, doubt));
    std::string text = csv_remarks(remarks);
    text += "date,direct_sun_h,level_horizon_h";
    for (int column = 0; column < carpet.light.width(); ++column) {
        const long ms = std::lround(carpet.time_of_day_s(column) * 1000);
        text += fmt::format(",{:02}:{:02}:{:02}", ms / 3600000, ms / 60000 % 60, ms / 1000 % 60);
        if (ms % 1000 != 0) text += fmt::format(".{:03}", ms % 1000);
    }
    text += '\n';
    for (int row = 0; row < carpet.light.height(); ++row) {
        const auto i = static_cast<std::size_t>(row);
        text += fmt::format("{},{:.4f},{:.4f}", sun::to_string(carpet.days[i].date),
                            carpet.days[i].lit_s / 3600, carpet.day_level_s[i] / 3600);
        for (int column = 0; column < carpet.light.width(); ++column) {
            text += ',';
            text += light::name_of(carpet.light.at(column, row));
        }
        text += '\n';
    }
    return text;
}

void print_text(const light::Carpet& carpet, const light::TerrainHorizon& horizon,
                const light::Doubt& doubt) {
    fmt::print("place               {}, {:.0f} m\n", geo::degrees_text(horizon.place()),
               horizon.place().height_m);
    fmt::print("year                {}, {}\n\n", carpet.year, carpet.zone.name());
    fmt::print("month     direct sun   level horizon   share\n");
    const auto line = [](const std::string& name, double lit_s, double level_s) {
        fmt::print("{:<8}{:10.2f} h{:14.2f} h{:6.1f} %\n", name, lit_s / 3600, level_s / 3600,
                   level_s > 0 ? 100 * lit_s / level_s : 0);
    };
    const std::vector<MonthSums> months = months_of(carpet);
    for (std::size_t i = 0; i < 12; ++i)
        line(fmt::format("{}-{:02}", carpet.year, i + 1), months[i].lit_s, months[i].level_s);
    line(std::to_string(carpet.year), carpet.lit_s, carpet.level_s);
    int dark = 0;
    for (const light::LightDay& day : carpet.days)
        dark += day.lit.empty();
    fmt::print("\ndays without direct sun: {}\n\n{}\n{}\n", dark, carpet.definition,
               horizon.description());
    if (!doubt.holes.empty()) fmt::print("{}\n", holes_text(carpet, doubt));
}

void run_carpet(const CarpetArguments& arguments) {
    const OutputArguments& output = arguments.output;
    FilesInUse files;
    OutputFile* const file = output.open(files, arguments.terrain.dem);
    const DaysArguments::Days asked = arguments.days.parse(arguments.place.parse().place);
    const double step_s = step_s_of(arguments.step, 1, 86400);
    if (step_s != std::round(step_s))
        bad_usage(fmt::format("--step: {}: expected whole seconds, such as 3min, 10min or 30s",
                              arguments.step));
    const std::unique_ptr<TerrainView> view = arguments.terrain.view_from(arguments.place);
    const light::TerrainHorizon& horizon = view->horizon;
    const light::DirectLight direct(
        horizon, arguments.light.light(horizon.place(), arguments.place.eye_height_m));
    const light::Carpet carpet =
        light::carpet(direct, asked.first.year, asked.zone, static_cast<int>(std::lround(step_s)));
    const light::Doubt doubt = light::doubt_of(
        direct, carpet.days, horizon.profile(kDoubtDirections), arguments.terrain.highest_m);
    warn_of(doubt);

    output.deliver({.drawing =
                        [&] {
                            chart::CarpetChart chart;
                            chart.carpet = &carpet;
                            chart.place = horizon.place();
                            chart.place_name = arguments.place.name;
                            chart.horizon_definition = horizon.description();
                            return chart.draw();
                        },
                    .csv = [&] { return csv_of(carpet, horizon, doubt); },
                    .json = [&] { return json_of(carpet, asked.assumption, horizon, doubt); },
                    .print = [&] { print_text(carpet, horizon, doubt); }},
                   file);
}

}  // namespace

void add_sun_carpet(Verb sun_verb) {
    const auto arguments = std::make_shared<CarpetArguments>();
    const Verb verb =
        sun_verb.add_verb("carpet", "A year of direct sun at a point, day by time of day");
    arguments->terrain.add_to(verb);
    arguments->place.add_to(verb);
    arguments->days.add_year_to(verb);
    verb.option("--year").required();
    verb.add_option("--step", arguments->step,
                    "Step of the time of day (3min), or minutes alone; divides a day");
    arguments->light.add_to(verb);
    arguments->output.add_to(verb, {"png", "svg", "csv", "json"});
    verb.callback([arguments] { run_carpet(*arguments); });
}

}  // namespace relevo::cli

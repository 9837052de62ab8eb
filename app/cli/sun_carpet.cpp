#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "chart/carpet_chart.h"
#include "cli/sun.h"
#include "cli/sun_options.h"
#include "geo/format.h"
#include "report/carpet.h"

namespace relevo::cli {
namespace {

struct CarpetArguments {
    TerrainArguments terrain;
    PlaceArguments place;
    DaysArguments days;
    std::string step = "3min";
    LightArguments light;
    OutputArguments output;
};

/// Where holes of the DEM leave the light open; empty where they do not.
std::string holes_text(const light::Carpet& carpet, const light::Doubt& doubt) {
    if (doubt.holes.empty()) return {};
    return fmt::format(
        "not known: {:.2f} h of the direct sun, through voids of the DEM {}, where ground as high "
        "as its highest post would hide it",
        carpet.not_known_s / 3600, report::sectors_text(doubt.holes));
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
    const auto months = report::months_of(carpet);
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
    const OpenResults results = output.open(files, arguments.terrain.dem);
    const report::Days asked = arguments.days.parse(arguments.place.parse().place);
    const double step_s = step_s_of(arguments.step, 1, 86400);
    if (step_s != std::round(step_s))
        bad_usage(fmt::format("--step: {}: expected whole seconds, such as 3min, 10min or 30s",
                              arguments.step));
    const geo::PlaceText at = arguments.place.parse();
    const report::View view =
        arguments.terrain.view(arguments.place.eye_height_m, arguments.light.view());
    const light::HorizonOptions options = view.horizon(at);
    const dem::Posts posts = arguments.terrain.load();
    const light::TerrainHorizon horizon(posts, at.place, options);
    const report::Carpet result =
        report::carpet(view, horizon, asked, static_cast<int>(std::lround(step_s)));
    const light::Carpet& carpet = result.carpet;
    report::warn_of(result.doubt);

    output.deliver({.drawing =
                        [&] {
                            chart::CarpetChart chart;
                            chart.carpet = &carpet;
                            chart.place = horizon.place();
                            chart.place_name = arguments.place.name;
                            chart.horizon_definition = horizon.description();
                            return chart.draw();
                        },
                    .csv = [&] { return csv_of(carpet, horizon, result.doubt); },
                    .json = [&] { return nlohmann::ordered_json::parse(json_of(result)); },
                    .print = [&] { print_text(carpet, horizon, result.doubt); }},
                   results);
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

#include "light/raster/sun_hours.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "session/hours_bands.h"
#include "session/sun_raster.h"

namespace relevo::cli {
namespace {

struct HoursArguments {
    RasterArguments raster;
    DaysArguments days;
    RefractionArguments refraction;
    std::optional<std::string> step;
    std::vector<std::string> bands{"hours"};
    std::optional<double> linke, albedo;
};

bool has_spells(const std::vector<std::string>& bands) {
    return std::ranges::any_of(bands, session::needs_spells);
}

sun::TimeSpan time_of(const DaysArguments::Days& days) {
    return {days.zone.day(days.first).begin, days.zone.day(days.last).end};
}

constexpr const char* kCommas = "separate bands with commas and no blanks: hours,first";

bool is_band(const std::string& word) {
    return contains(session::hours_words(), word);
}

/// What is wrong with a band; empty: nothing.
std::string check_band(const std::string& band) {
    if (is_band(band)) return {};
    if (trimmed(band).empty() || band.find(' ') != std::string::npos) return kCommas;
    return fmt::format("expected some of {} but got {}", fmt::join(session::hours_words(), ", "),
                       band);
}

/// What can be said before the DEM is read.
void check(const HoursArguments& arguments) {
    const std::vector<std::string>& bands = arguments.bands;
    for (const std::string& path : arguments.raster.dem.paths)
        if (is_band(path) && !std::filesystem::exists(path))
            bad_usage(fmt::format("--bands: {}: {}", path, kCommas));
    if (arguments.step) step_s_of(*arguments.step, 1, 3600);
    for (std::size_t i = 0; i < bands.size(); ++i)
        if (std::find(bands.begin(), bands.begin() + static_cast<std::ptrdiff_t>(i), bands[i]) !=
            bands.begin() + static_cast<std::ptrdiff_t>(i))
            bad_usage(fmt::format("--bands: {} is named twice", bands[i]));
    if ((arguments.linke || arguments.albedo) &&
        std::ranges::none_of(bands, session::needs_irradiation))
        bad_usage(fmt::format("{}: needs --bands global, beam, diffuse or reflected",
                              arguments.linke ? "--linke" : "--albedo"));
    const auto [begin, end] = time_of(arguments.days.parse({}, false));
    if (end - begin <= 86400 * light::SunHoursOptions::kMostDays) return;
    if (arguments.step)
        bad_usage(fmt::format(
            "--step: for at most {:.10g} days; longer periods use directions of the sun",
            light::SunHoursOptions::kMostDays));
    if (has_spells(bands))
        bad_usage(
            fmt::format("--bands: first, last and spells are available for at most {:.10g} days",
                        light::SunHoursOptions::kMostDays));
}

/// Of all parts.
struct Summary {
    static constexpr double kMore_h = 0.1;  // than over a level horizon: of account

    double hours = 0, posts = 0, least = INFINITY, most = -INFINITY, level_hours = 0;
    double most_level_hours = 0, over_level = 0;  // the latter: posts
    std::string definition;

    void add(const light::SunHours& part) {
        const auto with_light =
            static_cast<double>(part.hours.size()) - static_cast<double>(part.holes);
        if (with_light > 0) hours += part.mean_hours * with_light;
        posts += with_light;
        for (const float value : part.hours)
            if (!std::isnan(value)) {
                least = std::min(least, double{value});
                most = std::max(most, double{value});
                over_level += value > part.most_level_hours + kMore_h;
            }
        level_hours = part.level_hours;
        most_level_hours = part.most_level_hours;
        definition = part.definition;
    }

    void say_more_than_level() const {
        if (over_level == 0) return;
        log::info(fmt::format(
            "more sun than over a level horizon at {:.2g} % of the posts, by up to {:.2f} h: over "
            "lower ground, or over heights that are not real (relevo info, --nodata)",
            100 * over_level / posts, most - most_level_hours));
    }
};

light::SunHoursOptions options_of(const HoursArguments& arguments) {
    light::SunHoursOptions options;
    options.refraction = arguments.raster.terrestrial_refraction;
    options.air = [&](const geo::Geodetic& place) { return arguments.refraction.at(place); };
    options.step_s = step_s_of(arguments.step.value_or("3min"), 1, 3600);
    options.spells = has_spells(arguments.bands);
    if (std::ranges::any_of(arguments.bands, session::needs_irradiation)) {
        options.irradiation.emplace();
        if (arguments.linke) options.irradiation->linke = *arguments.linke;
        if (arguments.albedo) options.irradiation->albedo = *arguments.albedo;
    }
    return options;
}

void warn_of_beyond(RasterRun& raster, const dem::Posts& posts,
                    const light::SunHoursOptions& options, std::vector<light::SunOverDem> suns,
                    const std::optional<double>& highest_m) {
    raster.warn_of(
        [&posts, options, suns = std::move(suns), highest_m](const dem::Window& window) {
            return light::terrain_beyond(posts, window, suns,
                                         {.refraction = options.refraction,
                                          .air = options.air,
                                          .soft = false,
                                          .part = {},
                                          .done = {}},
                                         highest_m);
        },
        light::kHides);
}

void run_hours(const HoursArguments& arguments) {
    check(arguments);
    FilesInUse files;
    OutputFile* const file = arguments.raster.open(files);
    const RasterGround ground = arguments.raster.load();
    const dem::Posts& posts = ground.posts;
    const DaysArguments::Days days = arguments.days.parse(posts.grid().center());
    const auto [begin, end] = time_of(days);
    light::SunHoursOptions options = options_of(arguments);
    std::vector<output::RasterBand> bands;
    for (const std::string& word : arguments.bands)
        bands.push_back(session::hours_band(word));
    const std::string from = sun::to_iso(begin, days.zone), to = sun::to_iso(end, days.zone);
    const std::string air = session::air_of_posts(arguments.refraction.name(), posts);
    RasterRun raster(arguments.raster, file, files, ground,
                     {.type = output::RasterType::Float,
                      .bands = bands,
                      .metadata = {{"TIME_FROM", from},
                                   {"TIME_TO", to},
                                   {"TIME_ZONE", days.zone.name()},
                                   {"REFRACTION", air}},
                      .calls = 1,
                      .bytes_a_post = (options.spells ? 44 : 22) + (options.irradiation ? 32 : 0),
                      .halo_m = light::horizon_reach_m(posts, options.refraction)});
    if (raster.is_done()) return;
    warn_of_beyond(raster, posts, options, light::suns_of(posts.grid(), begin, end),
                   arguments.raster.highest_m);
    options.done = raster.done();
    options.mixes_suns = arguments.raster.dry_run || arguments.raster.plan.on;
    Summary sum;
    const auto maker_of = [&](const dem::Posts& of, const dem::Posts* around,
                              const dem::Window& window) -> PartMaker {
        options.part = window;
        options.around = around;
        const auto plan = std::make_shared<light::SunHoursPlan>(of, begin, end, options);
        return [&, plan](const dem::Window& part) -> PartFigures {
            light::SunHours hours = plan->part(part);
            if (options.irradiation)
                hours.definition += "; " + session::definition_of(*options.irradiation);
            sum.add(hours);
            for (std::size_t k = 0; k < arguments.bands.size(); ++k)
                raster.put(k, part, session::hours_values(arguments.bands[k], hours));
            return {hours.holes, std::move(hours.definition)};
        };
    };
    if (!raster.make_all(maker_of)) return;
    sum.say_more_than_level();
    fmt::print("time                {} to {}\n", from, to);
    fmt::print(
        "sun hours           mean {:.2f}, least {:.2f}, most {:.2f}; over a level horizon in "
        "the middle of the DEM {:.2f}\n",
        sum.hours / std::max(1.0, sum.posts), sum.least, sum.most, sum.level_hours);
    fmt::print("\n{}\nrefraction of the sun: {}\n", sum.definition, air);
}

}  // namespace

void add_sun_hours(Verb sun_verb) {
    const auto arguments = std::make_shared<HoursArguments>();
    const Verb verb = sun_verb.add_verb("hours", "Hours of direct sun of each post, as a raster");
    arguments->raster.add_to(verb);
    arguments->days.add_to(verb);
    arguments->refraction.add_to(verb);
    verb.add_option("--step", arguments->step,
                    "Time step of the sun, for at most four days (3min), or minutes alone");
    verb.add_option("--bands", arguments->bands,
                    "Bands: hours; for at most four days also first, last (minutes from the start) "
                    "and spells (number of sunshine periods); global, beam, diffuse, reflected "
                    "(clear-sky irradiation, kWh/m2)")
        .delimiter(',')
        .one_word()
        .check({check_band, ""});
    verb.add_option("--linke", arguments->linke,
                    "Linke turbidity for irradiation: 2 clean, 3 country, 5 city (3)")
        .check(in_range(1.0, 10.0));
    verb.add_option("--albedo", arguments->albedo,
                    "Albedo of the ground for irradiation: 0.2 grass, 0.8 snow (0.2)")
        .check(in_range(0.0, 1.0));
    verb.callback([arguments] { run_hours(*arguments); });
}

}  // namespace relevo::cli

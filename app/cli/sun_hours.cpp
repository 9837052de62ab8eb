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
#include "base/units.h"
#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "figure/hours.h"
#include "figure/sun_over_middle.h"

namespace relevo::cli {
namespace {

struct HoursArguments {
    RasterArguments raster;
    DaysArguments days;
    RefractionArguments refraction;
    std::optional<std::string> step;
    std::string tilt = "ground", azimuth;
    figure::Hours figure;
};

/// The position that all posts have; none: that of the ground.
std::optional<light::Plane> plane_of(const HoursArguments& arguments) {
    if (arguments.tilt == "ground") {
        if (!arguments.azimuth.empty())
            bad_usage("--azimuth: a tilt of ground has the azimuth of the DEM");
        return std::nullopt;
    }
    const double tilt_deg = *parse_number(arguments.tilt);
    if (arguments.azimuth.empty() && tilt_deg > 0)
        bad_usage("--azimuth: missing; where the plane faces: 0 north, 90 east, 180 south");
    return light::Plane{radians(tilt_deg),
                        arguments.azimuth.empty() ? 0 : radians(*parse_number(arguments.azimuth))};
}

sun::TimeSpan time_of(const report::Days& days) {
    return {days.zone.day(days.first).begin, days.zone.day(days.last).end};
}

constexpr const char* kCommas = "separate bands with commas and no blanks: hours,first";

bool is_band(const std::string& word) {
    return contains(figure::Hours::all_words(), word);
}

/// What is wrong with a band; empty: nothing.
std::string check_band(const std::string& band) {
    if (is_band(band)) return {};
    if (trimmed(band).empty() || band.find(' ') != std::string::npos) return kCommas;
    return fmt::format("expected some of {} but got {}",
                       fmt::join(figure::Hours::all_words(), ", "), band);
}

/// What can be said before the DEM is read.
void check(const HoursArguments& arguments) {
    for (const std::string& path : arguments.raster.dem.paths)
        if (is_band(path) && !std::filesystem::exists(path))
            bad_usage(fmt::format("--bands: {}: {}", path, kCommas));
    if (arguments.step) step_s_of(*arguments.step, figure::kStep_s.min, figure::kStep_s.max);
    plane_of(arguments);
    const std::string repeated = arguments.figure.repeated_word();
    if (!repeated.empty()) bad_usage(fmt::format("--bands: {} is named twice", repeated));
    for (const char* option : {"--linke", "--albedo", "--tilt", "--azimuth"})
        if (arguments.raster.has(option) && !arguments.figure.has_irradiation())
            bad_usage(fmt::format("{}: needs --bands global, beam, diffuse or reflected", option));
    const auto [begin, end] = time_of(arguments.days.parse({}, false));
    if (end - begin <= 86400 * light::SunHoursOptions::kMostDays) return;
    if (arguments.step)
        bad_usage(fmt::format(
            "--step: for at most {:.10g} days; longer periods use directions of the sun",
            light::SunHoursOptions::kMostDays));
    if (arguments.figure.has_spells())
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

void run_hours(HoursArguments& arguments) {
    check(arguments);
    FilesInUse files;
    OutputFile* const file = arguments.raster.open(files);
    const figure::RasterGround ground = arguments.raster.load();
    const report::Days days = arguments.days.parse(ground.posts.grid().center());
    figure::Hours& figure = arguments.figure;
    figure.time = time_of(days);
    figure.zone = days.zone;
    figure.refraction = arguments.refraction.name();
    figure.irradiation.plane = plane_of(arguments);
    if (arguments.step)
        figure.step_s = step_s_of(*arguments.step, figure::kStep_s.min, figure::kStep_s.max);
    Summary sum;
    figure.seen = [&](const light::SunHours& part) { sum.add(part); };
    if (!arguments.raster.make(file, files, ground, figure)) return;
    sum.say_more_than_level();
    fmt::print("time                {} to {}\n", figure.from(), figure.to());
    fmt::print(
        "sun hours           mean {:.2f}, least {:.2f}, most {:.2f}; over a level horizon in "
        "the middle of the DEM {:.2f}\n",
        sum.hours / std::max(1.0, sum.posts), sum.least, sum.most, sum.level_hours);
    fmt::print("\n{}\nrefraction of the sun: {}\n", sum.definition,
               figure::air_of_posts(figure.refraction, ground.posts));
}

}  // namespace

void add_sun_hours(Verb sun_verb) {
    const auto arguments = std::make_shared<HoursArguments>();
    const Verb verb = sun_verb.add_verb("hours", "Hours of direct sun of each post, as a raster");
    arguments->raster.add_to(verb, arguments->figure);
    arguments->days.add_to(verb);
    arguments->refraction.add_to(verb);
    verb.add_option("--step", arguments->step,
                    "Time step of the sun, for at most four days (3min), or minutes alone");
    verb.add_option("--bands", arguments->figure.words,
                    "Bands: hours; for at most four days also first, last (minutes from the start) "
                    "and spells (number of sunshine periods); global, beam, diffuse, reflected "
                    "(clear-sky irradiation, kWh/m2)")
        .delimiter(',')
        .one_word()
        .check({check_band, ""});
    add_number(verb, figure::kLinke, arguments->figure.irradiation.linke);
    add_number(verb, figure::kAlbedo, arguments->figure.irradiation.albedo);
    verb.add_option("--tilt", arguments->tilt,
                    "Irradiation of a plane at each post, degrees: 0 level, 90 a wall; or ground, "
                    "as the DEM is inclined there (ground)")
        .check({fault_of_tilt, ""});
    verb.add_option("--azimuth", arguments->azimuth,
                    "Where that plane faces, degrees clockwise from true north")
        .check({fault_of_azimuth, ""});
    verb.callback([arguments] { run_hours(*arguments); });
}

}  // namespace relevo::cli

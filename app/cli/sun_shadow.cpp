#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/sun.h"
#include "cli/sun_rasters.h"
#include "dem/places.h"
#include "figure/shadow.h"

namespace relevo::cli {
namespace {

/// One band each, and each of them as large as the DEM.
constexpr std::size_t kMostTimes = 10'000;

struct ShadowArguments {
    RasterArguments raster;
    TimeArguments time;
    std::string times;
    RefractionArguments refraction;
    std::string sun;
    figure::Shadow figure;
};

/// A sun, and what is to be said of it.
struct Asked {
    figure::SunOverMiddle sun;
    std::optional<sun::ParsedTime> when;
    std::string name;  ///< that the table of times has for it
};

/// What became of all posts under a sun.
struct Counts {
    std::int64_t lit = 0, shaded = 0;
};

/// The sun at a time.
Asked at_time(const ShadowArguments& arguments, const dem::Posts& posts,
              const sun::ParsedTime& when) {
    return {figure::sun_over_middle(posts, when.utc, arguments.refraction.name()), when, {}};
}

/// The suns of a table of times. What is assumed and what is odd is said once.
std::vector<Asked> at_times(const ShadowArguments& arguments,
                            const std::vector<dem::NamedTime>& times, const dem::Posts& posts) {
    const geo::Geodetic middle = posts.grid().center();
    const light::TerrainAccess terrain{.middle = [&] { return middle; },
                                       .posts = [&]() -> const dem::Posts& { return posts; }};
    std::vector<Asked> suns;
    std::set<std::string> said;
    for (const dem::NamedTime& time : times) {
        const std::string line =
            fmt::format("--times: {}: line {}: ", printable(arguments.times), time.line);
        try {
            suns.push_back(
                at_time(arguments, posts,
                        session::parse_quietly({time.time, {}, arguments.time.zone}, terrain)));
        } catch (const Error& error) {
            bad_input(line + error.what());
        }
        Asked& asked = suns.back();
        asked.name = time.name;
        const std::string& assumption = asked.when->assumption;
        if (!assumption.empty() && said.insert(assumption).second)
            log::info(assumption + "; --tz sets another");
        if (!asked.when->note.empty()) log::info(line + asked.when->note);
    }
    return suns;
}

std::vector<Asked> all_suns(const ShadowArguments& arguments,
                            const std::vector<dem::NamedTime>& times, const dem::Posts& posts) {
    if (!times.empty()) return at_times(arguments, times, posts);
    if (!arguments.sun.empty()) return {{figure::sun_as_seen(arguments.sun, posts.grid()), {}, {}}};
    const geo::Geodetic middle = posts.grid().center();
    return {at_time(arguments, posts,
                    session::parse(arguments.time.spec(),
                                   {.middle = [&] { return middle; },
                                    .posts = [&]() -> const dem::Posts& { return posts; }}))};
}

void print_one(const Asked& asked, const Counts& counts, bool soft) {
    if (asked.when)
        fmt::print("time                {}  ({})\n", sun::to_iso(asked.when->utc, asked.when->zone),
                   sun::to_iso(asked.when->utc));
    const double azimuth_deg = degrees(asked.sun.sun.azimuth_rad);
    fmt::print(
        "sun                 azimuth {:.3f} deg ({}), elevation {:.3f} deg as seen, in the "
        "middle of the DEM\n",
        azimuth_deg, compass_point(azimuth_deg), degrees(asked.sun.apparent_rad));
    const double posts = std::max(1.0, static_cast<double>(counts.lit + counts.shaded));
    fmt::print("{}            {} posts, {:.2f} %\n", soft ? "some sun" : "lit     ", counts.lit,
               100 * static_cast<double>(counts.lit) / posts);
    fmt::print("in the shade        {} posts, {:.2f} %\n", counts.shaded,
               100 * static_cast<double>(counts.shaded) / posts);
}

void print_many(const std::vector<Asked>& suns, const std::vector<Counts>& counts, bool soft) {
    fmt::print("band  time                       azimuth  elevation  {}\n",
               soft ? "some sun" : "lit");
    for (std::size_t k = 0; k < suns.size(); ++k) {
        const double posts = std::max(1.0, static_cast<double>(counts[k].lit + counts[k].shaded));
        fmt::print("{:4}  {:25}  {:7.2f}  {:9.2f}  {:6.2f} %{}\n", k + 1,
                   sun::to_iso(suns[k].when->utc, suns[k].when->zone),
                   degrees(suns[k].sun.sun.azimuth_rad), degrees(suns[k].sun.apparent_rad),
                   100 * static_cast<double>(counts[k].lit) / posts,
                   suns[k].name.empty() ? "" : "  " + printable(suns[k].name));
    }
}

void check(const ShadowArguments& arguments) {
    const bool timed = !arguments.times.empty() || arguments.time.given();
    if (!arguments.times.empty() && !(arguments.time.time + arguments.time.date).empty())
        bad_usage("--times: excludes --time and --date; remove them");
    if (timed == !arguments.sun.empty())
        bad_usage(timed ? fmt::format("{} and --sun exclude each other; use one",
                                      arguments.times.empty() ? "--time" : "--times")
                        : "--time: missing; pass --time 2026-06-21T18:30+02:00, or --sun AZ,EL");
    if (!timed && arguments.refraction.given())
        bad_usage("--refraction: needs --time; --sun is an apparent direction");
}

/// @param timed  by a table: each band is named by its time
void give_suns(figure::Shadow& figure, const std::vector<Asked>& suns, bool timed) {
    for (const Asked& asked : suns) {
        figure.suns.push_back(asked.sun);
        if (!timed) continue;
        figure.names.push_back(sun::to_iso(asked.when->utc, asked.when->zone));
        if (!asked.name.empty()) figure.names.back() += " " + asked.name;
    }
}

void run_shadow(ShadowArguments& arguments) {
    check(arguments);
    const bool timed = !arguments.times.empty();
    FilesInUse files;
    if (timed) files.add_input(arguments.times, "the table of times");
    OutputFile* const file = arguments.raster.open(files);
    std::vector<dem::NamedTime> times;
    if (timed) times = dem::read_times(arguments.times, "--times", kMostTimes);
    const figure::RasterGround ground = arguments.raster.load();
    const std::vector<Asked> suns = all_suns(arguments, times, ground.posts);
    figure::Shadow& figure = arguments.figure;
    give_suns(figure, suns, timed);
    figure.refraction = arguments.sun.empty() ? arguments.refraction.name() : "";
    std::vector<Counts> counts(suns.size());
    std::string definition;
    figure.seen = [&](std::size_t k, const light::Shadows& part) {
        counts[k].lit += part.lit_posts;
        counts[k].shaded += part.shaded_posts;
        definition = part.definition;
    };
    if (!arguments.raster.make(file, files, ground, figure)) return;
    if (timed)
        print_many(suns, counts, figure.soft);
    else
        print_one(suns.front(), counts.front(), figure.soft);
    fmt::print("\n{}\nrefraction of the sun: {}\n", definition, figure.air(ground.posts));
}

}  // namespace

void add_sun_shadow(Verb sun_verb) {
    const auto arguments = std::make_shared<ShadowArguments>();
    const Verb verb =
        sun_verb.add_verb("shadow", "Shadow mask of a DEM at a given time, as a raster");
    arguments->raster.add_to(verb, arguments->figure);
    arguments->time.add_to(verb);
    verb.add_option("--times", arguments->times,
                    "Many times instead of --time: a CSV with a column time and optionally name; "
                    "one band for each row");
    verb.add_option("--sun", arguments->sun,
                    "Sun direction instead of a time: AZ,EL in degrees from true north at the "
                    "DEM's centre; grid:AZ,EL from grid north");
    arguments->refraction.add_to(verb);
    verb.add_flag("--soft", arguments->figure.soft,
                  "Visible fraction of the solar disc, 0 to 1, instead of a mask");
    verb.callback([arguments] { run_shadow(*arguments); });
}

}  // namespace relevo::cli

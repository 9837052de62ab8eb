#include "film/film.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/files_in_use.h"
#include "base/log.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/job_run.h"
#include "dem/files_of.h"
#include "scene/film_job.h"
#include "scene/panorama.h"
#include "session/film_day.h"
#include "sun/event_time.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

struct FilmArguments {
    JobArguments job;
    std::string motion, along, span, vary, save_job;
    double duration_s = 10;
    film::Settings film;
    std::optional<double> turns, height_m, look_ahead_m, speed_m_s;
    std::optional<int> quality;
    std::optional<bool> ease;
    bool no_loop = false;
};

const std::string kDefaultSpan = fmt::format("{},{}", session::kFilmDayFrom, session::kFilmDayTo);

/// What moves: the words of --motion.
std::vector<std::string> motions(const FilmArguments& arguments) {
    if (arguments.motion.empty()) {
        if (!arguments.along.empty()) return {"flight"};
        if (!arguments.vary.empty() && arguments.span.empty()) return {};
        return {"day"};
    }
    std::vector<std::string> words = split(arguments.motion, ',');
    const std::vector<std::string> known{"day", "year", "orbit", "flight"};
    for (const std::string& word : words)
        if (!contains(known, word))
            bad_usage(
                fmt::format("--motion: {}: expected day, year, orbit or flight, or two of them, as "
                            "in day,orbit",
                            printable(arguments.motion)));
    const auto both = [&](const char* a, const char* b) {
        if (contains(words, a) && contains(words, b))
            bad_usage(fmt::format("--motion: {} and {} exclude each other; use one", a, b));
    };
    both("day", "year");
    both("orbit", "flight");
    if (contains(words, "flight") && arguments.along.empty())
        bad_usage("--motion flight: its line is missing; add --along TRACK.gpx");
    if (!contains(words, "flight") && !arguments.along.empty())
        bad_usage("--along: needs --motion flight");
    return words;
}

/// @throws Error (Usage) for options of a motion that the film does not have
void check_options(const FilmArguments& arguments, const std::vector<std::string>& motions) {
    const auto need = [&](bool given, const char* option, const std::vector<std::string>& one_of) {
        const auto is_one = [&](const std::string& word) { return contains(one_of, word); };
        if (given && std::ranges::none_of(motions, is_one))
            bad_usage(fmt::format("{}: needs --motion {}", option, fmt::join(one_of, " or ")));
    };
    need(!arguments.span.empty(), "--span", {"day"});
    need(arguments.turns.has_value(), "--turns", {"orbit"});
    need(arguments.ease.has_value(), "--ease", {"orbit", "flight"});
    need(arguments.height_m.has_value(), "--above", {"flight"});
    need(arguments.look_ahead_m.has_value(), "--look-ahead", {"flight"});
    need(arguments.speed_m_s.has_value(), "--speed", {"flight"});
}

/// Size of a film's frames where none is given [px]. That of a panorama has its field of view.
glm::ivec2 default_px(const scene::View& view) {
    constexpr double kWidth_px = 1280;
    if (view.panorama == scene::Panorama::None) return {kWidth_px, 720};
    const glm::dvec2 whole(scene::default_panorama_px(view));
    const glm::ivec2 size(whole * (kWidth_px / std::max(whole.x, whole.y)));
    return glm::max(size / 2 * 2, glm::ivec2(2));  // even sides
}

/// Makes a film's job from the command line.
class Maker {
  public:
    explicit Maker(FilmArguments& arguments) : arguments_(arguments) {
        // A film has a date without a time of day.
        TimeArguments& time = arguments_.job.scene.time;
        if (time.time.empty()) {
            date_ = std::exchange(time.date, {});
            zone_ = std::exchange(time.zone, {});
        } else {
            zone_ = time.zone;
        }
        scene_ = arguments_.job.scene.scene();
        if (scene_.time.at.empty() && !zone_.empty()) scene_.time.zone = zone_;
        if (arguments_.job.scene.size.empty() && arguments_.job.scene.file.empty()) {
            const glm::ivec2 size = default_px(scene_.view);
            scene_.width_px = size.x;
            scene_.height_px = size.y;
        }
        if (!date_.empty()) sun::parse_date(date_);
    }

    const scene::Scene& scene() const { return scene_; }

    scene::FilmJob job() {
        scene::FilmJob job{.film = arguments_.film,
                           .duration_s = arguments_.duration_s,
                           .output = arguments_.job.output};
        job.film.quality = arguments_.quality;
        if (arguments_.no_loop) job.film.loop = false;
        film::check(job.output, scene_.width_px, scene_.height_px, job.film);
        const std::vector<std::string> moving = motions(arguments_);
        check_options(arguments_, moving);
        for (const std::string& word : moving) {
            if (scene_.ortho && (word == "orbit" || word == "flight"))
                bad_usage(fmt::format("--motion {}: a map has no camera; remove --ortho", word));
            if (word == "day") job.day = day();
            if (word == "year") job.year = year();
            if (word == "orbit")
                job.orbit = {arguments_.turns.value_or(1), arguments_.ease.value_or(false)};
            if (word == "flight")
                job.flight = {.along = arguments_.along,
                              .views = {},
                              .height_m = arguments_.height_m,
                              .look_ahead_m = arguments_.look_ahead_m,
                              .speed_m_s = arguments_.speed_m_s,
                              .ease = arguments_.ease.value_or(true)};
        }
        if (!arguments_.vary.empty()) job.value = value();
        if (!job.day && !job.year) fix_date();
        return job;
    }

  private:
    sun::Date date() {
        if (!date_.empty()) return sun::parse_date(date_);
        const sun::ParsedTime time = times_.of(scene_);
        return time.zone.local(time.utc).wall.date;
    }

    /// The day of a film whose time does not move. Its time of day is that of the scene.
    void fix_date() const {
        if (!date_.empty())
            bad_usage(
                fmt::format("--date: this film has one time; write it as --time {}T18:30", date_));
    }

    scene::FilmJob::Day day() {
        if (arguments_.span.empty()) {
            const auto [day, note] =
                session::film_day(scene_, sun::to_string(date()), zone_, times_);
            if (!note.empty()) log::info(note);
            return day;
        }
        const std::vector<std::string> ends = split(arguments_.span, ',');
        if (ends.size() != 2)
            bad_usage(fmt::format("--span: {}: expected FROM,TO such as {}",
                                  printable(arguments_.span), kDefaultSpan));
        scene::FilmJob::Day day{sun::to_string(date()), zone_, ends[0], ends[1]};
        if (zone_.empty()) day.zone = session::film_zone(scene_, day.date, times_);
        return day;
    }

    scene::FilmJob::Value value() const {
        const std::string& text = arguments_.vary;
        const std::size_t equals = std::min(text.find('='), text.size());
        const std::vector<std::string> ends =
            split(equals < text.size() ? text.substr(equals + 1) : "", ',');
        std::optional<double> from, to;
        if (ends.size() == 2) from = parse_number(ends[0]), to = parse_number(ends[1]);
        if (equals == 0 || !from || !to)
            bad_usage(fmt::format("--vary: {}: expected ADDRESS=FROM,TO such as haze.density=0,0.2",
                                  printable(text)));
        return {text.substr(0, equals), *from, *to};
    }

    scene::FilmJob::Year year() {
        std::string at = "12:00";
        if (!scene_.time.at.empty()) {
            const sun::ParsedTime time = times_.of(scene_);
            const sun::CivilTime wall = time.zone.local(time.utc).wall;
            at = fmt::format("{:02}:{:02}", wall.hour, wall.minute);
        }
        return {date().year, at, zone_.empty() ? "solar" : zone_};
    }

    FilmArguments& arguments_;
    std::string date_, zone_;
    scene::Scene scene_;
    session::SceneTimes times_;
};

void film(FilmArguments arguments) {
    Maker maker(arguments);
    const scene::FilmJob job = maker.job();
    if (!arguments.save_job.empty()) {
        FilesInUse files;
        dem::add_named(maker.scene().dems, files);
        if (!arguments.along.empty()) files.add_input(arguments.along, "the track");
        if (!arguments.job.scene.file.empty())
            files.add_input(arguments.job.scene.file, "the scene");
        files.check_planned({arguments.save_job, arguments.job.output}, "--save-job");
        write_text(arguments.save_job,
                   scene::film_job_text(maker.scene(), job,
                                        fs::absolute(arguments.save_job).parent_path()),
                   arguments.job.overwrite, "--save-job");
    }
    arguments.job.text = JobText{scene::film_job_text(maker.scene(), job, ""), ""};
    run_job(arguments.job);
}

void add_motion(Verb verb, FilmArguments& arguments) {
    verb.add_option("--motion", arguments.motion,
                    "What moves: day, year, orbit, flight, or two, as in day,orbit (day)")
        .group("Film");
    verb.add_option("--duration", arguments.duration_s, "Length in seconds (10)")
        .check(in_range(0.001, 1e6))
        .group("Film");
    verb.add_option("--fps", arguments.film.fps, "Frames per second (30)")
        .check(in_range(film::kMinFps, film::kMaxFps))
        .group("Film");
    verb.add_option("--quality", arguments.quality, "0 to 100 (80); not of gif")
        .check(whole_number())
        .check(in_range(0, 100))
        .group("Film");
    verb.add_flag("--no-loop", arguments.no_loop, "Play a gif or webp once").group("Film");
    verb.add_option("--span", arguments.span,
                    fmt::format("Times of a day, FROM,TO ({})", kDefaultSpan))
        .group("Film");
    verb.add_option("--turns", arguments.turns, "Turns of an orbit, clockwise from above (1)")
        .check(in_range(-1000, 1000))
        .group("Film");
    // add_flag() gives an optional the value false where there is no flag.
    verb.add_flag_function(
            "--ease,!--no-ease", [&arguments](std::int64_t given) { arguments.ease = given > 0; },
            "Whether the camera begins and ends at rest (flights do, orbits do not)")
        .group("Film");
    verb.add_option(
            "--vary", arguments.vary,
            "A parameter from one value to another, ADDRESS=FROM,TO; alone or with --motion")
        .group("Film");
    verb.add_option("--along", arguments.along, "Line of a flight: GPX, CSV or GeoJSON")
        .group("Film");
    verb.add_option("--above", arguments.height_m,
                    "Least height of a flight above the ground in metres (150)")
        .check(in_range(0.1, 1e6))
        .group("Film");
    verb.add_option("--look-ahead", arguments.look_ahead_m,
                    "How far ahead a flight looks, in metres; bends narrower than it are cut")
        .check(in_range(1, 1e6))
        .group("Film");
    verb.add_option("--speed", arguments.speed_m_s,
                    "Highest speed of a flight in m/s, instead of --duration")
        .check(in_range(0.01, 1e6))
        .group("Film");
}

}  // namespace

void add_film(Verb app) {
    const auto arguments = std::make_shared<FilmArguments>();
    const Verb verb = app.add_verb("film", "Makes a film: a day, a year, an orbit, a flight");
    JobArguments& job = arguments->job;
    job.scene.add_to(verb);
    verb.add_option("-o,--output", job.output, "Film to write: mp4, webm, webp or gif").required();
    add_motion(verb, *arguments);
    verb.add_option("--save-job", arguments->save_job,
                    "Write the job as JSON, for relevo run; with --dry-run no film is made");
    verb.add_flag("--overwrite", job.overwrite, "Replace existing files");
    verb.add_flag("--dry-run", job.dry_run, "Estimate the time, and make no film");
    verb.add_flag("--allow-blank", job.allow_blank, "Accept a film that shows no ground");
    verb.add_option("--device", job.device,
                    "GL device: auto, an index, software, or a part of its name");
    verb.callback([arguments] { film(*arguments); });
}

}  // namespace relevo::cli

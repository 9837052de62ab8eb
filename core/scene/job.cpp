#include "scene/job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "image/image.h"
#include "scene/name_template.h"
#include "scene/scene_reader.h"
#include "scene/scene_words.h"
#include "sun/event_time.h"

namespace relevo::scene {
namespace {

namespace fs = std::filesystem;

/// "expected 96 values, as sweep[0].times has, but got 95; ..."
std::string unlike(std::size_t expected, const std::string& path, std::size_t got) {
    return fmt::format(
        "expected {} values, as {} has, but got {}; \"combine\": \"zip\" takes axes of one length",
        expected, path, got);
}

/// Draws up the pictures of a job.
class Expansion {
  public:
    Expansion(const Job& job, const Resolve& resolve, std::size_t most, const GroundOf& ground_of)
        : job_(job), resolve_(resolve), most_(most), ground_of_(ground_of) {}

    Shots run() {
        const NameTemplate names = name_template();
        check_counts();
        Draft first;
        first.scene = job_.scene;
        if (job_.shots.empty())
            sweep(first);
        else
            for (const Change& shot : job_.shots.front().values) {
                Draft draft = first;
                shot.apply(draft);
                sweep(draft);
            }
        resolve_times();
        if (result_.shots.empty())
            bad_input(fmt::format(
                "{}: {}: no picture is left: none of its events happens; the first: {}", kJobWho,
                job_.file, result_.left_out.empty() ? "" : result_.left_out.front()));
        name_all(names);
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(int line, const std::string& path, const std::string& what) const {
        bad_input(fmt::format("{}: {}:{}: {}: {}", kJobWho, job_.file, line, path, what));
    }

    NameTemplate name_template() const {
        std::vector<std::string> known;
        for (const std::vector<Axis>* axes : {&job_.shots, &job_.sweep})
            for (const Axis& axis : *axes)
                if (axis.kind != "time" && axis.kind != "date") known.push_back(axis.kind);
        try {
            return {job_.output, known};
        } catch (const Error& error) {
            if (!job_.output_given) bad_input(fmt::format("run: -o: {}", error.what()));
            fail(job_.output_line, "output", error.what());
        }
    }

    /// Refuses what is too much before it is drawn up, as far as it is known by then.
    void check_counts() const {
        std::size_t count = job_.shots.empty() ? 1 : job_.shots.front().values.size();
        bool more = false;
        std::size_t longest = 0;
        std::string longest_path;
        for (const Axis& axis : job_.sweep) {
            const std::optional<std::size_t> values = axis.count();
            more = more || !values;
            if (!values) continue;
            if (job_.zip && longest > 0 && *values != longest)
                fail(axis.line, axis.path, unlike(longest, longest_path, *values));
            longest = *values;
            longest_path = axis.path;
            if (!job_.zip) count = std::min(count * *values, kMany);
        }
        if (job_.zip && longest > 0) count *= longest;
        if (count > most_)
            too_many(fmt::format("{}{}", count, more || count >= kMany ? " or more" : ""));
    }

    [[noreturn]] void too_many(const std::string& count) const {
        bad_input(
            fmt::format("{}: {}: the job has {} pictures, more than {}; add --yes to allow them",
                        kJobWho, job_.file, count, most_));
    }

    void sweep(const Draft& draft) {
        if (job_.zip)
            zip(draft);
        else
            product(draft, 0);
    }

    void add(Draft draft) {
        drafts_.push_back(std::move(draft));
        if (drafts_.size() > most_) too_many(fmt::format("{} or more", drafts_.size()));
    }

    void product(const Draft& draft, std::size_t at) {
        if (at == job_.sweep.size()) return add(draft);
        const Axis& axis = job_.sweep[at];
        for (const Change& value : values_of(axis, draft)) {
            Draft next = draft;
            value.apply(next);
            product(next, at + 1);
        }
    }

    void zip(const Draft& draft) {
        std::vector<std::vector<Change>> columns;
        for (const Axis& axis : job_.sweep) {
            columns.push_back(values_of(axis, draft));
            if (columns.back().size() != columns.front().size())
                fail(
                    axis.line, axis.path,
                    unlike(columns.front().size(), job_.sweep.front().path, columns.back().size()));
        }
        const std::size_t count = columns.empty() ? 1 : columns.front().size();
        for (std::size_t i = 0; i < count; ++i) {
            Draft next = draft;
            for (const std::vector<Change>& column : columns)
                column[i].apply(next);
            add(std::move(next));
        }
    }

    std::vector<Change> values_of(const Axis& axis, const Draft& draft) {
        if (axis.range) return times_of(axis, draft);
        if (axis.kind == "camera" && draft.scene.ortho)
            fail(axis.line, axis.path, "a map has no camera; remove picture.ortho, or this");
        return axis.motion ? views_of(axis, draft) : axis.values;
    }

    /// The views of a camera that moves over the ground of a draft.
    std::vector<Change> views_of(const Axis& axis, const Draft& draft) {
        const MotionGround ground = ground_of_(draft.scene);
        std::vector<View> views;
        std::string warning;
        try {
            if (const auto* const orbit = std::get_if<OrbitMotion>(&*axis.motion))
                views = orbit_views(*orbit, draft.scene.view, ground);
            else
                views = flight_views(std::get<FlightMotion>(*axis.motion), draft.scene.view, ground,
                                     warning);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::BadInput) throw;
            fail(axis.line, axis.path, error.what());
        }
        if (!warning.empty() && !contains(result_.warnings, warning))
            result_.warnings.push_back(warning);
        std::vector<Change> result;
        for (const View& view : views) {
            const std::string name = fmt::format("{:04}", result.size() + 1);
            result.push_back({name, [view, name](Draft& next) {
                                  next.scene.view = view;
                                  next.names["camera"] = name;
                              }});
        }
        return result;
    }

    /// The times of a range on the day of a draft.
    std::vector<Change> times_of(const Axis& axis, const Draft& draft) {
        const TimeRange& range = *axis.range;
        const auto time_at = [&](const std::string& text) {
            Draft end = draft;
            end.time = text;
            return resolve_(with_time(end));
        };
        std::vector<Change> result;
        sun::ParsedTime from, to;
        try {
            from = time_at(range.from);
            to = time_at(range.to);
        } catch (const Error& error) {
            // A day without a sunrise has no range from one.
            if (error.code() != ErrorCode::BadInput || !draft.date)
                fail(axis.line, axis.path, error.what());
            result_.left_out.push_back(error.what());
            return result;
        }
        const double length_s = to.utc - from.utc;
        if (length_s < 0)
            fail(axis.line, axis.path,
                 fmt::format("expected a time after {} but got {}",
                             sun::to_iso(from.utc, from.zone), sun::to_iso(to.utc, from.zone)));
        const bool counted = range.frames > 0;
        const double steps =
            counted ? range.frames - 1 : std::floor(length_s / range.step_s + 1e-6);
        const double step_s = counted ? length_s / std::max(1.0, steps) : range.step_s;
        if (steps >= static_cast<double>(most_)) too_many(fmt::format("{:.0f} or more", steps + 1));
        for (std::size_t i = 0; i <= static_cast<std::size_t>(steps); ++i) {
            const sun::Instant utc = from.utc + static_cast<double>(i) * step_s;
            result.push_back({"", [text = sun::exact_iso(utc)](Draft& next) {
                                  next.time = text;
                                  next.date.reset();
                              }});
        }
        return result;
    }

    /// The scene of a draft with a complete time.
    Scene with_time(const Draft& draft) const {
        Scene scene = draft.scene;
        TimeSpec& spec = scene.time;
        std::string text = draft.time.empty() ? spec.at : draft.time;
        if (draft.date && text.empty())
            bad_input(fmt::format(
                "{}: {}: dates need a time of day or an event; add \"at\" to them, or time.at",
                kJobWho, job_.file));
        const std::string own_date = is_whole(spec.at) ? spec.at.substr(0, 10) : "";
        const std::string date = draft.date           ? sun::to_string(*draft.date)
                                 : !spec.date.empty() ? spec.date
                                                      : own_date;
        // Of a scene's own time on other days there is left its time of day.
        if (draft.date && draft.time.empty() && is_whole(text)) text = date + text.substr(10);
        spec.date.clear();
        if (is_clock(text)) {
            if (date.empty())
                bad_input(
                    fmt::format("{}: {}: {}: a time of day needs a date; give dates or "
                                "time.date",
                                kJobWho, job_.file, text));
            text = fmt::format("{}T{}", date, padded_clock(text));
        } else if (!text.empty() && sun::is_event_time(text)) {
            if (!sun::parse_event_time(text).date) spec.date = date;
            if (draft.site && text.find('@') == std::string::npos)
                text += fmt::format("@{:.10g},{:.10g}", degrees(draft.site->lat_rad),
                                    degrees(draft.site->lon_rad));
        }
        spec.at = text;
        return scene;
    }

    static bool is_whole(const std::string& time) {
        return !time.empty() && time != "now" && !is_clock(time) && !sun::is_event_time(time) &&
               time.size() > 10;
    }

    void resolve_times() {
        for (Draft& draft : drafts_) {
            Shot shot;
            shot.scene = with_time(draft);
            try {
                const sun::ParsedTime time = resolve_(shot.scene);
                shot.utc = time.utc;
                shot.zone = time.zone;
            } catch (const Error& error) {
                const bool event = sun::is_event_time(shot.scene.time.at);
                if (!event || error.code() != ErrorCode::BadInput) throw;
                result_.left_out.push_back(error.what());
                continue;
            }
            shot.names = std::move(draft.names);
            result_.shots.push_back(std::move(shot));
        }
        drafts_.clear();
    }

    void name_all(const NameTemplate& names) {
        std::map<fs::path, std::size_t> taken;
        for (Shot& shot : result_.shots) {
            shot.number = static_cast<std::size_t>(&shot - result_.shots.data()) + 1;
            const fs::path name = names.name({shot.number, fs::path(shot.scene.dems.front()).stem(),
                                              shot.utc, shot.zone, shot.names});
            if (job_.output_given && !job_.output_may_leave && !is_in_folder(name))
                bad_output(fmt::format(
                    "\"{}\" names {}, which is not below the job's own folder; name it with -o, or "
                    "add --trust",
                    job_.output, printable(name.string())));
            shot.output = (job_.folder / name).lexically_normal();
            const auto [other, fresh] = taken.emplace(shot.output, shot.number);
            if (fresh || job_.is_film()) continue;
            const std::string what = fmt::format(
                "\"{}\" names {} twice, for pictures {} and {}; add {{n}} or another field that "
                "differs",
                job_.output, printable(shot.output.string()), other->second, shot.number);
            bad_output(what);
        }
        if (job_.is_film()) check_film();
    }

    /// Whether a result, links followed, is below the job's own folder.
    bool is_in_folder(const fs::path& name) const {
        const fs::path folder = job_.folder.empty() ? "." : job_.folder;
        if (name.is_relative()) return file_inside(folder, name).has_value();
        std::error_code error;
        const fs::path from = fs::canonical(folder, error);
        const fs::path whole = error ? fs::path() : fs::weakly_canonical(name, error);
        return !error && file_inside(folder, whole.lexically_relative(from)).has_value();
    }

    /// A film is one file, whatever its frames.
    void check_film() const {
        for (const Shot& shot : result_.shots) {
            const Shot& first = result_.shots.front();
            if (shot.output == first.output) continue;
            bad_output(
                fmt::format("a film is one file but \"{}\" names {} and {}; remove what differs "
                            "between its frames",
                            job_.output, printable(first.output.filename().string()),
                            printable(shot.output.filename().string())));
        }
    }

    [[noreturn]] void bad_output(const std::string& what) const {
        if (!job_.output_given)
            bad_input(fmt::format("{}: {}: output: {}", kJobWho, job_.file, what));
        fail(job_.output_line, "output", what);
    }

    static constexpr std::size_t kMany = 1'000'000'000;

    const Job& job_;
    const Resolve& resolve_;
    std::size_t most_;
    const GroundOf& ground_of_;
    std::vector<Draft> drafts_;
    Shots result_;
};

}  // namespace

std::optional<std::size_t> Axis::count() const {
    if (range) return range->frames > 0 ? std::optional<std::size_t>(range->frames) : std::nullopt;
    if (motion)
        return std::visit([](const auto& m) { return static_cast<std::size_t>(m.frames); },
                          *motion);
    return values.size();
}

bool Job::is_film() const {
    if (film::is_film_name(output)) return true;
    const bool webp = lower(fs::path(output).extension().string()) == ".webp";
    return film && (webp || !image::is_picture_name(output));
}

Shots shots_of(const Job& job, const Resolve& resolve, std::size_t most,
               const GroundOf& ground_of) {
    return Expansion(job, resolve, most, ground_of).run();
}

}  // namespace relevo::scene

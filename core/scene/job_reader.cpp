#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "dem/places.h"
#include "json/object_reader.h"
#include "scene/job.h"
#include "scene/motion_reader.h"
#include "scene/scene_reader.h"
#include "scene/scene_words.h"
#include "sun/event_time.h"

namespace relevo::scene {
namespace {

namespace fs = std::filesystem;
using json::ObjectReader;

constexpr int kJobFormat = 1;

/// "haze+no-sky": effects in a name.
std::string name_of(const effect::Switches& switches) {
    std::string name;
    const auto add = [&](const std::string& word) { name += (name.empty() ? "" : "+") + word; };
    if (switches.only) {
        for (const std::string& id : *switches.only)
            add(id);
        if (switches.only->empty()) add("none");
    }
    for (const std::string& id : switches.enable)
        add(id);
    for (const std::string& id : switches.disable)
        add("no-" + id);
    return name.empty() ? "default" : name;
}

/// Reads a job's file, member by member.
class JobReader {
  public:
    JobReader(std::string file, fs::path folder)
        : file_(std::move(file)),
          folder_(std::move(folder)),
          reader_(kJobWho, file_, folder_, SceneReader::Dates::Later) {}

    Job run(const std::string& text, const std::function<void(Scene&)>& change) {
        json_ = std::make_shared<const json::Value>(json::parse(kJobWho, file_, text));
        ObjectReader object(kJobWho, file_, "", *json_);
        const json::Value& format = object.need("format");
        if (format.kind != json::Value::Kind::Number || format.number != kJobFormat)
            object.fail(format.line, "format",
                        fmt::format("expected {}, the format that this program reads, but got {}",
                                    kJobFormat, json::describe(format)));
        object.string("$schema", "");  // which editors look for
        job_.file = file_;
        job_.text = text;
        job_.folder = folder_;
        if (const std::string base = object.string("scene", ""); !base.empty()) {
            job_.files.push_back({reader_.beside(base), "the scene"});
            job_.scene = read_scene(reader_.beside(base));
        }
        reader_.take(object, "", job_.scene);
        change(job_.scene);
        job_.output_given = object.has("output");
        job_.output = object.string("output", job_.output);
        job_.output_line = object.line_of("output");
        job_.zip = object.choice("combine", {"product", "zip"}, std::size_t{0}) == 1;
        if (const json::Value* const film = object.take("film")) {
            job_.film = read_film(object, *film);
            fps_ = job_.film->fps;
        }
        probe_.scene = job_.scene;
        shots(object);
        sweep(object);
        object.finish();
        if (job_.scene.dems.empty() && (job_.shots.empty() || probe_.scene.dems.empty()))
            object.fail(object.line(), "", "expected a member \"dem\"");
        return std::move(job_);
    }

  private:
    ObjectReader inside(const json::Value& value, const std::string& path) const {
        return reader_.inside(value, path);
    }

    /// Puts an axis in its place once each of its values has been tried.
    void add(std::vector<Axis>& to, Axis axis) {
        for (const Axis& other : to)
            if (other.kind == axis.kind)
                bad_input(
                    fmt::format("{}: {}:{}: {}: expected one axis of its kind but there is {}",
                                kJobWho, file_, axis.line, axis.path, other.path));
        if (axis.values.empty() && !axis.range && !axis.motion)
            bad_input(fmt::format("{}: {}:{}: {}: expected values but the list is empty", kJobWho,
                                  file_, axis.line, axis.path));
        const Draft before = probe_;
        for (auto value = axis.values.rbegin(); value != axis.values.rend(); ++value) {
            probe_ = before;
            value->apply(probe_);
        }
        to.push_back(std::move(axis));
    }

    /// The items of a list.
    const std::vector<json::Value>& items(const json::Value& value, const std::string& path,
                                          const char* what) const {
        if (value.kind != json::Value::Kind::Array)
            bad_input(fmt::format("{}: {}:{}: {}: expected a list of {} but got {}", kJobWho, file_,
                                  value.line, path, what, json::describe(value)));
        return value.items;
    }

    void shots(ObjectReader& top) {
        const json::Value* const list = top.take("shots");
        if (!list) return;
        Axis axis{"shot", "shots", list->line, {}, {}};
        for (const json::Value& item : items(*list, "shots", "shots")) {
            const std::string path = fmt::format("shots[{}]", axis.values.size());
            ObjectReader object = inside(item, path);
            const std::string name =
                object.string("name", fmt::format("{}", axis.values.size() + 1));
            axis.values.push_back(
                {name, [this_ = reader_, json = json_, &item, path, name](Draft& draft) {
                     ObjectReader shot = this_.inside(item, path);
                     shot.take("name");
                     const int camera = shot.has("camera") ? shot.line_of("camera") : 0;
                     this_.take(shot, path, draft.scene);
                     if (camera > 0 && draft.scene.ortho)
                         shot.fail(camera, "camera",
                                   "a map has no camera; remove picture.ortho, or this");
                     shot.finish();
                     draft.names["shot"] = name;
                 }});
        }
        add(job_.shots, std::move(axis));
    }

    void sweep(ObjectReader& top) {
        const json::Value* const list = top.take("sweep");
        if (!list) return;
        int number = 0;
        for (const json::Value& item : items(*list, "sweep", "axes")) {
            const std::string path = fmt::format("sweep[{}]", number++);
            ObjectReader object = inside(item, path);
            Axis axis = axis_of(object, item, path);
            object.finish();
            add(job_.sweep, std::move(axis));
        }
        if (job_.sweep.empty())
            top.fail(list->line, "sweep", "expected axes but the list is empty");
    }

    Axis axis_of(ObjectReader& object, const json::Value& item, const std::string& path) {
        const json::Value* const times = object.take("times");
        const json::Value* const dates = object.take("dates");
        const json::Value* const cameras = object.take("cameras");
        const json::Value* const sites = object.take("sites");
        const json::Value* const effects = object.take("effects");
        const json::Value* const set = object.take("set");
        const json::Value* const orbit = object.take("orbit");
        const json::Value* const flight = object.take("flight");
        const int given =
            !!times + !!dates + !!cameras + !!sites + !!effects + !!set + !!orbit + !!flight;
        if (given > 1)
            object.fail(
                item.line, "",
                fmt::format("expected one axis but got {}; each has braces of its own", given));
        if (times) return times_axis(*times, path + ".times");
        if (dates) return dates_axis(*dates, path + ".dates");
        if (cameras) return cameras_axis(*cameras, path + ".cameras");
        if (sites) return sites_axis(*sites, path + ".sites");
        if (effects) return effects_axis(*effects, path + ".effects");
        if (set) return values_axis(object, *set);
        if (orbit) return orbit_axis(*orbit, path + ".orbit");
        if (flight) return flight_axis(*flight, path + ".flight");
        object.finish();
        object.fail(item.line, "",
                    "expected one of times, dates, cameras, sites, effects, set, orbit and "
                    "flight");
    }

    /// A text that some parser takes.
    template <typename Parse>
    void check(const ObjectReader& object, const char* key, const Parse& parse) const {
        try {
            parse();
        } catch (const Error& error) {
            const std::string_view what = error.what();
            object.fail(object.line_of(key), key, what.substr(what.find(": ") + 2));
        }
    }

    void check_time(const ObjectReader& object, const char* key, const std::string& text) const {
        check(object, key, [&] {
            if (is_clock(text))
                sun::parse_time("2026-01-01T" + padded_clock(text) + "Z");
            else if (sun::is_event_time(text))
                sun::parse_event_time(text);
            else
                sun::parse_time(text, sun::Zone());
        });
    }

    Axis times_axis(const json::Value& value, const std::string& path) {
        Axis axis{"time", path, value.line, {}, {}};
        if (value.kind == json::Value::Kind::Array) {
            for (const json::Value& item : value.items) {
                const std::string at = fmt::format("{}[{}]", path, axis.values.size());
                if (item.kind != json::Value::Kind::String || item.text != printable(item.text))
                    bad_input(fmt::format("{}: {}:{}: {}: expected a time but got {}", kJobWho,
                                          file_, item.line, at, json::describe(item)));
                json::Value wrapped;
                wrapped.kind = json::Value::Kind::Object;
                wrapped.line = item.line;
                check_time(inside(wrapped, at), "", item.text);
                axis.values.push_back(
                    {item.text, [text = item.text](Draft& draft) { draft.time = text; }});
            }
            return axis;
        }
        ObjectReader object = inside(value, path);
        TimeRange range;
        range.from = object.string("from");
        range.to = object.string("to");
        range.frames = frames_of(object);
        const std::string step = range.frames > 0 ? "1" : object.string("step");
        object.finish();
        check_time(object, "from", range.from);
        check_time(object, "to", range.to);
        const auto step_s = sun::parse_step_s(step);
        if (!step_s)
            object.fail(object.line_of("step"), "step",
                        fmt::format("expected a duration such as 15min, 1h30min or 45s, or "
                                    "minutes alone, but got \"{}\"",
                                    step));
        range.step_s = *step_s;
        axis.range = range;
        return axis;
    }

    sun::Date date(ObjectReader& object, const char* key) const {
        const std::string text = object.string(key);
        sun::Date result;
        check(object, key, [&] { result = sun::parse_date(text); });
        return result;
    }

    Axis dates_axis(const json::Value& value, const std::string& path) {
        Axis axis{"date", path, value.line, {}, {}};
        std::string at;
        const auto add_date = [&](const sun::Date& day) {
            axis.values.push_back({sun::to_string(day), [day, at](Draft& draft) {
                                       draft.date = day;
                                       if (!at.empty()) draft.time = at;
                                   }});
        };
        if (value.kind == json::Value::Kind::Array) {
            json::Value wrapped;
            wrapped.kind = json::Value::Kind::Object;
            wrapped.members = {{"dates", value}};
            ObjectReader object = inside(wrapped, path.substr(0, path.rfind('.')));
            for (const std::string& text : object.strings("dates"))
                check(object, "dates", [&] { add_date(sun::parse_date(text)); });
            return axis;
        }
        ObjectReader object = inside(value, path);
        at = object.string("at", "");
        if (!at.empty()) check_time(object, "at", at);
        if (!at.empty() && !is_clock(at) && !sun::is_event_time(at))
            object.fail(object.line_of("at"), "at",
                        fmt::format("expected a time of day or an event but got \"{}\"", at));
        const int frames = frames_of(object);
        const auto step = static_cast<int>(object.number("step", 1, 1, 366 * 201, true));
        sun::Date first, last;
        if (object.has("year")) {
            const auto year =
                static_cast<int>(object.number("year", 0, sun::kFirstYear, sun::kLastYear, true));
            first = {year, 1, 1};
            last = {year, 12, 31};
        } else {
            object.take("year");
            first = date(object, "from");
            last = date(object, "to");
        }
        object.finish();
        if (last < first)
            object.fail(object.line_of("to"), "to",
                        fmt::format("expected a day from {} on but got {}", sun::to_string(first),
                                    sun::to_string(last)));
        const int days = sun::days_between(first, last);
        for (int i = 0; i < frames; ++i)  // the same day again where frames are more
            add_date(sun::add_days(
                first, static_cast<int>(std::lround(days * i / std::max(1.0, frames - 1.0)))));
        for (int day = 0; frames == 0 && day <= days; day += step)
            add_date(sun::add_days(first, day));
        return axis;
    }

    Axis cameras_axis(const json::Value& value, const std::string& path) {
        Axis axis{"camera", path, value.line, {}, {}};
        for (const json::Value& item : items(value, path, "cameras")) {
            const std::string at = fmt::format("{}[{}]", path, axis.values.size());
            // The name is the axis's, the rest a camera's.
            auto camera = std::make_shared<json::Value>(item);
            const std::string name = take_name(*camera, at, axis.values.size());
            axis.values.push_back({name, [reader = reader_, camera, at, name](Draft& draft) {
                                       reader.take_camera(*camera, at, draft.scene);
                                       draft.names["camera"] = name;
                                   }});
        }
        return axis;
    }

    Axis orbit_axis(const json::Value& value, const std::string& path) const {
        return {"camera", path, value.line, {}, {}, read_orbit(reader_, value, path, fps_)};
    }

    Axis flight_axis(const json::Value& value, const std::string& path) {
        return {"camera", path, value.line,
                {},       {},   read_flight(reader_, value, path, fps_, job_.scene, job_.files)};
    }

    Axis effects_axis(const json::Value& value, const std::string& path) {
        Axis axis{"effects", path, value.line, {}, {}};
        for (const json::Value& item : items(value, path, "effects to switch")) {
            const std::string at = fmt::format("{}[{}]", path, axis.values.size());
            auto effects = std::make_shared<json::Value>(item);
            const bool named = inside(*effects, at).has("name");
            std::string name = take_name(*effects, at, axis.values.size());
            Effects change;
            reader_.take_effects(*effects, at, change);
            if (!named) name = name_of(change.switches);
            axis.values.push_back({name, [change, name](Draft& draft) {
                                       draft.scene.effects =
                                           merge(std::move(draft.scene.effects), change);
                                       draft.names["effects"] = name;
                                   }});
        }
        return axis;
    }

    /// Takes the member `name` out of an object.
    std::string take_name(json::Value& object, const std::string& path, std::size_t index) const {
        const std::string name = inside(object, path).string("name", fmt::format("{}", index + 1));
        std::erase_if(object.members, [](const auto& member) { return member.name == "name"; });
        return name;
    }

    Axis sites_axis(const json::Value& value, const std::string& path) {
        Axis axis{"site", path, value.line, {}, {}};
        ObjectReader object = inside(value, path);
        const std::string file = reader_.beside(object.string("file"));
        job_.files.push_back({file, "the sites"});
        const std::string crs = object.string("crs", "");
        const double height_m = object.number("height", kEyeHeight_m, -500, 10000, false);
        View along;
        const json::Value* const target = object.take("look_at");
        if (target) {
            along.look_at = reader_.standpoint(object, *target, "look_at", 0);
        } else {
            along.heading_deg = object.number("heading", 0, -360, 360, false);
            along.pitch_deg = object.number("pitch", 0, -90, 90, false);
        }
        object.finish();
        for (const dem::NamedPlace& place : dem::read_points(file, kJobWho, crs)) {
            Standpoint eye{place.at.place, place.at.above_ground};
            if (!place.at.has_height) {
                eye.place.height_m = height_m;
                eye.above_ground = true;
            }
            const std::string name =
                place.name.empty() ? fmt::format("{}", axis.values.size() + 1) : place.name;
            axis.values.push_back({name, [eye, along, name](Draft& draft) {
                                       View view = along;
                                       view.eye = eye;
                                       view.take_lens_of(draft.scene.view);
                                       draft.scene.view = view;
                                       draft.site = eye.place;
                                       draft.names["site"] = name;
                                   }});
        }
        return axis;
    }

    Axis values_axis(ObjectReader& object, const json::Value& set) {
        const std::string address = object.string("set");
        Axis axis{address, "", set.line, {}, {}};
        const auto add_value = [&](const std::string& text) {
            if (address == kSeconds) return axis.values.push_back(seconds_change(object, text));
            Effects change;
            change.settings = {{address, text, set.line, folder_.string()}};
            axis.values.push_back({text, [change, address, text](Draft& draft) {
                                       draft.scene.effects =
                                           merge(std::move(draft.scene.effects), change);
                                       draft.names[address] = text;
                                   }});
        };
        if (const json::Value* const values = object.take("values")) {
            for (const char* const key : {"from", "to", "step", "frames", "duration_s"})
                object.take(key);
            if (values->kind != json::Value::Kind::Array)
                object.fail(
                    values->line, "values",
                    fmt::format("expected a list of values but got {}", json::describe(*values)));
            axis.path = "values";
            for (const json::Value& item : values->items) {
                const auto text = effect::value_text(item);
                if (!text)
                    object.fail(item.line, "values",
                                fmt::format("expected a number, true or false, a text or a list of "
                                            "numbers but got {}",
                                            json::describe(item)));
                add_value(*text);
            }
        } else {
            const double from = number(object, "from"), to = number(object, "to");
            const int frames = frames_of(object);
            const double step =
                frames > 0 ? (to - from) / std::max(1, frames - 1) : number(object, "step");
            if (!(step > 0) && frames == 0)
                object.fail(object.line_of("step"), "step",
                            fmt::format("expected more than 0 but got {}", step));
            if (to < from && frames == 0)
                object.fail(object.line_of("to"), "to",
                            fmt::format("expected {} or more but got {}", from, to));
            const double steps = frames > 0 ? frames - 1 : std::floor((to - from) / step + 1e-9);
            if (steps >= kMostValues)
                object.fail(object.line_of("step"), "step",
                            fmt::format("expected at most {} values", kMostValues));
            for (int i = 0; i <= static_cast<int>(steps); ++i)
                add_value(fmt::format("{:.12g}", from + i * step));
        }
        axis.path = address;
        return axis;
    }

    /// A moment of effects that move, which is a member of the scene and no parameter.
    Change seconds_change(const ObjectReader& object, const std::string& text) const {
        const std::optional<double> seconds = parse_number(text);
        if (!seconds || !(*seconds >= 0 && *seconds <= kMaxSeconds))
            object.fail(object.line_of("set"), "set",
                        fmt::format("seconds: expected a number from 0 to {} but got {}",
                                    kMaxSeconds, text));
        return {text, [seconds, text](Draft& draft) {
                    draft.scene.seconds = *seconds;
                    draft.names[kSeconds] = text;
                }};
    }

    double number(ObjectReader& object, const char* key) const {
        object.need(key);
        return object.number(key, 0, -1e9, 1e9, false);
    }

    /// The number of values of a range that has no step; 0 where it has one.
    int frames_of(ObjectReader& object) const {
        const bool counted = object.has("frames") || object.has("duration_s");
        if (counted && object.has("step"))
            object.fail(object.line_of("step"), "step",
                        "expected a step or a number of frames but got both");
        const int frames = read_frames(object, fps_, 10);
        if (counted) object.take("step");
        return counted ? frames : 0;
    }

    static constexpr int kMostValues = 1'000'000;
    static constexpr const char* kSeconds = "seconds";

    std::string file_;
    fs::path folder_;
    SceneReader reader_;
    std::shared_ptr<const json::Value> json_;  // the axes' values refer to it
    Draft probe_;                              // what values are tried on
    Job job_;
    double fps_ = film::Settings().fps;  ///< of the film
};

}  // namespace

Job read_job(const fs::path& path, const std::function<void(Scene&)>& change) {
    return read_job_text(read_text(path.string(), kJobWho), path.string(), path.parent_path(),
                         change);
}

Job read_job_text(const std::string& text, const std::string& file, const fs::path& folder,
                  const std::function<void(Scene&)>& change) {
    return JobReader(file, folder).run(text, change);
}

}  // namespace relevo::scene

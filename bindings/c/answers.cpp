#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "dem.h"
#include "dem/places.h"
#include "figure/far_ground.h"
#include "options.h"
#include "report/along.h"
#include "report/carpet.h"
#include "report/days.h"
#include "report/doubts.h"
#include "report/eclipses.h"
#include "report/position.h"
#include "report/when.h"
#include "session/words.h"

/// Figures of a place, as the program's --json says them.
namespace relevo::c {
namespace {

/// A call of relevo_answer(): options that figures share, read when they are asked for.
class AnswerCall {
  public:
    AnswerCall(Dem* dem, json::ObjectReader& reader) : dem_(dem), reader_(reader) {}

    json::ObjectReader& reader() { return reader_; }
    /// Null without a DEM.
    const dem::Posts* ground() { return dem_ ? &dem_->posts() : nullptr; }
    /// @throws BadCall, here and below
    Dem& dem() { return need(dem_, "dem"); }
    const dem::Posts& posts() { return dem().posts(); }

    geo::PlaceText place() {
        std::string at = fmt::format("{},{}", degrees("lat", 90), degrees("lon", 360));
        if (reader_.has("height"))
            at += fmt::format(",{}", reader_.number("height", 0, -12000, 10'000, false));
        return geo::parse_place(at, "--at");
    }
    /// Options of the air and of the ground.
    report::View view(sun::Body body) {
        report::View view;
        view.body = body;
        view.eye_height_m = optional("eye_height", {0, 0, 10'000});
        view.terrestrial_refraction = number(reader_, figure::kTerrestrialRefraction);
        view.highest_m = optional("highest", figure::kHighestAtPoint_m);
        if (reader_.has("refraction"))
            view.refraction = refraction_name(reader_.string("refraction"), "");
        return view;
    }
    /// With what rising and shining mean.
    report::View light(sun::Body body) {
        static const std::vector<std::string> kLimbs{"upper", "center", "lower"};
        report::View view = this->view(body);
        if (reader_.has("limb")) view.limb = kLimbs[reader_.choice("limb", kLimbs)];
        return view;
    }
    std::optional<double> optional(const char* key, const figure::Range& range) {
        if (!reader_.has(key)) return {};
        return reader_.number(key, 0, range.min, range.max, false);
    }
    report::DaysText days() {
        report::DaysText text = year();
        text.date = reader_.string("date", "");
        text.from = reader_.string("from", "");
        text.to = reader_.string("to", "");
        return text;
    }
    report::DaysText year() {
        report::DaysText text;
        text.zone = reader_.string("zone", "");
        if (reader_.has("year"))
            text.year = static_cast<int>(reader_.number("year", 0, -1e6, 1e6, true));
        return text;
    }
    /// After the last option: what is wrong with them is said before any work.
    report::Days parse(const report::DaysText& text, const geo::PlaceText& at) {
        reader_.finish();
        report::Days days = text.parse(at.place, session::zone_of);
        days.single = false;
        return days;
    }

  private:
    double degrees(const char* key, double most) {
        reader_.need(key);
        return reader_.number(key, 0, -most, most, false);
    }

    Dem* dem_;
    json::ObjectReader& reader_;
};

/// A figure of days: report::sun_days() and the like.
template <sun::Body body, auto make>
std::string days_answer(AnswerCall& call) {
    const geo::PlaceText at = call.place();
    report::View view = call.light(body);
    view.dip_deg = call.optional("dip", {0, 0, 5});
    const report::Days days = call.parse(call.days(), at);
    const auto result = make(view, days, at, call.ground());
    report::warn_of(result->doubt);
    return json_of(*result);
}

std::shared_ptr<const report::Eclipses> shared_eclipses(const report::View& view,
                                                        const report::Days& days,
                                                        const geo::PlaceText& at,
                                                        const dem::Posts* posts) {
    return std::make_shared<report::Eclipses>(report::eclipses(view, days, at, posts));
}

std::string carpet_answer(AnswerCall& call) {
    const geo::PlaceText at = call.place();
    const report::View view = call.light(sun::Body::Sun);
    const auto step_s = static_cast<int>(call.reader().number("step", 180, 1, 86'400, true));
    const report::Days days = call.parse(call.year(), at);
    const light::TerrainHorizon horizon(call.posts(), at.place, view.horizon(at));
    const report::Carpet result = report::carpet(view, horizon, days, step_s);
    report::warn_of(result.doubt);
    return json_of(result);
}

template <sun::Body body>
std::string when_answer(AnswerCall& call) {
    const geo::PlaceText at = call.place();
    report::View view = call.view(body);
    report::WhenOptions options;
    options.over = call.reader().string("over");
    options.summit_radius_m =
        call.reader().number("summit_radius", options.summit_radius_m, 0, 10'000, false);
    options.tolerance_deg =
        call.reader().number("tolerance", options.tolerance_deg, 0.001, 45, false);
    const report::Days days = call.parse(call.days(), at);
    geo::parse_place(options.over, "--over");
    const report::When result =
        report::when(view, options, days, at, call.posts(), options.target(call.posts()));
    report::warn_of(result);
    return json_of(result);
}

/// A walk as a list of places, with times or without.
dem::NamedLine line_of(json::ObjectReader& reader, const json::Value& walk) {
    using Kind = json::Value::Kind;
    const json::Value* const times = reader.take("times");
    if (walk.items.size() < 2 || walk.items.size() > dem::kMostPlaces)
        reader.fail(walk.line, "walk", "expected a file, or 2 to a million places");
    if (times && times->items.size() != walk.items.size())
        reader.fail(times->line, "times", "expected one for each place of the walk");
    dem::NamedLine line;
    for (std::size_t i = 0; i < walk.items.size(); ++i) {
        const std::vector<json::Value>& place = walk.items[i].items;
        if (place.size() != 2 || place[0].kind != Kind::Number || place[1].kind != Kind::Number)
            reader.fail(walk.line, "walk", "expected [latitude, longitude] of each place");
        dem::NamedPlace& to = line.places.emplace_back();
        to.at = geo::parse_place(fmt::format("{},{}", place[0].number, place[1].number), "walk");
        to.line = i + 1;
        if (!times) continue;
        if (times->items[i].kind != Kind::Number)
            reader.fail(times->line, "times", "expected numbers");
        to.time = sun::exact_iso(instant_of(times->items[i].number));
    }
    return line;
}

std::string along_answer(AnswerCall& call) {
    json::ObjectReader& reader = call.reader();
    const json::Value& walk = reader.need("walk");
    const bool is_file = walk.kind == json::Value::Kind::String;
    const std::string crs = is_file ? reader.string("points_crs", "") : "",
                      name = reader.string("name", "");
    const auto track =
        is_file ? static_cast<int>(reader.number("track", 0, 1, 1'000'000, true)) : 0;
    report::WalkWords words{.start = reader.string("start", ""),
                            .zone = reader.string("zone", ""),
                            .speed_kmh = call.optional("speed", {0, 0.01, 1000}),
                            .parse_start = {},
                            .choose = session::zone_of};
    const report::View view = call.view(sun::Body::Sun);
    dem::NamedLine line;
    if (!is_file) line = line_of(reader, walk);
    reader.finish();
    if (is_file) line = dem::read_line(walk.text, "walk", crs, track);
    const std::string path = is_file ? walk.text : "the walk";
    words.check(line, path);
    const dem::Posts& posts = call.posts();
    words.parse_start = [&](const geo::PlaceText& first) {
        return session::parse({words.start, {}, words.zone},
                              {.middle = [&] { return first.place; },
                               .posts = [&]() -> const dem::Posts& { return posts; }},
                              first);
    };
    report::Along result = report::along(view, words, line, path, posts);
    if (!name.empty()) result.name = name;
    report::warn_of(result.found.doubt);
    return json_of(result);
}

std::string halo_answer(AnswerCall& call) {
    call.reader().need("halo");
    const double halo_m = 1000 * number(call.reader(), figure::kHalo_km);
    call.reader().finish();
    const glm::ivec2 width = figure::FarGround::width_of(call.dem().grid(), halo_m);
    return fmt::format(
        R"({{"columns": {}, "rows": {}, "means": {}}})", width.x, width.y,
        figure::FarGround::means_for(call.posts(), halo_m, call.dem().named().dem.memory));
}

template <sun::Body body>
std::string positions_answer(AnswerCall& call) {
    const geo::PlaceText at = call.place();
    report::View view;
    if (call.reader().has("refraction"))
        view.refraction = refraction_name(call.reader().string("refraction"), "");
    const json::Value& times = call.reader().need("times");
    call.reader().finish();
    const sun::Refraction air = view.air(at.place);
    std::vector<std::string> positions;
    for (const json::Value& time : times.items) {
        if (time.kind != json::Value::Kind::Number)
            call.reader().fail(time.line, "times", "expected numbers");
        sun::ParsedTime when;
        when.utc = instant_of(time.number);
        positions.push_back(json_of(report::position(body, air, at.place, when)));
    }
    return fmt::format(R"({{"positions": [{}]}})", fmt::join(positions, ", "));
}

struct Answer {
    std::string_view figure;
    std::string (*make)(AnswerCall&);
};
constexpr std::array kAnswers{
    Answer{"sun position", positions_answer<sun::Body::Sun>},
    Answer{"sun day", days_answer<sun::Body::Sun, report::sun_days>},
    Answer{"sun eclipses", days_answer<sun::Body::Sun, shared_eclipses>},
    Answer{"sun carpet", carpet_answer},
    Answer{"sun when", when_answer<sun::Body::Sun>},
    Answer{"sun along", along_answer},
    Answer{"moon position", positions_answer<sun::Body::Moon>},
    Answer{"moon day", days_answer<sun::Body::Moon, report::moon_days>},
    Answer{"moon when", when_answer<sun::Body::Moon>},
    Answer{"halo", halo_answer},
};

/// @throws Error (BadInput) for an unknown figure
const Answer& answer_of(std::string_view figure) {
    std::string known;
    for (const Answer& answer : kAnswers) {
        if (answer.figure == figure) return answer;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", answer.figure);
    }
    bad_input(fmt::format("figure: expected one of {} but got {}", known, figure));
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_answer(relevo_dem* dem, const char* figure, const char* options,
                            const char** answer) {
    return c::guarded("relevo_answer", [&] {
        c::need(answer, "answer") = nullptr;
        const c::Answer& asked = c::answer_of(&c::need(figure, "figure"));
        c::Options given(options, "relevo_answer");
        const std::shared_ptr<c::Dem> of = dem ? c::dems().get(dem, "dem") : nullptr;
        c::AnswerCall call(of.get(), given.reader());
        *answer = c::returned_text(asked.make(call));
    });
}

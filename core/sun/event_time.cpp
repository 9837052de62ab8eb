#include "sun/event_time.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "sun/time_fields.h"

namespace relevo::sun {

namespace {

constexpr const char* kTimeWho = "time";
constexpr double kLongestOffset_s = 366 * kDay_s;

struct Name {
    const char* name;
    std::optional<EventKind> event;
    bool last = false;
};
constexpr std::array kNames{Name{"sunrise", EventKind::Sunrise},
                            Name{"sunset", EventKind::Sunset},
                            Name{"noon", EventKind::Transit},
                            Name{"midnight", EventKind::LowerTransit},
                            Name{"civil-dawn", EventKind::CivilDawn},
                            Name{"civil-dusk", EventKind::CivilDusk},
                            Name{"nautical-dawn", EventKind::NauticalDawn},
                            Name{"nautical-dusk", EventKind::NauticalDusk},
                            Name{"astronomical-dawn", EventKind::AstronomicalDawn},
                            Name{"astronomical-dusk", EventKind::AstronomicalDusk},
                            Name{"first-light", std::nullopt},
                            Name{"last-light", std::nullopt, true}};

[[noreturn]] void refuse(const std::string& text, std::string_view what) {
    bad_input(fmt::format("{}: {}: {}", kTimeWho, text, what));
}

}  // namespace

std::optional<double> parse_duration_s(std::string_view text) {
    if (text.empty()) return std::nullopt;
    double sum_s = 0;
    while (!text.empty()) {
        const std::size_t digits = text.find_first_not_of("0123456789.");
        if (digits == 0 || digits == std::string_view::npos) return std::nullopt;
        const auto number = parse_number(text.substr(0, digits));
        text.remove_prefix(digits);
        const std::size_t letters = std::min(text.find_first_of("0123456789."), text.size());
        const std::string_view unit = text.substr(0, letters);
        text.remove_prefix(letters);
        const double unit_s = unit == "h" ? 3600 : unit == "min" ? 60 : unit == "s" ? 1 : 0;
        if (!number || unit_s == 0) return std::nullopt;
        sum_s += *number * unit_s;
    }
    return sum_s;
}

std::optional<double> parse_step_s(std::string_view text) {
    text = trimmed(text);
    const auto minutes = parse_number(text);
    const auto step_s = minutes ? std::optional(60 * *minutes) : parse_duration_s(text);
    if (!step_s || !(*step_s > 0) || std::isinf(*step_s)) return std::nullopt;
    return step_s;
}

bool is_event_time(std::string_view text) {
    return text.find('@') != std::string_view::npos ||
           std::ranges::any_of(kNames, [&](const Name& name) {
               return text.find(name.name) != std::string_view::npos;
           });
}

EventTime parse_event_time(std::string_view text) {
    EventTime time;
    time.text = trimmed(text);
    std::string_view rest = time.text;
    if (const std::size_t at = rest.find('@'); at != std::string_view::npos)
        time.place = geo::parse_place(rest.substr(at + 1), "--time");

    FieldReader reader(time.text, kTimeWho);
    if (const auto date = reader.date()) {
        time.date = date;
        if (!reader.take(' ') && !reader.take('T'))
            refuse(time.text,
                   "no event after the date, expected one such as 2026-06-21 sunrise@46.55,8.56");
        rest = reader.rest();
    }
    rest = trimmed(rest.substr(0, rest.find('@')));

    // Names have dashes, too, but never before a digit.
    std::size_t sign = std::string_view::npos;
    for (std::size_t i = 0; i + 1 < rest.size() && sign == std::string_view::npos; ++i)
        if ((rest[i] == '+' || rest[i] == '-') &&
            std::isdigit(static_cast<unsigned char>(rest[i + 1])) != 0)
            sign = i;
    if (sign != std::string_view::npos) {
        const auto offset_s = parse_duration_s(rest.substr(sign + 1));
        if (!offset_s)
            refuse(time.text, fmt::format("offset \"{}\", expected hours, minutes or seconds such "
                                          "as -30min, +1h30min or +45s",
                                          rest.substr(sign)));
        if (*offset_s > kLongestOffset_s)
            refuse(time.text,
                   fmt::format("offset \"{}\", expected at most {:.0f}h either way; another day is "
                               "named by its date",
                               rest.substr(sign), kLongestOffset_s / 3600));
        time.offset_s = rest[sign] == '-' ? -*offset_s : *offset_s;
        rest = trimmed(rest.substr(0, sign));
    }

    std::string word(rest);
    std::ranges::replace(word, '_', '-');
    const auto found =
        std::ranges::find_if(kNames, [&](const Name& name) { return word == name.name; });
    if (found == kNames.end()) {
        std::vector<std::string> names;
        for (const Name& name : kNames)
            names.emplace_back(name.name);
        const auto meant = nearest(word, names);
        refuse(time.text,
               meant ? fmt::format("no such event as \"{}\"; did you mean {}?", rest, *meant)
                     : fmt::format("no such event as \"{}\", expected one of {}", rest,
                                   fmt::join(names, ", ")));
    }
    time.event = found->event;
    time.last = found->last;
    return time;
}

TimeSpan day_of(const EventTime& time, const std::optional<Date>& given,
                const std::optional<Zone>& zone) {
    if (time.date && given && *time.date != *given)
        refuse(time.text,
               fmt::format("contradicts --date {}; use only one of them", to_string(*given)));
    const std::optional<Date> date = time.date ? time.date : given;
    if (!date)
        refuse(time.text, fmt::format("no date; write 2026-06-21 {} or pass --date", time.text));
    if (!zone)
        refuse(time.text, fmt::format("no time zone to count the day {} by; pass --tz, as in --tz "
                                      "Europe/Zurich",
                                      to_string(*date)));
    return zone->day(*date);
}

TimeSpan span_of_events(const EventTime& time, const std::optional<Date>& given,
                        const std::optional<Zone>& zone, const geo::Geodetic& place) {
    constexpr double kHalfDay_s = kDay_s / 2, kEarliestNoon_s = 8 * 3600, kLatestNoon_s = 16 * 3600;
    const TimeSpan local_day = day_of(time, given, zone);
    const auto noon =
        day_events(PositionTable(local_day.begin, local_day.end), local_day, Observer(place), {})
            .first(EventKind::Transit);
    if (!noon || *noon - local_day.begin < kEarliestNoon_s ||
        *noon - local_day.begin > kLatestNoon_s)
        return local_day;
    return {*noon - kHalfDay_s, *noon + kHalfDay_s};
}

ParsedTime resolve(const EventTime& time, const std::optional<Date>& given,
                   const std::optional<Zone>& zone) {
    const TimeSpan local_day = day_of(time, given, zone);
    if (!time.event) refuse(time.text, "first and last light depend on the terrain; name a DEM");
    if (!time.place)
        refuse(time.text, "no place, expected one after an @ such as sunrise@46.55,8.56");
    const bool is_noon = time.event == EventKind::Transit || time.event == EventKind::LowerTransit;
    const TimeSpan span =
        is_noon ? local_day : span_of_events(time, given, zone, time.place->place);
    const Day day =
        day_events(PositionTable(span.begin, span.end), span, Observer(time.place->place), {});
    const auto utc = day.first(*time.event);
    if (!utc) {
        const Crossing crossing = [&] {
            switch (*time.event) {
                case EventKind::Sunrise:
                case EventKind::Sunset:
                    return day.sun;
                case EventKind::CivilDawn:
                case EventKind::CivilDusk:
                    return day.civil;
                case EventKind::NauticalDawn:
                case EventKind::NauticalDusk:
                    return day.nautical;
                case EventKind::AstronomicalDawn:
                case EventKind::AstronomicalDusk:
                    return day.astronomical;
                case EventKind::Transit:
                case EventKind::LowerTransit:
                case EventKind::Moonrise:
                case EventKind::Moonset:
                    break;
            }
            return Crossing::Crosses;
        }();
        const char* why = crossing == Crossing::AboveAllDay   ? ", the sun stays above all day"
                          : crossing == Crossing::BelowAllDay ? ", the sun stays below all day"
                                                              : "";
        refuse(time.text,
               fmt::format("does not happen on {} in {}{}",
                           to_string(time.date ? *time.date : *given), zone->name(), why));
    }
    ParsedTime result;
    result.utc = *utc + time.offset_s;
    result.zone = *zone;
    return result;
}

}  // namespace relevo::sun

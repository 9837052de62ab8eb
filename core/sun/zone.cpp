#include "sun/zone.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include <date/tz.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "sun/posix_rule.h"
#include "sun/time_fields.h"

namespace relevo::sun {

namespace {

constexpr const char* kDatabase = "/usr/share/zoneinfo";

/// The zone that was probably meant: right but for the case of letters, or the city alone, or the
/// nearest in spelling.
std::optional<std::string> suggestion(std::string_view name) {
    std::vector<std::string> names;
    std::vector<std::string> cities;
    for (const date::time_zone& zone : date::get_tzdb().zones) {
        names.push_back(zone.name());
        cities.push_back(zone.name().substr(zone.name().rfind('/') + 1));
    }
    std::string wanted(name);
    std::ranges::replace(wanted, ' ', '_');
    for (const auto& words : {names, cities})
        for (std::size_t i = 0; i < words.size(); ++i)
            if (equal_ignoring_case(wanted, words[i])) return names[i];
    if (const auto found = nearest(wanted, names)) return found;
    if (const auto found = nearest(wanted, cities))
        return names[static_cast<std::size_t>(std::ranges::find(cities, *found) - cities.begin())];
    return std::nullopt;
}

/// Whether a zone's name, or its city, is the text but for capitals: "Europe/Oslo" is OSLO.
bool is_named_in(std::string_view zone, std::string_view text) {
    return equal_ignoring_case(zone, text) ||
           equal_ignoring_case(zone.substr(zone.rfind('/') + 1), text);
}

/// "PST", "AEST": capitals alone. The nearest name in spelling would be a wrong one.
bool is_abbreviation(std::string_view text) {
    return text.size() <= 5 &&
           std::ranges::all_of(text, [](char c) { return c >= 'A' && c <= 'Z'; });
}

/// The rule for times after the last change listed in a zone's file, a POSIX TZ text: its last
/// line (RFC 8536, 3.3).
std::string rule_after_the_last_change(const std::string& name) {
    std::ifstream file(fmt::format("{}/{}", kDatabase, name), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    if (bytes.size() < 2 || bytes.back() != '\n') return {};
    const std::size_t before = bytes.rfind('\n', bytes.size() - 2);
    if (before == std::string::npos) return {};
    return bytes.substr(before + 1, bytes.size() - before - 2);
}

/// An offset at the start of `text`, which it is cut from: "Z", "+02:00", "-0330", "+02",
/// "+00:34:08". Nothing if there is none.
std::optional<int> take_offset(FieldReader& reader) {
    if (reader.take('Z') || reader.take('z')) return 0;
    const bool west = reader.rest().starts_with('-');
    if (!reader.take('+') && !reader.take('-')) return std::nullopt;
    const auto hours = reader.digits(2);
    if (!hours) reader.fail("bad offset, expected +hh:mm such as +02:00");
    int minutes = 0, seconds = 0;
    if (!reader.rest().empty()) {
        const bool colon = reader.take(':');
        const auto read = reader.digits(2);
        if (!read) reader.fail("bad offset, expected +hh:mm such as +02:00");
        minutes = *read;
        if (colon && reader.take(':')) {
            const auto more = reader.digits(2);
            if (!more) reader.fail("bad offset, expected +hh:mm:ss such as +00:34:08");
            seconds = *more;
        }
    }
    if (*hours > 23 || minutes > 59 || seconds > 59)
        reader.fail("bad offset, expected at most 23:59 either way");
    const int size = *hours * 3600 + minutes * 60 + seconds;
    return west ? -size : size;
}

}  // namespace

Zone::Zone(int utc_offset_s) {
    name_ = utc_offset_s == 0 ? "UTC" : offset_text(utc_offset_s);
    periods_.push_back({INT64_MIN, utc_offset_s, name_});
}

Zone Zone::mean_solar(double lon_rad) {
    constexpr double kDegree_s = kDay_s / 360;
    Zone zone(static_cast<int>(std::lround(degrees(lon_rad) * kDegree_s)));
    zone.name_ = "LMT" + offset_text(zone.periods_.front().utc_offset_s);
    zone.periods_.front().abbreviation = "LMT";
    return zone;
}

Zone Zone::named(std::string_view text) {
    const std::string_view trimmed_text = trimmed(text);
    FieldReader reader(trimmed_text, "time zone");
    if (trimmed_text.empty())
        reader.fail("no time zone, expected a name such as Europe/Zurich or an offset");
    const char first_letter = trimmed_text.front();
    if (first_letter == '+' || first_letter == '-' || equal_ignoring_case(trimmed_text, "Z")) {
        const auto offset = take_offset(reader);
        if (!reader.rest().empty()) reader.fail("bad offset, expected +hh:mm such as +02:00");
        return Zone(*offset);
    }

    if (auto zone = find(trimmed_text)) return *std::move(zone);
    if (trimmed_text.starts_with("UTC") || trimmed_text.starts_with("GMT"))
        reader.fail("no such time zone; write the offset alone, such as +02:00");
    const auto meant = suggestion(trimmed_text);
    if (is_abbreviation(trimmed_text) && !(meant && is_named_in(*meant, trimmed_text)))
        reader.fail(
            "an abbreviation, which several time zones share; write a name such as Europe/Zurich "
            "or an offset such as +02:00");
    reader.fail(meant ? fmt::format("no such time zone; did you mean {}?", *meant)
                      : "no such time zone, expected a name of the IANA database such as "
                        "Europe/Zurich or an offset such as +02:00");
}

std::optional<Zone> Zone::find(std::string_view name) {
    const date::time_zone* found = nullptr;
    try {
        found = date::locate_zone(std::string(name));
    } catch (const std::exception&) {
        return std::nullopt;
    }

    Zone zone;
    zone.name_ = name;
    zone.periods_.clear();
    // A day more at both ends than any local date of 1900-2100 needs.
    const date::sys_seconds first = date::sys_days{date::year{kFirstYear} / 1 / 1} - date::days{3};
    const date::sys_seconds last =
        date::sys_days{date::year{kLastYear + 1} / 1 / 1} + date::days{3};
    const auto add = [&](std::int64_t begin_s, int offset_s, const std::string& abbreviation) {
        if (zone.periods_.empty() || zone.periods_.back().utc_offset_s != offset_s ||
            zone.periods_.back().abbreviation != abbreviation)
            zone.periods_.push_back(
                {zone.periods_.empty() ? INT64_MIN : begin_s * kSecond_us, offset_s, abbreviation});
    };
    date::sys_seconds at = first;
    for (;;) {
        const date::sys_info info = found->get_info(at);
        add(at.time_since_epoch().count(), static_cast<int>(info.offset.count()), info.abbrev);
        if (info.end >= last) break;
        at = info.end;
    }
    // The library knows the listed changes only; what it holds to last for ever follows the rule.
    const std::int64_t listed_until_s = at.time_since_epoch().count();
    for (const OffsetChange& change :
         posix_rule_changes(rule_after_the_last_change(zone.name_), kFirstYear, kLastYear + 1))
        if (change.unix_s > listed_until_s)
            add(change.unix_s, change.utc_offset_s, change.abbreviation);
    return zone;
}

std::size_t Zone::period_at(std::int64_t unix_us) const {
    const auto after =
        std::upper_bound(periods_.begin() + 1, periods_.end(), unix_us,
                         [](std::int64_t us, const Period& p) { return us < p.begin_us; });
    return static_cast<std::size_t>(after - periods_.begin()) - 1;
}

LocalTime Zone::local(Instant instant) const {
    const Period& period = periods_[period_at(instant.unix_us())];
    return {civil_of(instant.unix_us() + period.utc_offset_s * kSecond_us), period.utc_offset_s,
            period.abbreviation};
}

ResolvedTime Zone::resolve(const CivilTime& wall, int fold) const {
    const std::int64_t wall_us = stamp_us(wall);
    // Every period in which the clocks show this. Offsets are less than a day, so those that begin
    // more than a day away cannot.
    const std::size_t from = period_at(wall_us - 86400 * kSecond_us);
    const std::size_t to = period_at(wall_us + 86400 * kSecond_us);
    std::vector<std::size_t> showing;
    std::size_t before_gap = from;
    for (std::size_t i = from; i <= to; ++i) {
        const std::int64_t utc_us = wall_us - periods_[i].utc_offset_s * kSecond_us;
        const bool begun = i == 0 || utc_us >= periods_[i].begin_us;
        const bool ended = i + 1 < periods_.size() && utc_us >= periods_[i + 1].begin_us;
        if (begun && !ended) showing.push_back(i);
        if (begun) before_gap = i;
    }
    ResolvedTime result;
    std::size_t chosen = 0;
    if (showing.empty()) {
        result.kind = WallTimeKind::Nonexistent;
        chosen = fold == 0 ? before_gap : before_gap + 1;
    } else {
        if (showing.size() > 1) result.kind = WallTimeKind::Ambiguous;
        chosen = fold == 0 ? showing.front() : showing.back();
    }
    const Period& period = periods_[chosen];
    result.utc_offset_s = period.utc_offset_s;
    result.abbreviation = period.abbreviation;
    result.utc = Instant::from_unix_us(wall_us - period.utc_offset_s * kSecond_us);
    return result;
}

Instant Zone::first_moment(Date date) const {
    const ResolvedTime midnight = resolve({date});
    if (midnight.kind != WallTimeKind::Nonexistent) return midnight.utc;
    // Read with the offset before the change, a skipped midnight falls just after it.
    return Instant::from_unix_us(periods_[period_at(midnight.utc.unix_us())].begin_us);
}

std::optional<TimeSpan> Zone::find_day(Date date) const {
    const TimeSpan span{first_moment(date), first_moment(add_days(date, 1))};
    if (span.begin >= span.end) return std::nullopt;
    return span;
}

TimeSpan Zone::day(Date date) const {
    if (const auto span = find_day(date)) return *span;
    bad_input(fmt::format("time zone: {}: there was no such day in {}, its clocks skipped it",
                          to_string(date), name_));
}

std::vector<OffsetChange> Zone::offsets(const TimeSpan& span) const {
    std::vector<OffsetChange> changes;
    const std::size_t last = period_at(span.end.unix_us());
    for (std::size_t i = period_at(span.begin.unix_us()); i <= last; ++i) {
        const Period& period = periods_[i];
        changes.push_back({std::max(period.begin_us, span.begin.unix_us()) / kSecond_us,
                           period.utc_offset_s, period.abbreviation});
    }
    return changes;
}

std::string zone_database_version() {
    std::ifstream file(fmt::format("{}/tzdata.zi", kDatabase));
    std::string line;
    std::getline(file, line);
    constexpr std::string_view kLabel = "# version ";
    return line.starts_with(kLabel) ? line.substr(kLabel.size()) : "unknown";
}

std::string to_iso(Instant instant, const Zone& zone, int decimals) {
    const LocalTime local =
        zone.local(Instant::from_unix_us(rounded_us(instant.unix_us(), decimals)));
    return civil_text(local.wall, decimals) + offset_text(local.utc_offset_s);
}

namespace {

constexpr std::string_view kNow = "now";
constexpr std::string_view kForm =
    "not a time, expected YYYY-MM-DDThh:mm with Z or an offset, such as 2026-06-21T18:30+02:00";

/// A time as it stands in a text.
struct WrittenTime {
    CivilTime wall;              ///< what the clocks show
    double fraction_s = 0;       ///< the part of a second beyond it
    std::string_view wall_text;  ///< without the offset
    std::optional<int> offset_s{};
};

/// The seconds behind the colon that has been taken.
void take_seconds(FieldReader& reader, WrittenTime& time) {
    const auto second = reader.digits(2);
    if (!second) reader.fail(kForm);
    if (*second == 60)
        reader.fail("leap seconds cannot be given; take second 59, or 00 of the next minute");
    reader.check("second", *second, 0, 59);
    time.wall.second = *second;
    if (!reader.take('.') && !reader.take(',')) return;
    double unit = 0.1;
    auto digit = reader.digits(1);
    if (!digit) reader.fail(kForm);
    for (; digit; digit = reader.digits(1), unit /= 10)
        time.fraction_s += *digit * unit;
}

WrittenTime take_wall_time(FieldReader& reader) {
    WrittenTime time;
    const auto date = reader.date();
    if (!date) reader.fail(kForm);
    time.wall.date = *date;
    if (reader.rest().empty()) reader.fail("no time of day, expected one such as T18:30 after it");
    if (!reader.take('T') && !reader.take('t') && !reader.take(' ')) reader.fail(kForm);
    const auto hour = reader.digits(2);
    if (!hour || !reader.take(':')) reader.fail(kForm);
    const auto minute = reader.digits(2);
    if (!minute) reader.fail(kForm);
    reader.check("hour", *hour, 0, 23);
    reader.check("minute", *minute, 0, 59);
    time.wall.hour = *hour;
    time.wall.minute = *minute;
    if (reader.take(':')) take_seconds(reader, time);
    return time;
}

/// All of a text. @param reader  of `whole`, nothing taken
WrittenTime read_time(FieldReader& reader, std::string_view whole) {
    WrittenTime time = take_wall_time(reader);
    time.wall_text = whole.substr(0, whole.size() - reader.rest().size());
    reader.take(' ');
    if (!reader.rest().empty()) time.offset_s = take_offset(reader);
    if (!reader.rest().empty()) reader.fail(kForm);
    return time;
}

/// A time with its own offset. @param zone  that it is to be told in, which must not contradict
ParsedTime with_offset(const FieldReader& reader, const WrittenTime& time, int offset_s,
                       const std::optional<Zone>& zone) {
    ParsedTime result;
    result.zone = zone ? *zone : Zone::fixed(offset_s);
    result.utc = Instant::from_utc(time.wall) - offset_s + time.fraction_s;
    const LocalTime there = result.zone.local(result.utc);
    if (offset_s != 0 && there.utc_offset_s != offset_s)
        reader.fail(fmt::format("offset {} contradicts {}, expected {} ({}); use only one of them",
                                offset_text(offset_s), zone->name(),
                                offset_text(there.utc_offset_s), there.abbreviation));
    return result;
}

/// A time by the clocks of a zone.
ParsedTime by_clocks(const WrittenTime& time, const Zone& zone) {
    ParsedTime result;
    result.zone = zone;
    const ResolvedTime taken = zone.resolve(time.wall);
    result.utc = taken.utc + time.fraction_s;
    result.kind = taken.kind;
    if (taken.kind == WallTimeKind::Nonexistent) {
        result.note = fmt::format("{}: does not exist in {} (clocks went forward); taken as {}",
                                  time.wall_text, zone.name(), to_iso(result.utc, zone));
    } else if (taken.kind == WallTimeKind::Ambiguous) {
        const ResolvedTime other = zone.resolve(time.wall, 1);
        result.note = fmt::format(
            "{}: is ambiguous in {} (clocks went back); taken as the first ({}), not the second "
            "({})",
            time.wall_text, zone.name(), offset_text(taken.utc_offset_s),
            offset_text(other.utc_offset_s));
    }
    return result;
}

}  // namespace

ParsedTime parse_time(std::string_view text, const std::optional<Zone>& zone) {
    const std::string_view whole = trimmed(text);
    if (whole == kNow) {
        ParsedTime result;
        result.utc = Instant::now();
        if (zone) result.zone = *zone;
        return result;
    }
    FieldReader reader(whole, "time");
    const WrittenTime time = read_time(reader, whole);
    if (time.offset_s) return with_offset(reader, time, *time.offset_s, zone);
    if (!zone)
        reader.fail(
            fmt::format("no time zone; write {0}Z for UTC or {0}+02:00, or pass --tz Europe/Zurich",
                        time.wall_text));
    return by_clocks(time, *zone);
}

bool is_wall_time(std::string_view text) {
    const std::string_view whole = trimmed(text);
    if (whole == kNow) return false;
    FieldReader reader(whole, "time");
    return !read_time(reader, whole).offset_s;
}

std::vector<LocalDay> local_days(Date first, Date last, const Zone& zone) {
    if (last < first)
        bad_input(fmt::format("sun: from {} to {}: ends before it begins", to_string(first),
                              to_string(last)));
    std::vector<LocalDay> days;
    for (Date date = first; date <= last; date = add_days(date, 1))
        if (const auto span = zone.find_day(date)) days.push_back({date, *span});
    return days;
}

}  // namespace relevo::sun

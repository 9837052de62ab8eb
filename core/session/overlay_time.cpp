#include "session/overlay_time.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "session/stamps.h"

namespace relevo::session {
namespace {

std::string value(const std::map<std::string, std::string>& about, const char* key) {
    const auto found = about.find(key);
    return found == about.end() ? std::string() : found->second;
}

/// nullopt for texts that Relevo does not write
std::optional<sun::ParsedTime> time_of(const std::string& text) {
    try {
        // "now" would differ with every picture.
        if (!text.empty() && text.front() >= '0' && text.front() <= '9')
            return sun::parse_time(text);
    } catch (const Error&) {
    }
    return std::nullopt;
}

/// "2026-06-21 10:12" from ISO 8601; "2026-06-21" at midnight.
std::string words(const std::string& iso) {
    const std::string date = iso.substr(0, 10), clock = iso.substr(11, 5);
    return clock == "00:00" ? date : date + " " + clock;
}

}  // namespace

bool OverlayTime::is_day() const {
    if (from.empty() || words(from).size() > 10) return false;
    constexpr double kDay_s = 86400;
    return time_of(to)->utc - time_of(from)->utc == kDay_s;
}

std::optional<OverlayTime> overlay_time(const std::map<std::string, std::string>& about) {
    OverlayTime time;
    if (const auto utc = time_of(value(about, "TIME_UTC"))) time.utc = utc->utc;
    const auto azimuth = parse_number(value(about, "SUN_AZIMUTH_DEG")),
               apparent = parse_number(value(about, "SUN_APPARENT_ELEVATION_DEG"));
    if (azimuth && apparent)
        time.sun = {*azimuth, *apparent, parse_number(value(about, "SUN_ELEVATION_DEG"))};
    const auto from = time_of(value(about, "TIME_FROM")), to = time_of(value(about, "TIME_TO"));
    if (from && to) {
        time.from = sun::to_iso(from->utc, from->zone);
        time.to = sun::to_iso(to->utc, to->zone);
        time.zone = printable(value(about, "TIME_ZONE"));
    }
    if (!time.sun && time.from.empty()) return std::nullopt;
    return time;
}

std::string clock_text(const OverlayTime& time, const std::string& zone,
                       const geo::Geodetic& middle) {
    if (time.utc) return clock_text(*time.utc, zone, middle);
    if (time.from.empty()) return {};
    std::string to = time.to;
    // A period of whole days is named by its last day, not by the midnight after it.
    if (const bool days = words(time.from).size() == 10 && words(to).size() == 10; days)
        to = sun::to_iso(time_of(to)->utc + -1.0, time_of(to)->zone).substr(0, 10) + "T00:00";
    const std::string first = words(time.from), last = words(to);
    const std::string where = time.zone.empty() ? "" : ", " + time.zone;
    if (first == last) return first + where;
    // Within one day, the date is written once.
    const bool one_day =
        first.size() > 10 && last.size() > 10 && first.substr(0, 10) == last.substr(0, 10);
    return fmt::format("{} to {}{}", first, one_day ? last.substr(11) : last, where);
}

std::string sun_text(const OverlayTime& time) {
    if (!time.sun) return {};
    const auto& [azimuth_deg, apparent_deg, elevation_deg] = *time.sun;
    if (!elevation_deg || std::abs(*elevation_deg - apparent_deg) < 0.005)
        return fmt::format("azimuth {:.2f}, elevation {:.2f}", azimuth_deg, apparent_deg);
    return fmt::format("azimuth {:.2f}, elevation {:.2f} ({:.2f} with refraction)", azimuth_deg,
                       *elevation_deg, apparent_deg);
}

}  // namespace relevo::session

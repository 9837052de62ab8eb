#include "weather/cover_band.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"

namespace relevo::weather {
namespace {

using Metadata = std::map<std::string, std::string>;

constexpr std::int64_t kSingleTimeReach_s = 3600;

struct LevelName {
    std::string_view name;
    CloudLevel level;
};

constexpr std::array<LevelName, 8> kGribElements = {{{"TCDC", CloudLevel::Total},
                                                     {"LCDC", CloudLevel::Low},
                                                     {"MCDC", CloudLevel::Middle},
                                                     {"HCDC", CloudLevel::High},
                                                     {"TCC", CloudLevel::Total},
                                                     {"LCC", CloudLevel::Low},
                                                     {"MCC", CloudLevel::Middle},
                                                     {"HCC", CloudLevel::High}}};

constexpr std::array<LevelName, 4> kStandardNames = {
    {{"cloud_area_fraction", CloudLevel::Total},
     {"low_type_cloud_area_fraction", CloudLevel::Low},
     {"medium_type_cloud_area_fraction", CloudLevel::Middle},
     {"high_type_cloud_area_fraction", CloudLevel::High}}};

constexpr std::array<LevelName, 8> kVariables = {{{"tcc", CloudLevel::Total},
                                                  {"lcc", CloudLevel::Low},
                                                  {"mcc", CloudLevel::Middle},
                                                  {"hcc", CloudLevel::High},
                                                  {"clt", CloudLevel::Total},
                                                  {"cll", CloudLevel::Low},
                                                  {"clm", CloudLevel::Middle},
                                                  {"clh", CloudLevel::High}}};

std::string text_of(const Metadata& about, const std::string& key) {
    const auto found = about.find(key);
    return found == about.end() ? std::string() : found->second;
}

template <std::size_t N>
std::optional<CloudLevel> level_of(const std::array<LevelName, N>& names, std::string_view name) {
    const auto found = std::ranges::find(names, name, &LevelName::name);
    return found == names.end() ? std::nullopt : std::optional(found->level);
}

/// Factor from a unit to shares. GDAL has GRIB's in brackets: "[%]".
double to_share(std::string unit) {
    std::erase_if(unit, [](char c) { return c == '[' || c == ']' || c == ' '; });
    if (unit == "%" || equal_ignoring_case(unit, "percent")) return 0.01;
    for (const std::string_view share : {"", "1", "-", "(0-1)", "0-1", "(0..1)", "fraction"})
        if (unit == share) return 1;
    bad_input(fmt::format("cloud cover in \"{}\", expected % or 1", unit));
}

/// The levels that total cover is given for: "0-EATM" is the whole atmosphere. Others are parts.
bool is_of_all_heights(const std::string& level) {
    const std::string_view kind = std::string_view(level).substr(level.find('-') + 1);
    return kind == "SFC" || kind == "EATM" || kind == "NTAT";
}

std::optional<CoverBand> grib_band(const Metadata& about, const std::string& element) {
    const std::optional<CloudLevel> level = level_of(kGribElements, element);
    const std::string height = text_of(about, "GRIB_SHORT_NAME");
    if (!level || (level == CloudLevel::Total && !height.empty() && !is_of_all_heights(height)))
        return std::nullopt;
    CoverBand band{.level = *level};
    const std::string valid = text_of(about, "GRIB_VALID_TIME");
    const std::string_view time = trimmed(valid);  // "1780315200 sec UTC"
    if (const auto seconds = parse_number(time.substr(0, time.find(' '))))
        band.unix_s = static_cast<std::int64_t>(*seconds);
    const auto product = parse_number(text_of(about, "GRIB_PDS_PDTN"));
    // Product definition templates of statistics over an interval (WMO code table 4.0).
    band.is_mean = product && *product >= 8 && *product <= 14;
    return band;
}

/// The instant of "1900-01-01 00:00:00.0" or "1970-01-01T00:00:00Z" [s since 1970].
std::optional<double> instant_of(std::string_view text) {
    int year = 0, month = 1, day = 1, hour = 0, minute = 0;
    double second = 0;
    const int count = std::sscanf(std::string(text).c_str(), "%d-%d-%d%*[ T]%d:%d:%lf", &year,
                                  &month, &day, &hour, &minute, &second);
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (count < 3 || !date.ok()) return std::nullopt;
    const auto days = std::chrono::sys_days(date).time_since_epoch().count();
    return 86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * minute + second;
}

/// A time of CF: "hours since 1900-01-01".
std::int64_t cf_time_s(double value, const std::string& units, const std::string& calendar) {
    constexpr std::array<std::string_view, 4> kCalendars = {"", "standard", "gregorian",
                                                            "proleptic_gregorian"};
    if (std::ranges::find(kCalendars, calendar) == kCalendars.end())
        bad_input(fmt::format("times of the calendar \"{}\", expected the standard one", calendar));
    const std::size_t since = units.find(" since ");
    const std::string unit = units.substr(0, since);
    const double step_s = unit.starts_with("s")     ? 1
                          : unit.starts_with("min") ? 60
                          : unit.starts_with("h")   ? 3600
                          : unit.starts_with("d")   ? 86400
                                                    : 0;
    const std::optional<double> zero_s = instant_of(trimmed(units.substr(since + 7)));
    if (step_s == 0 || !zero_s)
        bad_input(fmt::format("times in \"{}\", expected as in \"hours since 1970-01-01\"", units));
    return std::llround(*zero_s + step_s * value);
}

std::optional<CoverBand> cf_band(const Metadata& about) {
    std::optional<CloudLevel> level = level_of(kStandardNames, text_of(about, "standard_name"));
    if (!level) level = level_of(kVariables, text_of(about, "NETCDF_VARNAME"));
    if (!level) return std::nullopt;
    CoverBand band{.level = *level};
    constexpr std::string_view kDimension = "NETCDF_DIM_";
    for (const auto& [key, value] : about) {
        if (!key.starts_with(kDimension) || key.ends_with("_DEF") || key.ends_with("_VALUES") ||
            key == "NETCDF_DIM_EXTRA")
            continue;
        const std::string dimension = key.substr(kDimension.size());
        const std::string units = text_of(about, dimension + "#units");
        const std::optional<double> number = parse_number(value);
        if (number && units.find(" since ") != std::string::npos)
            band.unix_s = cf_time_s(*number, units, text_of(about, dimension + "#calendar"));
        else if (!text_of(about, dimension + "#positive").empty() ||
                 text_of(about, dimension + "#axis") == "Z")
            return std::nullopt;  // of one height
    }
    return band;
}

}  // namespace

std::string cover_text(CloudLevel level) {
    switch (level) {
        case CloudLevel::Low:
            return "low cloud cover";
        case CloudLevel::Middle:
            return "middle cloud cover";
        case CloudLevel::High:
            return "high cloud cover";
        case CloudLevel::Total:
            break;
    }
    return "total cloud cover";
}

std::optional<CoverBand> cover_band(const Metadata& about, const std::string& unit) {
    const std::string element = text_of(about, "GRIB_ELEMENT");
    std::optional<CoverBand> band = element.empty() ? cf_band(about) : grib_band(about, element);
    if (!band) return std::nullopt;
    const std::string of_grib = text_of(about, "GRIB_UNIT");
    band->to_share = to_share(of_grib.empty() ? unit : of_grib);
    return band;
}

std::optional<BetweenTimes> between(std::span<const std::int64_t> times_s, std::int64_t unix_s) {
    const std::size_t last = times_s.size() - 1;
    const auto reach = [&](std::size_t at, std::size_t next) {
        return last == 0 ? kSingleTimeReach_s : std::abs(times_s[next] - times_s[at]) / 2;
    };
    if (unix_s <= times_s.front()) {
        if (times_s.front() - unix_s > reach(0, std::min<std::size_t>(1, last)))
            return std::nullopt;
        return BetweenTimes{0, 0, 0};
    }
    if (unix_s >= times_s[last]) {
        if (unix_s - times_s[last] > reach(last, last == 0 ? 0 : last - 1)) return std::nullopt;
        return BetweenTimes{last, last, 0};
    }
    const auto after = std::ranges::upper_bound(times_s, unix_s);
    const auto at = static_cast<std::size_t>(after - times_s.begin());
    const double share = static_cast<double>(unix_s - times_s[at - 1]) /
                         static_cast<double>(times_s[at] - times_s[at - 1]);
    return BetweenTimes{at - 1, share > 0 ? at : at - 1, share};
}

std::string utc_text(std::int64_t unix_s) {
    const std::chrono::sys_seconds time{std::chrono::seconds(unix_s)};
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date{day};
    const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(time - day).count();
    return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                       minutes / 60, minutes % 60);
}

}  // namespace relevo::weather

#include "session/cover_forecast.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/text.h"
#include "overlay/band_over.h"

namespace relevo::session {
namespace {

using weather::CloudLevel;

/// By how much packed values may be beyond 0 and 1.
constexpr double kRounding = 0.005;

/// "low, middle and high"
std::string joined(const std::vector<std::string>& words) {
    if (words.size() == 1) return words.front();
    return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

/// "12:00" of "2026-06-01 12:00 UTC"
std::string clock_of(const std::string& utc) {
    return utc.substr(11, 5);
}

/// "the DEM", "40 % of the DEM"
std::string dem_text(float part) {
    return part < 0.995F ? fmt::format("{:.0f} % of the DEM", 100 * part) : "the DEM";
}

overlay::ValuesAround mixed(const overlay::ValuesAround& before, const overlay::ValuesAround& after,
                            double share_of_after) {
    overlay::ValuesAround around = before;
    if (share_of_after > 0)
        for (std::size_t i = 0; i < around.values.size(); ++i)
            around.values.data()[i] = std::lerp(before.values.data()[i], after.values.data()[i],
                                                static_cast<float>(share_of_after));
    return around;
}

}  // namespace

std::shared_ptr<const render::Field> field_of(overlay::ValuesAround around,
                                              const std::vector<glm::dvec2>& over_dem) {
    auto field = std::make_shared<render::Field>();
    double sum = 0;
    int count = 0;
    for (const glm::dvec2& place : over_dem)
        if (const float value = around.at(place); !std::isnan(value)) {
            sum += double{value};
            ++count;
        }
    field->mean = count > 0 ? static_cast<float>(sum / count) : 0;
    field->part_of_dem = static_cast<float>(count) / static_cast<float>(over_dem.size());
    for (const float value : around.values)
        if (value > field->most) field->most = value;
    field->around = std::move(around);
    return field;
}

CoverForecast::CoverForecast(std::string file, const dem::Grid& dem)
    : file_(std::move(file)), dem_(dem), over_dem_(overlay::places_over_dem(dem)) {
    bool has_timeless = false;
    try {
        for (overlay::BandInFile& band : overlay::bands_of(file_))
            if (const auto about = weather::cover_band(band.about, band.unit)) {
                has_timeless = has_timeless || !about->unix_s;
                if (about->unix_s)
                    found_.push_back({*about, {band.path, band.band, about->to_share}});
            }
    } catch (const Error& error) {
        const std::string_view what = error.what();
        if (what.starts_with(file_)) throw Error(error.code(), fmt::format("weather: {}", what));
        fail(error.what());
    }
    if (found_.empty() && has_timeless)
        fail("its cloud cover has no time; docs/weather.md says how rasters without one are used");
    if (found_.empty())
        fail(
            "no band says that it is cloud cover; docs/weather.md says which words do, and how "
            "other rasters are used");
    for (const CloudLevel level : {CloudLevel::Low, CloudLevel::Middle, CloudLevel::High})
        if (std::ranges::any_of(found_, [&](const Found& f) { return f.about.level == level; }))
            levels_.push_back(level);
    if (levels_.empty()) levels_.push_back(CloudLevel::Total);
    for (const CloudLevel level : levels_)
        series_.push_back(series_of(level));
}

void CoverForecast::fail(const std::string& what) const {
    bad_input(fmt::format("weather: {}: {}", file_, what));
}

CoverForecast::Series CoverForecast::series_of(CloudLevel level) const {
    std::map<std::int64_t, const Found*> by_time;
    for (const Found& found : found_) {
        if (found.about.level != level) continue;
        const Found*& known = by_time[*found.about.unix_s];
        // Of several, such as members of an ensemble, the first; but no mean where there is
        // another.
        if (!known || (known->about.is_mean && !found.about.is_mean)) known = &found;
    }
    Series series;
    for (const auto& [time_s, found] : by_time) {
        series.times_s.push_back(time_s);
        series.bands.push_back(found->band);
    }
    return series;
}

weather::BetweenTimes CoverForecast::place_of(const Series& series, std::int64_t unix_s) const {
    if (const auto place = weather::between(series.times_s, unix_s)) return *place;
    const std::string first = weather::utc_text(series.times_s.front()),
                      last = weather::utc_text(series.times_s.back());
    fail(fmt::format("its times are {}, the picture's is {}; --time sets another",
                     first == last ? first : fmt::format("{} to {}", first, last),
                     weather::utc_text(unix_s)));
}

std::shared_ptr<const overlay::ValuesAround> CoverForecast::values(const Series& series,
                                                                   std::size_t which,
                                                                   CloudLevel level) {
    const Series::Band& band = series.bands[which];
    auto& known = read_[{band.path, band.band}];
    if (known) return known;
    auto around = std::make_shared<overlay::ValuesAround>();
    try {
        *around = overlay::read_band_around(dem_, band.path, band.band);
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("weather: {}", error.what()));
    }
    for (float& value : around->values) {
        const double share = double{value} * band.to_share;
        if (share < -kRounding || share > 1 + kRounding)
            fail(fmt::format("{} of {:.4g} %, expected 0 to 100 %", weather::cover_text(level),
                             100 * share));
        value = std::isnan(share) ? value : static_cast<float>(std::clamp(share, 0.0, 1.0));
    }
    known = std::move(around);
    return known;
}

WeatherFields CoverForecast::at(std::int64_t unix_s) {
    WeatherFields fields;
    std::set<std::pair<std::string, int>> used;
    std::vector<std::string> names, covers;
    std::string times;
    float part = 1;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const Series& series = series_[i];
        const weather::BetweenTimes place = place_of(series, unix_s);
        for (const std::size_t which : {place.before, place.after})
            used.emplace(series.bands[which].path, series.bands[which].band);
        const auto before = values(series, place.before, levels_[i]),
                   after = values(series, place.after, levels_[i]);
        const auto field = field_of(mixed(*before, *after, place.share_of_after), over_dem_);
        fields.emplace(fmt::format("deck_{}_cover", i + 1), field);
        part = std::min(part, field->part_of_dem);
        const std::string name = weather::cover_text(levels_[i]);
        names.push_back(name.substr(0, name.find(' ')));
        covers.push_back(fmt::format("{:.0f}", 100 * field->mean));
        const std::string first = weather::utc_text(series.times_s[place.before]),
                          second = weather::utc_text(series.times_s[place.after]);
        times = first == second ? fmt::format("of {}", first)
                                : fmt::format("between {} and {}", first.substr(0, 16),
                                              clock_of(second) + " UTC");
    }
    std::erase_if(read_, [&](const auto& entry) { return !used.contains(entry.first); });
    summary_ = fmt::format("{}: {} cloud cover, {} % over {}, {}",
                           std::filesystem::path(file_).filename().string(), joined(names),
                           joined(covers), dem_text(part), times);
    return fields;
}

}  // namespace relevo::session

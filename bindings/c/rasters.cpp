#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "dem.h"
#include "dem/clip.h"
#include "figure/horizons.h"
#include "figure/hours.h"
#include "figure/run.h"
#include "figure/shadow.h"
#include "options.h"
#include "session/words.h"

namespace relevo::c {
namespace {

std::string refraction_of(json::ObjectReader& reader) {
    return refraction_name(reader.string("refraction", "standard"), "options: ");
}

/// Values for the caller, made part by part.
class RasterCall {
  public:
    /// @throws BadCall
    RasterCall(relevo_dem* dem, float* values, std::size_t count, const relevo_progress* progress,
               const char** about)
        : dem_(dems().get(dem, "dem")),
          values_(&need(values, "values")),
          count_(count),
          progress_(progress),
          about_(about) {
        if (about_) *about_ = nullptr;
    }

    /// Takes the options that all figures have.
    void take_common(json::ObjectReader& reader, figure::Figure& figure) {
        figure.terrestrial_refraction = number(reader, figure::kTerrestrialRefraction);
        if (reader.has("highest")) figure.highest_m = number(reader, figure::kHighest_m);
        const std::string clip = reader.string("clip", ""), crs = reader.string("clip_crs", "");
        if (!clip.empty()) clip_ = dem::parse_clip(clip, "options: clip");
        if (!crs.empty() && !clip_)
            reader.fail(reader.line_of("clip_crs"), "clip_crs", "needs clip");
        if (!crs.empty()) clip_->crs = geo::Crs::parse(crs, "options: clip_crs");
    }

    const dem::Posts& posts() { return dem_->posts(); }
    light::TerrainAccess terrain() {
        return {.middle = [this] { return dem_->grid().center(); },
                .posts = [this]() -> const dem::Posts& { return posts(); }};
    }

    /// Makes all values, and says what came of them. @throws BadCall
    void run(const figure::Figure& figure) {
        const std::vector<output::RasterBand> bands = figure.bands();
        check_count("count", count_, band_size() * bands.size());
        const dem::Window window = clip_ ? dem::window_of(dem_->grid(), *clip_, "options: clip")
                                         : figure::whole_window(dem_->grid());
        if (clip_) std::fill_n(values_, count_, std::nanf(""));
        const std::optional<light::Beyond> beyond = figure.beyond(posts(), window);
        if (beyond) log::warning(beyond->advice());
        const figure::PartMade made = figure::make_all(
            figure, posts(), window, dem_->named().dem.memory,
            [this](std::size_t band, const dem::Window& part, const Array2d<float>& values) {
                put(band, part, values);
            },
            [this](double share) { progress_.add(share); });
        if (!about_) return;
        nlohmann::ordered_json json{{"definition", made.definition}, {"holes", made.holes}};
        for (const output::RasterBand& band : bands)
            json["bands"].push_back({{"name", band.name}, {"unit", band.unit}});
        if (beyond) json["beyond"] = beyond->text(figure.would());
        for (const auto& [key, value] :
             figure::metadata_of(figure, posts(), RELEVO_VERSION, made, window))
            json["metadata"][key] = value;
        *about_ = returned_text(json.dump());
    }

  private:
    std::size_t band_size() const {
        return static_cast<std::size_t>(dem_->grid().columns()) *
               static_cast<std::size_t>(dem_->grid().rows());
    }
    void put(std::size_t band, const dem::Window& part, const Array2d<float>& values) {
        float* const to = values_ + band * band_size();
        for (int row = 0; row < part.rows; ++row)
            std::ranges::copy(
                values.row(row),
                to + part.column + std::ptrdiff_t{part.row + row} * dem_->grid().columns());
    }

    std::shared_ptr<Dem> dem_;
    float* values_;
    std::size_t count_;
    Progress progress_;
    const char** about_;
    std::optional<dem::Clip> clip_;
};

void shadow(RasterCall& call, json::ObjectReader& reader) {
    scene::TimeSpec spec;
    spec.at = reader.string("time");
    spec.date = reader.string("date", "");
    spec.zone = reader.string("zone", "");
    figure::Shadow figure;
    figure.soft = reader.boolean("soft", false);
    call.take_common(reader, figure);
    figure.refraction = refraction_of(reader);
    reader.finish();
    const sun::ParsedTime when = session::parse(spec, call.terrain());
    figure.suns = {figure::sun_over_middle(call.posts(), when.utc, figure.refraction)};
    call.run(figure);
}

struct Days {
    std::string from, to;  ///< both included
};

/// "date", or "from" and "to", or "year".
Days days_of(json::ObjectReader& reader) {
    const std::string date = reader.string("date", "");
    const Days days{reader.string("from", ""), reader.string("to", "")};
    const int year =
        static_cast<int>(reader.number("year", 0, sun::kFirstYear, sun::kLastYear, true));
    const int given = !date.empty() + (!days.from.empty() || !days.to.empty()) + (year != 0);
    if (given != 1 || days.from.empty() != days.to.empty())
        reader.fail(reader.line(), "", "expected one of date, from and to, or year");
    if (!date.empty()) return {date, date};
    if (year != 0) return {fmt::format("{}-01-01", year), fmt::format("{}-12-31", year)};
    return days;
}

/// From the beginning of the first day to the end of the last one.
sun::TimeSpan time_of(const Days& days, const sun::Zone& zone) {
    const sun::Date first = sun::parse_date(days.from), last = sun::parse_date(days.to);
    if (last < first)
        bad_input(fmt::format("relevo_sun_hours: from: {} is after {}", days.from, days.to));
    return {zone.day(first).begin, zone.day(last).end};
}

/// @throws Error (BadInput) for unknown bands, and for two of one name
void take_bands(json::ObjectReader& reader, figure::Hours& figure) {
    const std::vector<std::string> bands = reader.strings("bands");
    const auto refuse = [&](const std::string& why) {
        reader.fail(reader.line_of("bands"), "bands", why);
    };
    for (const std::string& band : bands)
        if (!contains(figure::Hours::all_words(), band))
            refuse(fmt::format("expected some of {} but got {}",
                               fmt::join(figure::Hours::all_words(), ", "), band));
    if (!bands.empty()) figure.words = bands;
    const std::string repeated = figure.repeated_word();
    if (!repeated.empty()) refuse(repeated + " is named twice");
}

void sun_hours(RasterCall& call, json::ObjectReader& reader) {
    figure::Hours figure;
    const Days days = days_of(reader);
    const std::string zone = reader.string("zone", "");
    take_bands(reader, figure);
    figure.step_s = number(reader, figure::kStep_s);
    for (const char* key : {"linke", "albedo"})
        if (reader.has(key) && !figure.has_irradiation())
            reader.fail(reader.line_of(key), key,
                        "needs one of the bands global, beam, diffuse, reflected");
    figure.irradiation.linke = number(reader, figure::kLinke);
    figure.irradiation.albedo = number(reader, figure::kAlbedo);
    call.take_common(reader, figure);
    figure.refraction = refraction_of(reader);
    reader.finish();
    figure.zone = session::zone_of(zone, call.terrain().middle()).zone;
    figure.time = time_of(days, figure.zone);
    call.run(figure);
}

void sky_view(RasterCall& call, json::ObjectReader& reader) {
    figure::SkyView figure;
    figure.directions = static_cast<int>(number(reader, figure::kSkyDirections, true));
    figure.level = reader.boolean("level", false);
    call.take_common(reader, figure);
    reader.finish();
    call.run(figure);
}

void horizons(RasterCall& call, json::ObjectReader& reader) {
    figure::Horizons figure;
    figure.directions = static_cast<int>(number(reader, figure::kHorizonDirections, true));
    call.take_common(reader, figure);
    reader.finish();
    call.run(figure);
}

/// @param function  of the interface
template <auto make>
relevo_result raster(const char* function, relevo_dem* dem, const char* text, float* values,
                     size_t count, const relevo_progress* progress, const char** about) {
    return guarded(function, [&] {
        RasterCall call(dem, values, count, progress, about);
        Options options(text, function);
        make(call, options.reader());
    });
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_shadow(relevo_dem* dem, const char* options, float* lit, size_t count,
                            const relevo_progress* progress, const char** about) {
    return c::raster<c::shadow>("relevo_shadow", dem, options, lit, count, progress, about);
}

relevo_result relevo_sun_hours(relevo_dem* dem, const char* options, float* values, size_t count,
                               const relevo_progress* progress, const char** about) {
    return c::raster<c::sun_hours>("relevo_sun_hours", dem, options, values, count, progress,
                                   about);
}

relevo_result relevo_sky_view(relevo_dem* dem, const char* options, float* share, size_t count,
                              const relevo_progress* progress, const char** about) {
    return c::raster<c::sky_view>("relevo_sky_view", dem, options, share, count, progress, about);
}

relevo_result relevo_horizons(relevo_dem* dem, const char* options, float* elevation_deg,
                              size_t count, const relevo_progress* progress, const char** about) {
    return c::raster<c::horizons>("relevo_horizons", dem, options, elevation_deg, count, progress,
                                  about);
}

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "dem.h"
#include "figure/horizons.h"
#include "figure/hours.h"
#include "figure/run.h"
#include "figure/shadow.h"
#include "options.h"
#include "session/words.h"

namespace relevo::c {
namespace {

void take_terrestrial(json::ObjectReader& reader, figure::Figure& figure) {
    figure.terrestrial_refraction = number(reader, figure::kTerrestrialRefraction);
    if (reader.has("highest")) figure.highest_m = number(reader, figure::kHighest_m);
}

std::string refraction_of(json::ObjectReader& reader) {
    return refraction_name(reader.string("refraction", "standard"), "options: ");
}

/// Values for the caller, made part by part.
class RasterCall {
  public:
    /// @throws BadCall
    RasterCall(relevo_dem* dem, float* values, std::size_t count, std::size_t bands,
               const relevo_progress* progress, const char** about)
        : dem_(dems().get(dem, "dem")),
          values_(&need(values, "values")),
          columns_(static_cast<std::size_t>(dem_->grid().columns())),
          rows_(static_cast<std::size_t>(dem_->grid().rows())),
          progress_(progress),
          about_(about) {
        check_count("count", count, columns_ * rows_ * bands);
        if (about_) *about_ = nullptr;
    }

    const dem::Posts& posts() { return dem_->posts(); }
    light::TerrainAccess terrain() {
        return {.middle = [this] { return dem_->grid().center(); },
                .posts = [this]() -> const dem::Posts& { return posts(); }};
    }

    /// Makes all values, and says what came of them.
    void run(const figure::Figure& figure) {
        const std::optional<light::Beyond> beyond =
            figure.beyond(posts(), figure::whole_window(dem_->grid()));
        if (beyond) log::warning(beyond->advice());
        const figure::PartMade made = figure::make_all(
            figure, posts(), dem_->named().dem.memory,
            [this](std::size_t band, const dem::Window& part, const Array2d<float>& values) {
                put(band, part, values);
            },
            [this](double share) { progress_.add(share); });
        if (!about_) return;
        nlohmann::ordered_json json{{"definition", made.definition}, {"holes", made.holes}};
        for (const output::RasterBand& band : figure.bands())
            json["bands"].push_back({{"name", band.name}, {"unit", band.unit}});
        if (beyond) json["beyond"] = beyond->text(figure.would());
        *about_ = returned_text(json.dump());
    }

  private:
    void put(std::size_t band, const dem::Window& part, const Array2d<float>& values) {
        for (int row = 0; row < part.rows; ++row) {
            const auto from = values.row(row);
            const std::size_t to_row = band * rows_ + static_cast<std::size_t>(part.row + row);
            std::ranges::copy(from,
                              values_ + to_row * columns_ + static_cast<std::size_t>(part.column));
        }
    }

    std::shared_ptr<Dem> dem_;
    float* values_;
    std::size_t columns_, rows_;
    Progress progress_;
    const char** about_;
};

void shadow(RasterCall& call, const char* text) {
    Options options(text, "relevo_shadow");
    json::ObjectReader& reader = options.reader();
    scene::TimeSpec spec;
    spec.at = reader.string("time");
    spec.date = reader.string("date", "");
    spec.zone = reader.string("zone", "");
    figure::Shadow figure;
    figure.soft = reader.boolean("soft", false);
    take_terrestrial(reader, figure);
    figure.refraction = refraction_of(reader);
    reader.finish();
    const sun::ParsedTime when = session::parse(spec, call.terrain());
    figure.suns = {figure::sun_over_middle(call.posts(), when.utc, figure.refraction)};
    call.run(figure);
}

/// What relevo_sun_hours() is asked for.
struct HoursWanted {
    std::string from, to, zone;
    figure::Hours figure;
};

/// "date", or "from" and "to", or "year".
void take_days(json::ObjectReader& reader, HoursWanted& wanted) {
    const std::string date = reader.string("date", "");
    wanted.from = reader.string("from", "");
    wanted.to = reader.string("to", "");
    const int year =
        static_cast<int>(reader.number("year", 0, sun::kFirstYear, sun::kLastYear, true));
    const int given = !date.empty() + (!wanted.from.empty() || !wanted.to.empty()) + (year != 0);
    if (given != 1 || wanted.from.empty() != wanted.to.empty())
        reader.fail(reader.line(), "", "expected one of date, from and to, or year");
    if (!date.empty()) wanted.from = wanted.to = date;
    if (year != 0) {
        wanted.from = fmt::format("{}-01-01", year);
        wanted.to = fmt::format("{}-12-31", year);
    }
    wanted.zone = reader.string("zone", "");
}

/// @throws Error (BadInput) for unknown bands, and for two of one name
void take_bands(json::ObjectReader& reader, HoursWanted& wanted) {
    const std::vector<std::string> bands = reader.strings("bands");
    for (const std::string& band : bands)
        if (!contains(figure::Hours::all_words(), band))
            reader.fail(reader.line_of("bands"), "bands",
                        fmt::format("expected some of {} but got {}",
                                    fmt::join(figure::Hours::all_words(), ", "), band));
    if (!bands.empty()) wanted.figure.words = bands;
    const std::string repeated = wanted.figure.repeated_word();
    if (!repeated.empty())
        reader.fail(reader.line_of("bands"), "bands", repeated + " is named twice");
}

void take_hours(const char* text, HoursWanted& wanted) {
    Options options(text, "relevo_sun_hours");
    json::ObjectReader& reader = options.reader();
    figure::Hours& figure = wanted.figure;
    take_days(reader, wanted);
    take_bands(reader, wanted);
    figure.step_s = number(reader, figure::kStep_s);
    for (const char* key : {"linke", "albedo"})
        if (reader.has(key) && !figure.has_irradiation())
            reader.fail(reader.line_of(key), key,
                        "needs one of the bands global, beam, diffuse, reflected");
    figure.irradiation.linke = number(reader, figure::kLinke);
    figure.irradiation.albedo = number(reader, figure::kAlbedo);
    take_terrestrial(reader, figure);
    figure.refraction = refraction_of(reader);
    reader.finish();
}

/// From the beginning of the first day to the end of the last one.
void set_time(HoursWanted& wanted, const geo::Geodetic& middle) {
    const sun::Zone zone = session::zone_of(wanted.zone, middle).zone;
    const sun::Date first = sun::parse_date(wanted.from), last = sun::parse_date(wanted.to);
    if (last < first)
        bad_input(fmt::format("relevo_sun_hours: from: {} is after {}", wanted.from, wanted.to));
    wanted.figure.time = {zone.day(first).begin, zone.day(last).end};
    wanted.figure.zone = zone;
}

void sky_view(RasterCall& call, const char* text) {
    Options options(text, "relevo_sky_view");
    json::ObjectReader& reader = options.reader();
    figure::SkyView figure;
    figure.directions = static_cast<int>(number(reader, figure::kSkyDirections, true));
    figure.level = reader.boolean("level", false);
    take_terrestrial(reader, figure);
    reader.finish();
    call.run(figure);
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_shadow(relevo_dem* dem, const char* options, float* lit, size_t count,
                            const relevo_progress* progress, const char** about) {
    return c::guarded("relevo_shadow", [&] {
        c::RasterCall call(dem, lit, count, 1, progress, about);
        c::shadow(call, options);
    });
}

relevo_result relevo_sun_hours(relevo_dem* dem, const char* options, float* values, size_t count,
                               const relevo_progress* progress, const char** about) {
    return c::guarded("relevo_sun_hours", [&] {
        c::HoursWanted wanted;
        c::take_hours(options, wanted);
        c::RasterCall call(dem, values, count, wanted.figure.words.size(), progress, about);
        c::set_time(wanted, call.posts().grid().center());
        call.run(wanted.figure);
    });
}

relevo_result relevo_sky_view(relevo_dem* dem, const char* options, float* share, size_t count,
                              const relevo_progress* progress, const char** about) {
    return c::guarded("relevo_sky_view", [&] {
        c::RasterCall call(dem, share, count, 1, progress, about);
        c::sky_view(call, options);
    });
}

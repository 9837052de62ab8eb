#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "dem.h"
#include "light/raster/beyond.h"
#include "light/raster/horizons.h"
#include "light/raster/shadows.h"
#include "light/raster/sun_hours.h"
#include "options.h"
#include "session/hours_bands.h"
#include "session/sun_raster.h"
#include "session/words.h"

namespace relevo::c {
namespace {

/// Members that the options of all rasters have.
struct Air {
    double terrestrial_refraction = session::kTerrestrialRefraction;
    std::string model = "standard";
    std::optional<double> highest_m;  ///< terrain outside of the DEM

    void take_terrestrial(json::ObjectReader& reader) {
        terrestrial_refraction =
            reader.number("terrestrial_refraction", terrestrial_refraction, -1, 0.9, false);
        if (reader.has("highest")) highest_m = reader.number("highest", 0, -500, 8850, false);
    }
    void take(json::ObjectReader& reader) {
        take_terrestrial(reader);
        model = refraction_name(reader.string("refraction", model), "options: ");
    }
    std::function<sun::Refraction(const geo::Geodetic&)> at_posts() const {
        return [model = model](const geo::Geodetic& place) {
            return session::refraction_at(model, place);
        };
    }
};

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
    dem::Window all() const { return {0, 0, dem_->grid().columns(), dem_->grid().rows()}; }
    std::function<void(double)> done() {
        return [this](double share) { progress_.add(share); };
    }
    light::TerrainAccess terrain() {
        return {.middle = [this] { return dem_->grid().center(); },
                .posts = [this]() -> const dem::Posts& { return posts(); }};
    }

    /// Calls `make` with one part after the other.
    void each_part(const std::function<void(const dem::Window&)>& make) {
        const double all_posts = static_cast<double>(columns_ * rows_);
        std::vector<dem::Window> parts{all()};
        if (!posts().in_memory())
            parts =
                session::raster_parts(all(), dem_->named().dem.memory.posts / session::kPostsAPart);
        for (const dem::Window& part : parts) {
            progress_.begin_part(static_cast<double>(part.columns) * part.rows / all_posts);
            make(part);
        }
    }

    void put(std::size_t band, const dem::Window& part, const Array2d<float>& values) {
        for (int row = 0; row < part.rows; ++row) {
            const auto from = values.row(row);
            const std::size_t to_row = band * rows_ + static_cast<std::size_t>(part.row + row);
            std::ranges::copy(from,
                              values_ + to_row * columns_ + static_cast<std::size_t>(part.column));
        }
    }

    /// Ground beyond the DEM that could change values.
    void warn_of(const std::optional<light::Beyond>& beyond, const char* would) {
        if (!beyond) return;
        beyond_ = beyond->text(would);
        log::warning(beyond->advice());
    }

    void finish(const std::string& definition, std::int64_t holes,
                const std::vector<output::RasterBand>& bands) {
        if (!about_) return;
        nlohmann::ordered_json json{{"definition", definition}, {"holes", holes}};
        for (const output::RasterBand& band : bands)
            json["bands"].push_back({{"name", band.name}, {"unit", band.unit}});
        if (!beyond_.empty()) json["beyond"] = beyond_;
        *about_ = returned_text(json.dump());
    }

  private:
    std::shared_ptr<Dem> dem_;
    float* values_;
    std::size_t columns_, rows_;
    Progress progress_;
    const char** about_;
    std::string beyond_;
};

void shadow(RasterCall& call, const char* text) {
    Options options(text, "relevo_shadow");
    json::ObjectReader& reader = options.reader();
    scene::TimeSpec spec;
    spec.at = reader.string("time");
    spec.date = reader.string("date", "");
    spec.zone = reader.string("zone", "");
    const bool soft = reader.boolean("soft", false);
    Air air;
    air.take(reader);
    reader.finish();

    const dem::Posts& posts = call.posts();
    const sun::ParsedTime when = session::parse(spec, call.terrain());
    const light::SunOverDem sun = session::sun_over_middle(posts, when.utc, air.model).sun;
    light::ShadowOptions wanted{.refraction = air.terrestrial_refraction,
                                .air = air.at_posts(),
                                .soft = soft,
                                .part = {},
                                .done = call.done()};
    light::SunPlan plan(posts, {wanted.refraction, wanted.air}, call.all(), soft);
    plan.add_suns(posts.grid().center(), {sun});
    call.warn_of(light::terrain_beyond(posts, call.all(), {sun}, wanted, air.highest_m),
                 light::kHides);
    std::int64_t holes = 0;
    std::string definition;
    call.each_part([&](const dem::Window& part) {
        wanted.part = part;
        const light::Shadows shadows = light::shadows(plan, plan.suns().front(), wanted);
        call.put(0, part, shadows.lit);
        holes += shadows.holes;
        definition = shadows.definition;
    });
    call.finish(definition, holes, {session::shadow_band(soft)});
}

/// What relevo_sun_hours() is asked for.
struct HoursWanted {
    std::string from, to, zone;
    std::vector<std::string> bands;
    Air air;
    light::SunHoursOptions options;
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
    wanted.bands = reader.strings("bands");
    if (wanted.bands.empty()) wanted.bands = {"hours"};
    for (auto band = wanted.bands.begin(); band != wanted.bands.end(); ++band) {
        if (!contains(session::hours_words(), *band))
            reader.fail(reader.line_of("bands"), "bands",
                        fmt::format("expected some of {} but got {}",
                                    fmt::join(session::hours_words(), ", "), *band));
        if (std::find(wanted.bands.begin(), band, *band) != band)
            reader.fail(reader.line_of("bands"), "bands", *band + " is named twice");
    }
    wanted.options.spells = std::ranges::any_of(wanted.bands, session::needs_spells);
    if (std::ranges::any_of(wanted.bands, session::needs_irradiation))
        wanted.options.irradiation.emplace();
}

HoursWanted hours_wanted(const char* text) {
    Options options(text, "relevo_sun_hours");
    json::ObjectReader& reader = options.reader();
    HoursWanted wanted;
    take_days(reader, wanted);
    take_bands(reader, wanted);
    wanted.options.step_s = reader.number("step", session::kSunStep_s, 1, 3600, false);
    for (const char* key : {"linke", "albedo"})
        if (reader.has(key) && !wanted.options.irradiation)
            reader.fail(reader.line_of(key), key,
                        "needs one of the bands global, beam, diffuse, reflected");
    if (wanted.options.irradiation) {
        wanted.options.irradiation->linke = reader.number("linke", 3, 1, 10, false);
        wanted.options.irradiation->albedo = reader.number("albedo", 0.2, 0, 1, false);
    }
    wanted.air.take(reader);
    reader.finish();
    wanted.options.refraction = wanted.air.terrestrial_refraction;
    wanted.options.air = wanted.air.at_posts();
    return wanted;
}

/// From the beginning of the first day to the end of the last one.
sun::TimeSpan span_of(const HoursWanted& wanted, const geo::Geodetic& middle) {
    const sun::Zone zone = session::zone_of(wanted.zone, middle).zone;
    const sun::Date first = sun::parse_date(wanted.from), last = sun::parse_date(wanted.to);
    if (last < first)
        bad_input(fmt::format("relevo_sun_hours: from: {} is after {}", wanted.from, wanted.to));
    return {zone.day(first).begin, zone.day(last).end};
}

void sun_hours(RasterCall& call, HoursWanted& wanted) {
    const dem::Posts& posts = call.posts();
    const auto [begin, end] = span_of(wanted, posts.grid().center());
    wanted.options.done = call.done();
    wanted.options.part = call.all();
    const light::ShadowOptions sight{.refraction = wanted.options.refraction,
                                     .air = wanted.options.air,
                                     .soft = false,
                                     .part = {},
                                     .done = {}};
    call.warn_of(light::terrain_beyond(posts, call.all(), light::suns_of(posts.grid(), begin, end),
                                       sight, wanted.air.highest_m),
                 light::kHides);
    const light::SunHoursPlan plan(posts, begin, end, wanted.options);
    std::int64_t holes = 0;
    std::string definition;
    call.each_part([&](const dem::Window& part) {
        light::SunHours hours = plan.part(part);
        holes += hours.holes;
        definition = hours.definition;
        for (std::size_t k = 0; k < wanted.bands.size(); ++k)
            call.put(k, part, session::hours_values(wanted.bands[k], hours));
    });
    if (wanted.options.irradiation)
        definition += "; " + session::definition_of(*wanted.options.irradiation);
    std::vector<output::RasterBand> bands;
    for (const std::string& word : wanted.bands)
        bands.push_back(session::hours_band(word));
    call.finish(definition, holes, bands);
}

void sky_view(RasterCall& call, const char* text) {
    Options options(text, "relevo_sky_view");
    json::ObjectReader& reader = options.reader();
    light::SkyViewOptions wanted;
    wanted.directions =
        static_cast<int>(reader.number("directions", session::kSkyDirections, 4, 3600, true));
    wanted.level = reader.boolean("level", false);
    Air air;
    air.take_terrestrial(reader);
    reader.finish();
    wanted.refraction = air.terrestrial_refraction;
    wanted.done = call.done();

    const dem::Posts& posts = call.posts();
    std::vector<double> azimuth_rad;
    for (int i = 0; i < wanted.directions; ++i)
        azimuth_rad.push_back(2 * kPi * i / wanted.directions);
    call.warn_of(
        light::terrain_beyond(posts, call.all(), azimuth_rad, wanted.refraction, air.highest_m),
        light::kStandsOver);
    light::SunPlan plan(posts, {wanted.refraction, {}}, call.all());
    light::add_sky_view_directions(plan, wanted.directions);
    std::int64_t holes = 0;
    std::string definition;
    call.each_part([&](const dem::Window& part) {
        wanted.part = part;
        const light::SkyView view = light::sky_view(plan, wanted);
        call.put(0, part, view.share);
        holes += view.holes;
        definition = view.definition;
    });
    call.finish(definition, holes, {session::sky_view_band()});
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
        c::HoursWanted wanted = c::hours_wanted(options);
        c::RasterCall call(dem, values, count, wanted.bands.size(), progress, about);
        c::sun_hours(call, wanted);
    });
}

relevo_result relevo_sky_view(relevo_dem* dem, const char* options, float* share, size_t count,
                              const relevo_progress* progress, const char** about) {
    return c::guarded("relevo_sky_view", [&] {
        c::RasterCall call(dem, share, count, 1, progress, about);
        c::sky_view(call, options);
    });
}

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/units.h"
#include "dem.h"
#include "figure/options.h"
#include "light/point/horizon.h"
#include "light/point/refraction_at.h"
#include "options.h"
#include "session/words.h"
#include "sun/events.h"
#include "sun/position.h"

namespace relevo::c {

sun::Instant instant_of(double time_s) {
    constexpr double kMost_s = 1e11;  // the year 5138; what is not computed sun::check_year() says
    if (!(std::abs(time_s) < kMost_s))
        bad_input(fmt::format("time: {:.10g}: expected seconds since 1970", time_s));
    return sun::Instant::from_unix_us(std::llround(time_s * 1e6));
}

namespace {

double seconds_of(sun::Instant instant) {
    return static_cast<double>(instant.unix_us()) * 1e-6;
}

/// The model lasts until the thread's next one. A table takes 6 ms, and many times are asked for
/// one after the other.
const sun::Refraction& refraction_of(const char* model, const geo::Geodetic& place) {
    struct Kept {
        std::string name;
        double lat_rad, height_m;  // what models depend on
        sun::Refraction refraction;
    };
    thread_local std::optional<Kept> kept;
    const std::string name = model ? refraction_name(model, "") : "standard";
    if (!kept || kept->name != name || kept->lat_rad != place.lat_rad ||
        kept->height_m != place.height_m)
        kept = Kept{name, place.lat_rad, place.height_m, light::refraction_at(name, place)};
    return kept->refraction;
}

relevo_event event_of(const sun::Event& event) {
    // The names are literals, which end with 0.
    return {sizeof(relevo_event), sun::name_of(event.kind).data(), seconds_of(event.utc),
            degrees(event.azimuth_rad), degrees(event.elevation_rad)};
}

light::HorizonOptions horizon_options(const char* text, size_t directions) {
    Options options(text, "relevo_horizon");
    json::ObjectReader& reader = options.reader();
    light::HorizonOptions result;
    result.eye_height_m = reader.number("eye_height", 0, 0, 10'000, false);
    result.refraction = number(reader, figure::kTerrestrialRefraction);
    constexpr size_t kFew = 30;  // a direction by itself takes a thirtieth of all of them
    result.few_directions = directions < kFew;
    reader.finish();
    return result;
}

}  // namespace
}  // namespace relevo::c

using namespace relevo;

relevo_result relevo_sun_position(const relevo_place* place, const double* times_s, size_t count,
                                  const char* refraction, double* azimuth_deg,
                                  double* elevation_deg, double* apparent_deg) {
    return c::guarded("relevo_sun_position", [&] {
        const geo::Geodetic at = c::place_of(place);
        if (count > 0) c::need(times_s, "times_s");
        const sun::Refraction& air = c::refraction_of(refraction, at);
        for (size_t i = 0; i < count; ++i) {
            const sun::Position position = sun::position(c::instant_of(times_s[i]), at);
            if (azimuth_deg) azimuth_deg[i] = degrees(position.azimuth_rad);
            if (elevation_deg) elevation_deg[i] = degrees(position.elevation_rad);
            if (apparent_deg) apparent_deg[i] = degrees(air.apparent_rad(position.elevation_rad));
        }
    });
}

relevo_result relevo_sun_events(const relevo_place* place, const char* date, const char* zone,
                                relevo_event* events, size_t capacity, size_t* count) {
    return c::guarded("relevo_sun_events", [&] {
        c::need(count, "count") = 0;
        // The caller's events are as large as the first one says.
        const size_t size = capacity > 0 ? c::read_struct(events, "events").size : 0;
        const geo::Geodetic at = c::place_of(place);
        const sun::Day day = sun::day_events(sun::parse_date(&c::need(date, "date")),
                                             session::zone_of(zone ? zone : "", at).zone, at);
        *count = day.events.size();
        for (size_t i = 0; i < std::min(capacity, day.events.size()); ++i)
            c::write_struct(c::event_of(day.events[i]), size,
                            reinterpret_cast<char*>(events) + i * size);
    });
}

relevo_result relevo_horizon(relevo_dem* dem, const relevo_place* place, const char* options,
                             const double* azimuth_deg, size_t count, double* elevation_deg,
                             double* distance_m) {
    return c::guarded("relevo_horizon", [&] {
        const geo::Geodetic at = c::place_of(place);
        const light::HorizonOptions wanted = c::horizon_options(options, count);
        if (count > 0) {
            c::need(azimuth_deg, "azimuth_deg");
            c::need(elevation_deg, "elevation_deg");
        }
        const auto of = c::dems().get(dem, "dem");
        const light::TerrainHorizon horizon(of->posts(), at, wanted);
        for (size_t i = 0; i < count; ++i) {
            if (!std::isfinite(azimuth_deg[i]))
                bad_input("azimuth_deg: expected finite numbers of degrees");
            const light::HorizonPoint point = horizon.at(radians(azimuth_deg[i]));
            elevation_deg[i] = degrees(point.elevation_rad);
            if (distance_m) distance_m[i] = point.distance_m;
        }
    });
}

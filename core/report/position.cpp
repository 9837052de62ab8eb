#include "report/position.h"

#include <nlohmann/json.hpp>

#include "base/units.h"
#include "report/json_parts.h"
#include "sun/moon.h"

namespace relevo::report {

using nlohmann::ordered_json;

namespace {

std::vector<Number> figures_of(const sun::MoonPosition& moon) {
    return {{"illuminated_fraction", moon.illuminated_fraction, "{:.6f}"},
            {"phase_angle_deg", degrees(moon.phase_angle_rad), "{:.6f}"},
            {"elongation_deg", degrees(moon.elongation_rad), "{:.6f}"},
            {"bright_limb_deg", degrees(moon.bright_limb_rad), "{:.4f}"},
            {"bright_limb_from_zenith_deg", degrees(moon.bright_limb_from_zenith_rad), "{:.4f}"},
            {"phase_longitude_deg", degrees(moon.phase_longitude_rad), "{:.6f}"}};
}

}  // namespace

Number BodyPosition::distance() const {
    constexpr double kAu_km = 149'597'870.7;
    if (body == sun::Body::Sun) return {"distance_au", sky.distance_au, "{:.9f}"};
    return {"distance_km", sky.distance_au * kAu_km, "{:.3f}"};
}

BodyPosition position(sun::Body body, const sun::Refraction& air, const geo::Geodetic& place,
                      const sun::ParsedTime& when) {
    BodyPosition result{body, place, when, {}, air, 0, {}, {}};
    if (body == sun::Body::Sun) {
        const sun::Position sun = sun::position(when.utc, place);
        result.sky = sun;
        result.more = {{"equation_of_time_min", sun.equation_of_time_s / 60, "{:.5f}"}};
    } else {
        const sun::MoonPosition moon = sun::moon_position(when.utc, place);
        result.sky = moon;
        result.more = figures_of(moon);
        result.phase = sun::phase_name(moon.phase_longitude_rad);
    }
    result.apparent_deg = degrees(result.air.apparent_rad(result.sky.elevation_rad));
    return result;
}

std::string json_of(const BodyPosition& result) {
    const sun::SkyPosition& sky = result.sky;
    const Number distance = result.distance();
    ordered_json json = {{"schema", fmt::format("relevo-{}-position-1", sun::name_of(result.body))},
                         {"utc", sun::to_iso(result.when.utc, 3)},
                         {"azimuth_deg", degrees(sky.azimuth_rad)},
                         {"elevation_deg", degrees(sky.elevation_rad)},
                         {"apparent_elevation_deg", result.apparent_deg},
                         {"refraction", result.air.description()},
                         {distance.key, distance.value},
                         {"declination_deg", degrees(sky.declination_rad)},
                         {"right_ascension_deg", degrees(sky.right_ascension_rad)},
                         {"semidiameter_deg", degrees(sky.semidiameter_rad)}};
    for (const Number& figure : result.more)
        json[figure.key] = figure.value;
    if (!result.phase.empty()) json["phase"] = result.phase;
    add_assumption(json, result.when.assumption);
    return json.dump();
}

}  // namespace relevo::report

#include "report/when.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/units.h"
#include "light/point/ground_at.h"
#include "report/doubts.h"
#include "report/json_parts.h"

namespace relevo::report {

using nlohmann::ordered_json;

geo::Geodetic WhenOptions::target(const dem::Posts& posts) const {
    const geo::PlaceText summit = geo::parse_place(over, "--over");
    if (summit.has_height && !summit.above_ground) return summit.place;
    geo::Geodetic target =
        light::summit_near(posts, summit.place, summit.has_height ? 0 : summit_radius_m);
    target.height_m += summit.place.height_m;
    return target;
}

bool When::through_hole() const {
    return found.sight.hole ||
           std::ranges::any_of(found.passages, [](const light::Alignment& p) { return p.hole; });
}

When when(const View& view, const WhenOptions& options, const Days& asked, const geo::PlaceText& at,
          const dem::Posts& posts, const geo::Geodetic& target) {
    When result;
    result.asked = asked;
    result.horizon = std::make_unique<light::TerrainHorizon>(posts, at.place, view.horizon(at));
    result.body = view.body;
    light::AlignmentOptions wanted;
    wanted.body = view.body;
    wanted.tolerance_rad = radians(options.tolerance_deg);
    wanted.refraction = view.air(result.horizon->place());
    result.found =
        light::alignments(*result.horizon, target, asked.first, asked.last, asked.zone, wanted);
    result.doubt = light::doubt_of(*result.horizon, result.found, view.highest_m);
    return result;
}

std::string visible_key(sun::Body body) {
    return fmt::format("{}_visible", sun::name_of(body));
}

std::string json_of(const When& result) {
    const light::TerrainHorizon& horizon = *result.horizon;
    const light::Alignments& found = result.found;
    const sun::Zone& zone = result.asked.zone;
    auto json = json_of_shape<ordered_json>(fmt::format("{}-when", sun::name_of(result.body)));
    json["place"] = place_json<ordered_json>(horizon.place());
    json["eye_m"] = horizon.eye_m();
    json["target"] = place_json<ordered_json>(found.target);
    json["sight"] = {{"azimuth_deg", angle_deg(found.sight.azimuth_rad)},
                     {"elevation_deg", angle_deg(found.sight.elevation_rad)},
                     {"distance_m", found.sight.distance_m},
                     {"visible", found.sight.visible},
                     {"hidden_by_deg", angle_deg(found.sight.hidden_by_rad)}};
    if (found.sight.hole) json["sight"]["hole"] = true;
    json["zone"] = zone.name();
    add_assumption(json, result.asked.assumption);
    json["definition"] = found.definition;
    ordered_json& passages = json["passages"] = ordered_json::array();
    for (const light::Alignment& p : found.passages) {
        passages.push_back({{"utc", utc_json<ordered_json>(p.utc)},
                            {"local", sun::to_iso(p.utc, zone)},
                            {"date", sun::to_string(p.date)},
                            {"separation_deg", angle_deg(p.separation_rad)},
                            {"right_deg", angle_deg(p.right_rad)},
                            {"above_deg", angle_deg(p.above_rad)},
                            {"azimuth_deg", angle_deg(p.azimuth_rad)},
                            {"apparent_elevation_deg", angle_deg(p.elevation_rad)},
                            {visible_key(result.body), p.sun_visible}});
        if (p.hole) passages.back()["hole"] = true;
    }
    return json.dump();
}

void warn_of(const When& result) {
    if (result.through_hole())
        log::warning(
            fmt::format("the DEM has voids in the way: ground in them could hide the summit or the "
                        "{} over it; use a DEM without voids",
                        sun::name_of(result.body)));
    warn_of(result.doubt);
}

}  // namespace relevo::report

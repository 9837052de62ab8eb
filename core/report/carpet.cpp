#include "report/carpet.h"

#include <nlohmann/json.hpp>

#include "report/doubts.h"
#include "report/json_parts.h"

namespace relevo::report {

using nlohmann::ordered_json;

Carpet carpet(const View& view, const light::TerrainHorizon& horizon, const Days& asked,
              int step_s) {
    const light::DirectLight direct(horizon, view.light(horizon.place()));
    Carpet result{light::carpet(direct, asked.first.year, asked.zone, step_s),
                  {},
                  asked.assumption,
                  horizon.place(),
                  horizon.description()};
    result.doubt = light::doubt_of(direct, result.carpet.days, horizon.profile(kDoubtDirections),
                                   view.highest_m);
    return result;
}

std::array<MonthSums, 12> months_of(const light::Carpet& carpet) {
    std::array<MonthSums, 12> months;
    for (std::size_t i = 0; i < carpet.days.size(); ++i) {
        MonthSums& month = months[static_cast<std::size_t>(carpet.days[i].date.month - 1)];
        month.lit_s += carpet.days[i].lit_s;
        month.level_s += carpet.day_level_s[i];
    }
    return months;
}

std::string json_of(const Carpet& result) {
    const light::Carpet& carpet = result.carpet;
    const light::Doubt& doubt = result.doubt;
    auto json = json_of_shape<ordered_json>("sun-carpet");
    json["place"] = place_json<ordered_json>(result.place);
    json["zone"] = carpet.zone.name();
    add_assumption(json, result.assumption);
    json["year"] = carpet.year;
    json["light_definition"] = carpet.definition;
    json["horizon_definition"] = result.horizon_definition;
    json["direct_sun_h"] = carpet.lit_s / 3600;
    json["level_horizon_h"] = carpet.level_s / 3600;
    const bool holes = !doubt.holes.empty();
    if (holes) {
        json["not_known_h"] = carpet.not_known_s / 3600;
        json["hole_sectors"] = sectors_json<ordered_json>(doubt.holes);
    }
    ordered_json& months = json["months"] = ordered_json::array();
    for (const MonthSums& month : months_of(carpet))
        months.push_back(
            {{"direct_sun_h", month.lit_s / 3600}, {"level_horizon_h", month.level_s / 3600}});
    ordered_json& days = json["days"] = ordered_json::array();
    for (std::size_t i = 0; i < carpet.days.size(); ++i) {
        const light::LightDay& day = carpet.days[i];
        ordered_json lit = ordered_json::array();
        for (const light::LitInterval& interval : day.lit) {
            lit.push_back({{"first_utc", utc_json<ordered_json>(interval.begin.utc)},
                           {"last_utc", utc_json<ordered_json>(interval.end.utc)}});
            if (!interval.not_known.empty())
                lit.back()["not_known"] = spans_json<ordered_json>(interval.not_known);
        }
        days.push_back({{"date", sun::to_string(day.date)},
                        {"direct_sun", lit},
                        {"direct_sun_h", day.lit_s / 3600},
                        {"level_horizon_h", carpet.day_level_s[i] / 3600}});
        if (holes) days.back()["not_known_h"] = day.not_known_s / 3600;
    }
    return json.dump();
}

}  // namespace relevo::report

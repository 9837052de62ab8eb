#include "session/scene_weather.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"

namespace relevo::session {
namespace {

double ground_in_the_middle_m(const LoadedDem& dem) {
    const double height_m = dem.height_m(dem.source->grid().center());
    const render::Ground ground = ground_of(dem);
    const double ground_m =
        std::isnan(height_m) ? 0.5 * (ground.lowest_m + ground.highest_m) : height_m;
    // No station is on the floor of a sea.
    return ground.sea_floor_share > 0 ? std::max(ground_m, 0.0) : ground_m;
}

/// The standard lapse makes a warm station on a mountain a furnace at sea level.
void check_air(const SceneWeather& weather) {
    if (!weather.air) return;
    const double sea_level_c = weather.air->temperature_at_c(0);
    if (sea_level_c < -90 || sea_level_c > 70)
        bad_input(fmt::format(
            "weather: {:.0f} C at a station {:.0f} m high is {:.0f} C at sea level; see "
            "--station-height",
            weather.air->temperature_c, weather.station_m, sea_level_c));
}

}  // namespace

void SceneWeather::set_time(std::int64_t unix_s) {
    if (forecast) fields = forecast->at(unix_s);
}

std::string SceneWeather::notice(bool has_time, bool from_outside) const {
    std::string said =
        fmt::format("weather: {}", report ? weather::summary(*report) : forecast->summary());
    if (!station_is_given)
        said +=
            fmt::format("; {} {:.0f} m, the ground in the DEM's middle, --station-height sets it",
                        report ? "station at" : "bases count from", station_m);
    if (report && !has_time) said += "; the report names no month, so --time sets the time";
    if (from_outside && (contains(facts.words, "cloudy") || contains(facts.words, "foggy")))
        said += "; clouds and fog are not drawn from outside the DEM, --eye stands in it";
    return said;
}

std::optional<SceneWeather> weather_of(const scene::Scene& scene, const LoadedDem& dem) {
    if (scene.weather.empty() && scene.forecast.empty()) return std::nullopt;
    SceneWeather weather;
    weather.station_is_given = scene.station_height_m.has_value();
    weather.station_m =
        weather.station_is_given ? *scene.station_height_m : ground_in_the_middle_m(dem);
    if (!scene.forecast.empty()) {
        weather.forecast = std::make_shared<CoverForecast>(scene.forecast, dem.source->grid());
        weather.facts = weather::facts_of(weather.forecast->levels(), weather.station_m);
        return weather;
    }
    weather.report = weather::parse_metar(scene.weather);
    weather.air = weather::station_air(*weather.report, weather.station_m);
    check_air(weather);
    weather.facts = weather::facts_of(*weather.report, weather.station_m);
    return weather;
}

}  // namespace relevo::session

#include "session/scene_weather.h"

#include <cmath>

#include <fmt/format.h>

namespace relevo::session {
namespace {

double ground_in_the_middle_m(const LoadedDem& dem) {
    const double height_m = dem.height_m(dem.source->grid().center());
    if (!std::isnan(height_m)) return height_m;
    const render::Ground ground = ground_of(dem);
    return 0.5 * (ground.lowest_m + ground.highest_m);
}

}  // namespace

std::string SceneWeather::notice(bool has_time) const {
    std::string said = fmt::format("weather: {}", weather::summary(report));
    if (!station_is_given)
        said += fmt::format(
            "; station at {:.0f} m, the ground in the DEM's middle, --station-height "
            "sets it",
            station_m);
    if (!has_time) said += "; the report names no month, so --time sets the time";
    return said;
}

std::optional<SceneWeather> weather_of(const scene::Scene& scene, const LoadedDem& dem) {
    if (scene.weather.empty()) return std::nullopt;
    SceneWeather weather;
    weather.report = weather::parse_metar(scene.weather);
    weather.station_is_given = scene.station_height_m.has_value();
    weather.station_m =
        weather.station_is_given ? *scene.station_height_m : ground_in_the_middle_m(dem);
    weather.air = weather::station_air(weather.report, weather.station_m);
    weather.facts = weather::facts_of(weather.report, weather.station_m);
    return weather;
}

}  // namespace relevo::session

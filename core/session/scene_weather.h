#pragma once

#include <memory>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "session/cover_forecast.h"
#include "session/session.h"
#include "weather/facts.h"
#include "weather/station_air.h"

namespace relevo::session {

/// The weather of a scene over its DEM.
struct SceneWeather {
    std::optional<weather::Metar> report;
    std::shared_ptr<CoverForecast> forecast;  ///< null: `report` is set
    WeatherFields fields;                     ///< of the forecast, at the time of set_time()
    double station_m = 0;  ///< height above sea level that bases of clouds count from
    bool station_is_given = false;
    std::optional<weather::StationAir> air;  ///< that refraction takes
    weather::Facts facts;

    /// Reads the forecast at a time. @throws Error as CoverForecast::at(), before any change
    void set_time(std::int64_t unix_s);
    /// What the report or the forecast says and what was taken for what it does not say, on one
    /// line.
    /// @param has_time      the scene has a time of its own
    /// @param from_outside  the DEM is seen as a block, or as a map
    std::string notice(bool has_time, bool from_outside) const;
};

/// None without Scene::weather and Scene::forecast. The station is at the ground in the middle of
/// the DEM if its height is not given: reports do not say where it is.
/// @throws Error (BadInput) as weather::parse_metar() and CoverForecast
std::optional<SceneWeather> weather_of(const scene::Scene& scene, const LoadedDem& dem);

}  // namespace relevo::session

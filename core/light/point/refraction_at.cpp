#include "light/point/refraction_at.h"

namespace relevo::light {

sun::Refraction refraction_at(const std::string& model, const geo::Geodetic& place,
                              const std::optional<weather::StationAir>& air) {
    constexpr double kWeather_m = 11000;  // above the weather, the standard atmosphere
    if (model == "none") return sun::Refraction::none();
    if (model == "saemundsson") return sun::Refraction::saemundsson();
    if (air && place.height_m < kWeather_m)
        return sun::Refraction::integrated(
            {.air = {air->pressure_hpa(place.height_m), air->temperature_at_c(place.height_m)},
             .height_m = place.height_m,
             .latitude_rad = place.lat_rad});
    return sun::Refraction::standard(place);
}

}  // namespace relevo::light

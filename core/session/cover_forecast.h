#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dem/grid.h"
#include "overlay/band_around.h"
#include "render/fields.h"
#include "weather/cover_band.h"

namespace relevo::session {

/// Fields by their names in weather::fact_fields().
using WeatherFields = std::map<std::string, std::shared_ptr<const render::Field>>;

/// Cloud cover of a file of forecasts around a DEM (GRIB, NetCDF and what else GDAL opens).
class CoverForecast {
  public:
    /// Reads what the file's bands are, not their values.
    /// @throws Error (BadInput) `weather: FILE: ...` as overlay::bands_of() and
    /// weather::cover_band(),
    ///     and for a file without cloud cover or without its times
    CoverForecast(std::string file, const dem::Grid& dem);

    const std::string& file() const { return file_; }
    /// From below; total cover only if it has no other.
    const std::vector<weather::CloudLevel>& levels() const { return levels_; }

    /// Cover of each level at a time, 0 to 1, as decks from below: linear between the two times
    /// around it. Places without a value have none. Bands of the last two times stay in memory.
    /// @throws Error (BadInput) for a time that the file does not have, cover below 0 or above 1,
    ///     and as overlay::read_band_around()
    WeatherFields at(std::int64_t unix_s);

    /// What the last call of at() has read: "forecast.grib2: low and high cloud cover, 30 and 15 %
    /// over the DEM, between 12:00 and 15:00 UTC".
    const std::string& summary() const { return summary_; }

  private:
    /// Of a level: times and where their values are.
    struct Series {
        std::vector<std::int64_t> times_s;  // rising
        struct Band {
            std::string path;
            int band = 1;
            double to_share = 1;
        };
        std::vector<Band> bands;
    };
    Series series_of(weather::CloudLevel level) const;
    weather::BetweenTimes place_of(const Series& series, std::int64_t unix_s) const;
    std::shared_ptr<const overlay::ValuesAround> values(const Series& series, std::size_t which,
                                                        weather::CloudLevel level);
    [[noreturn]] void fail(const std::string& what) const;

    struct Found {
        weather::CoverBand about;
        Series::Band band;
    };
    std::string file_, summary_;
    dem::Grid dem_;
    std::vector<glm::dvec2> over_dem_;
    std::vector<Found> found_;
    std::vector<weather::CloudLevel> levels_;
    std::vector<Series> series_;  // of levels_
    std::map<std::pair<std::string, int>, std::shared_ptr<const overlay::ValuesAround>> read_;
};

/// A field with its mean over a DEM and its largest value.
std::shared_ptr<const render::Field> field_of(overlay::ValuesAround around,
                                              const std::vector<glm::dvec2>& over_dem);

}  // namespace relevo::session

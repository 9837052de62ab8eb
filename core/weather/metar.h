#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Weather from reports, and the light below clouds. Pure: text and numbers in, numbers out.
namespace relevo::weather {

/// A cloud layer of a report.
struct CloudLayer {
    enum class Kind { Plain, ToweringCumulus, Cumulonimbus };

    int least_oktas = 0, most_oktas = 0;  ///< FEW 1 to 2, SCT 3 to 4, BKN 5 to 7, OVC 8
    std::optional<double> base_m;         ///< above the station; none: BKN///
    Kind kind = Kind::Plain;

    /// The middle of the range, 0 to 1: FEW 3/16, SCT 7/16, BKN 3/4, OVC 1.
    double cover() const { return (least_oktas + most_oktas) / 16.0; }
};

/// Precipitation and what obscures the air, as the groups of present weather have them.
struct PresentWeather {
    enum class Intensity { Light, Moderate, Heavy };

    bool rain = false, drizzle = false, snow = false, hail = false, thunder = false;
    bool fog = false, mist = false;
    bool shallow_fog = false;                   ///< MIFG: below eye level
    Intensity intensity = Intensity::Moderate;  ///< of the heaviest precipitation
};

/// A METAR or SPECI. What the report does not say is none.
struct Metar {
    std::string text;                   ///< the report on one line, as it was given
    std::string station;                ///< four letters or digits: "LSZB"
    int day = 0, hour = 0, minute = 0;  ///< UTC; the report names no month
    bool is_auto = false, is_corrected = false;

    std::optional<double> wind_m_s, gust_m_s;
    std::optional<double> wind_from_deg;  ///< true; none: calm or variable
    std::optional<double> visibility_m;   ///< horizontal, the prevailing one
    bool visibility_is_least = false;     ///< it is that or more: 9999, CAVOK, P6SM
    PresentWeather present;
    std::vector<CloudLayer> clouds;  ///< in the order of the report
    bool sky_is_clear = false;       ///< CAVOK, NSC, NCD, SKC, CLR: none below 1500 m or 3600 m
    std::optional<double> vertical_visibility_m;  ///< VV: the sky is obscured
    std::optional<double> temperature_c, dew_point_c;
    std::optional<double> qnh_hpa;  ///< pressure reduced to sea level by the standard atmosphere
};

/// Reads one report; the date that archives have before it is skipped. Runway visual range, runway
/// states, recent weather, wind shear, colour states and all after RMK, NOSIG, BECMG, TEMPO and
/// TREND are skipped.
/// @throws Error (BadInput) `weather: METAR LSZB: "BKNX40": what is wrong`; also for NIL
/// Source: WMO-No. 306, Manual on Codes, I.1, FM 15 METAR and FM 16 SPECI; for US reports FMH-1.
Metar parse_metar(std::string_view text);

/// Whether a word of the command line is a report and not the name of a file of reports: it has
/// blanks between words and begins as reports do.
bool is_report(std::string_view text);

/// Whether a word of the command line names a file of rasters and not one of reports: it has bytes
/// of 0, as no text has, or is GDAL's virtual raster.
bool is_forecast_file(const std::string& text_or_file);

/// The report of a text as given to `--weather`: the text itself, or the last report in that file
/// that can be read. Lines of dates, as NOAA's files have them, and empty lines are skipped; a
/// report goes on over lines that begin with blanks, and may end in `=`.
/// @throws Error (BadInput) for a file that cannot be read or has no report; for a single wrong
///     report the error of parse_metar()
std::string report_of(const std::string& text_or_file);

}  // namespace relevo::weather

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geo/geodetic.h"
#include "light/plane/plane_light.h"
#include "sun/zone.h"

/// Reads tables of irradiance: EPW (EnergyPlus), typical years of PVGIS (CSV, JSON), CSV of the
/// NSRDB (with its two lines about the site), and plain CSV; each also with .gz. The beginning of a
/// file tells its format.
///
/// An EPW row is the hour that ends at its stamp; its minute is 0 or 60 and is not added. PVGIS
/// names instants, `irradiance_time_offset` hours after the row's time, in its EPW too, whose clock
/// is UTC. The NSRDB's rows are instants at their stamps, which its own zenith angles confirm. A
/// plain CSV has the columns time, or begin and end, and ghi, dni, dhi; its times have offsets, or
/// are of a zone that is given. Rows follow each other without a gap, but for the months of a
/// typical year, whose years differ.
namespace relevo::light {

/// What the time of a row is.
struct RowTime {
    enum class Kind { End, Begin, Instant };
    Kind kind = Kind::Begin;
    double instant_h = 0;  ///< from the time to the instant [0, 1)

    /// "end", "begin", "instant", "instant+0.5"; nothing for another text.
    static std::optional<RowTime> parse(std::string_view text);
};

struct IrradianceOptions {
    std::optional<RowTime> interval;  ///< of a plain CSV's column time
    std::optional<sun::Zone> zone;    ///< of times without an offset
};

struct IrradianceTable {
    std::vector<Irradiance> rows;
    std::optional<double> instant_s;  ///< after a row's begin, when its values were; none: means
    sun::Zone clock;                  ///< the file's
    std::optional<geo::Geodetic> place;
    bool typical = false;       ///< months of different years
    bool sparse = false;        ///< instants more than an hour apart, which have no sums
    std::string description;    ///< format, place, what the rows are
    const char* unit = "line";  ///< what Irradiance::line counts: "entry" of a JSON
};

/// @param who  what errors begin with, "--irradiance"
/// @throws Error (BadInput) `who: path: line 17: what` for a file that is none of these, a missing
///     value (9999), one that is negative or above 2500 W/m2, a gap, rows out of order, times of
///     two zones, 29 February in a typical year, minutes that are not those of the format; (Usage)
///     for an interval that is missing, or not needed
IrradianceTable read_irradiance(const std::string& path, std::string_view who,
                                const IrradianceOptions& options = {});

}  // namespace relevo::light

#pragma once

#include <functional>
#include <optional>
#include <string>

#include "geo/geodetic.h"
#include "light/point/direct_light.h"
#include "light/point/horizon.h"
#include "sun/zone_of_place.h"

/// Figures of light at a place, as values and as JSON: what the command line and the library say.
namespace relevo::report {

/// Local days, and the zone that they are days of.
struct Days {
    sun::Date first, last;
    sun::Zone zone;
    std::string assumption;  ///< of the zone; empty where none was made
    bool single = false;     ///< asked for by its date
};

using ChooseZone = std::function<sun::ChosenZone(const std::string&, const geo::Geodetic&)>;

/// Days by the words of --date, or --from and --to, or --year; and --tz.
struct DaysText {
    std::string date, from, to, zone;
    std::optional<int> year;

    bool given() const { return !date.empty() || !from.empty() || !to.empty() || year; }
    /// @param place  whose zone is taken where --tz names none
    /// @throws Error (Usage) for no date or too many, (BadInput) for a day that is none, dates
    ///     backwards, a year that is not computed, and as `choose`
    Days parse(const geo::Geodetic& place, const ChooseZone& choose) const;
};

/// How a place is looked from, and what rising and shining mean there.
struct View {
    sun::Body body = sun::Body::Sun;
    std::optional<double> eye_height_m;  ///< above the ground
    double terrestrial_refraction = light::HorizonOptions().refraction;
    std::optional<double> highest_m;        ///< of terrain beyond the DEM
    std::optional<std::string> refraction;  ///< as light::refraction_at(); none: not asked for
    std::optional<std::string> limb;        ///< "upper", "center", "lower"
    std::optional<double> dip_deg;          ///< of a flat horizon; none: by the eye's height

    sun::Refraction air(const geo::Geodetic& place) const;
    /// Over a level horizon: the Naval Observatory's, unless an option says otherwise.
    /// @throws Error (Usage) for --dip together with --eye-height
    sun::RiseRule rule(const geo::Geodetic& place) const;
    light::LightOptions light(const geo::Geodetic& place) const;
    /// @throws Error (Usage) for an eye's height where the place has one too
    light::HorizonOptions horizon(const geo::PlaceText& at) const;
};

/// @throws Error (Usage) for a height above the ground where there is no DEM
void check_has_ground(const geo::PlaceText& at);

}  // namespace relevo::report

#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "geo/geodetic.h"
#include "sun/earth_rotation.h"
#include "sun/moon.h"
#include "sun/time.h"
#include "sun/zone.h"

/// Eclipses of the sun at a place. The moon's limb is a circle: mountains and valleys along it
/// shift real contacts by up to 3 s. Darkening of the sun's limb is not modelled.
namespace relevo::sun {

/// Share of the area of the sun's disc that the moon does not cover [0, 1].
/// @param sun_rad, moon_rad  semidiameters
/// @param separation_rad     of the centres
double visible_fraction(double sun_rad, double moon_rad, double separation_rad);

/// The same of positions at one time, from one place; 1 without an eclipse.
double sun_visible_fraction(const Position& sun, const MoonPosition& moon);

enum class EclipseKind { Partial, Annular, Total };

/// "partial", "annular", "total".
std::string_view name_of(EclipseKind kind);

/// The sun at a time of an eclipse.
struct EclipseMoment {
    Instant utc;
    double azimuth_rad = 0;    ///< of the sun's centre, clockwise from true north
    double elevation_rad = 0;  ///< of the centre, true
    /// From the sun's limb nearest the moon's centre to the moon's far limb, over the sun's
    /// diameter: in a partial phase the fraction of it that is covered, above 1 where all is. By
    /// the moon's larger radius, so that near the limit of totality a partial eclipse may have a
    /// magnitude just above 1.
    double magnitude = 0;
    double obscuration = 0;  ///< fraction of the sun's area that is covered
};

/// An eclipse as it is at a place, whether the sun is up or not.
struct SolarEclipse {
    EclipseKind kind = EclipseKind::Partial;
    EclipseMoment first;                  ///< contact: the partial phase begins
    std::optional<EclipseMoment> second;  ///< the total or annular phase begins
    EclipseMoment greatest;               ///< the magnitude is largest
    std::optional<EclipseMoment> third;   ///< the total or annular phase ends
    EclipseMoment last;                   ///< fourth contact

    TimeSpan span() const { return {first.utc, last.utc}; }
};

/// All eclipses at a place whose fourth contact is not before `from` and first not after `to`.
/// @throws Error (BadInput) outside 1900-2100 and for an impossible place
/// Accuracy: contacts of EclipseWise (F. Espenak) within 2 s where UT1 is known
/// (tests/sun/test_eclipse.cpp prints them). Times to come depend on UT1 - UTC, which is held at
/// its last value: a second for every second that it changes. Source: the moon's radius in units of
/// the Earth's equatorial one is k = 0.2725076 for first and fourth contact and 0.2722810 for
/// second and third (IAU 1982, and without the limb's valleys; F. Espenak and J. Meeus,
/// NASA/TP-2006-214141); the sun's semidiameter 959.63 arcsec at 1 au (A. Auwers 1891, as in all
/// tables of eclipses).
std::vector<SolarEclipse> solar_eclipses(Instant from, Instant to, const geo::Geodetic& place,
                                         const EarthRotation& rotation = EarthRotation::built_in());

/// The largest magnitude of an eclipse within spans of time, such as those in which the sun is up.
/// Nothing if it is within none of them.
/// @param rotation  that the eclipse was computed with
std::optional<EclipseMoment> greatest_within(
    const SolarEclipse& eclipse, const std::vector<TimeSpan>& spans, const geo::Geodetic& place,
    const EarthRotation& rotation = EarthRotation::built_in());

}  // namespace relevo::sun

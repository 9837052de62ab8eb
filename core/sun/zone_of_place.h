#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geo/geodetic.h"
#include "sun/zone.h"

/// Which time zone a place is in.
namespace relevo::sun {

/// The zones of the whole Earth, in cells of a tenth of a degree: one that a border goes through
/// has the zone of most of its land. At sea, farther than half a degree from land, it is Etc/GMT
/// with the hour of the longitude. data/README.md has the sources and what is known to be wrong.
class ZoneMap {
  public:
    /// @param path  a file of tools/make_time_zones.py
    /// @throws Error (BadInput) `time zone: path: ...` where it is missing or damaged
    static ZoneMap read(const std::filesystem::path& path);
    /// The one that Relevo comes with. Takes 0.5 ms (tests/sun/test_zone_of_place.cpp).
    static ZoneMap shipped();

    /// The IANA name of the zone at a place.
    const std::string& name_at(const geo::Geodetic& place) const;

    const std::vector<std::string>& names() const { return names_; }

  private:
    friend class ZoneMapReader;

    /// Cells of a row that are not as in the row above.
    struct Span {
        int first, end, name;
    };
    int columns_ = 0, rows_ = 0;
    std::vector<std::string> names_;
    std::vector<Span> spans_;            // row after row
    std::vector<std::size_t> row_ends_;  // of each row, in spans_
};

/// A zone, and how it came about.
struct ChosenZone {
    Zone zone;
    /// "time zone Europe/Zurich of the place"; empty where nothing was assumed.
    std::string assumption;
    bool missing = false;  ///< this computer's database lacks the zone of the place
};

/// The zone of the clocks at a place. Where this computer's database lacks it, the fixed offset of
/// the longitude in whole hours.
/// Accuracy: the offsets of 40 cities in January and July are right
/// (tests/sun/test_zone_of_place.cpp); within 10 km of a border it is a guess.
ChosenZone zone_at(const geo::Geodetic& place, const ZoneMap& map);

/// Whether the words of `--tz` mean a zone that hangs on the place: "auto", "solar", or nothing,
/// which is "auto".
bool is_zone_by_place(std::string_view words);

/// Whether they are "solar".
bool is_solar_zone(std::string_view words);

/// The zone that the words of `--tz` mean: Zone::named(), "solar" for Zone::mean_solar(), "auto" or
/// nothing for zone_at() by the map that Relevo comes with.
/// @throws Error (BadInput) as those
ChosenZone choose_zone(std::string_view words, const geo::Geodetic& place);

}  // namespace relevo::sun

#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sun/zone.h"

namespace relevo::scene {

/// What names of pictures are made of.
struct NameParts {
    std::size_t number = 0;  ///< of the picture, from 1: {n}, {n:04}
    std::string dem;         ///< name of the DEM's file without its ending
    sun::Instant utc;
    sun::Zone zone;
    std::map<std::string, std::string> names;  ///< {camera}, {site}, {haze.density}, ...
};

/// Names of files by a pattern: `{dem}_{time:%Y%m%dT%H%M}_{n:04}.png`. {time:...} takes the
/// conversions of C's strftime, {n:04} a width; {{ and }} are braces.
class NameTemplate {
  public:
    /// @param known  names of NameParts::names that there are
    /// @throws Error (BadInput) `expected E but got G`, to which the caller puts the place
    NameTemplate(std::string_view text, const std::vector<std::string>& known);

    /// The name; in what is filled in, characters that are none of a file's name become `-`.
    std::string name(const NameParts& parts) const;

  private:
    struct Piece {
        std::string key;   ///< empty: `text` as it is
        std::string text;  ///< what stands behind the colon
    };
    void add_field(std::string_view field, const std::vector<std::string>& known);

    std::vector<Piece> pieces_;
};

}  // namespace relevo::scene

#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/file_stamps.h"
#include "chart/legend.h"
#include "dem/grid.h"
#include "render/ground_rasters.h"
#include "session/active_effects.h"
#include "session/overlay.h"

namespace relevo::session {

/// The rasters that active effects lay over a DEM, read from the files that their texts name.
class EffectRasters {
  public:
    EffectRasters() = default;
    /// Reports effects that draw nothing because no file is named.
    /// @param grid     of the DEM's posts
    /// @param earlier  read before over the same grid; what has not changed is not read again
    /// @throws Error (BadInput) as read_overlay() and overlay::read_band_over(), `drape.file: ...`
    EffectRasters(const ActiveEffects& effects, const dem::Grid& grid,
                  const EffectRasters& earlier = {});

    render::NamedRasters named() const;
    /// Of rasters of one band that are drawn in colours.
    /// @param zone, middle  as dated_legend()
    std::vector<chart::Legend> legends(const std::string& zone, const geo::Geodetic& middle) const;

  private:
    struct Source {
        std::string file, colours;
        bool is_values = false;
        bool operator==(const Source&) const = default;
    };
    struct Entry {
        Source source;
        FileStamps stamps;
        Overlay overlay{};  ///< without a raster if no file is named
    };
    static Entry read(const Source& source, const dem::Grid& grid);

    std::map<std::string, Entry> entries_;  // by resource
};

}  // namespace relevo::session

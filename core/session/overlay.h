#pragma once

#include <memory>
#include <optional>

#include "base/array2d.h"
#include "chart/legend.h"
#include "dem/grid.h"
#include "image/image.h"
#include "render/overlay_raster.h"
#include "scene/scene.h"
#include "session/overlay_time.h"

/// Rasters that lie on the ground, with what their colours mean.
namespace relevo::session {

struct Overlay {
    std::shared_ptr<const render::OverlayRaster> raster;
    std::optional<chart::Legend> legend;  ///< nullopt: colours without a meaning, as of a photo
    std::optional<OverlayTime> time{};    ///< set if it shows sunlight
    bool has_given_title = false;
};

/// The legend, if there is one. For a sun overlay its title includes the time, unless the title was
/// given.
/// @param zone, middle  as clock_text()
std::optional<chart::Legend> dated_legend(const Overlay& overlay, const std::string& zone,
                                          const geo::Geodetic& middle);

/// @param values   on the DEM's grid, as overlay::BandOver
/// @param opacity  0 to 1, multiplies that of the colours
/// @param lit      as render::OverlayRaster::lit
Overlay overlay_of(const Array2d<float>& values, chart::Legend legend, double opacity,
                   bool lit = false);

/// Default ramp: from 0 for hours, 0 to 1 for fractions, else from the lowest to the highest value.
/// @param name, unit  of the band, as written by Relevo or other GDAL programs
chart::Ramp usual_ramp(const Array2d<float>& values, const std::string& name,
                       const std::string& unit);

/// Has the legend of minutes since the beginning of a day show times of day, unless the clocks are
/// changed on it. Changes no other legend.
void show_as_clock(const OverlayTime& time, chart::Legend& legend);

/// Time of a scene's overlay, read from metadata only; nullopt if it is not a sun raster.
/// @throws Error (BadInput) as overlay::band_metadata()
std::optional<OverlayTime> time_of(const scene::Overlay& overlay);
/// OverlayTime::utc of the scene's overlay: the default time of its picture.
std::optional<sun::Instant> instant_of_overlay(const scene::Scene& scene);

/// Reads a scene's overlay: an image of 8 bits as a photo in its own colours, unless the scene has
/// colours or a range for it, or a band other than the first. Else a band, resampled to the DEM's
/// posts.
/// @param grid  of the DEM's posts
/// @throws Error (BadInput) as overlay::Photo::open(), overlay::read_band_over(),
/// chart::named_ramp() and
///     read_ramp(), and for colours of more than 8 bits
Overlay read_overlay(const scene::Overlay& overlay, const dem::Grid& grid);

}  // namespace relevo::session

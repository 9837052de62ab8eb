#pragma once

#include <memory>
#include <optional>

#include "base/array2d.h"
#include "base/files_in_use.h"
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
    chart::Legend legend;
    std::optional<OverlayTime> time{};  ///< set if it shows sunlight
    bool has_given_title = false;
};

/// The legend. For a sun overlay its title includes the time, unless the title was given.
/// @param zone, middle  as clock_text()
chart::Legend dated_legend(const Overlay& overlay, const std::string& zone,
                           const geo::Geodetic& middle);

/// @param values   on the DEM's grid, as dem::BandOver
/// @param opacity  0 to 1, multiplies that of the colours
Overlay overlay_of(const Array2d<float>& values, chart::Legend legend, double opacity);

/// Default ramp: from 0 for hours, 0 to 1 for fractions, else from the lowest to the highest value.
/// @param name, unit  of the band, as written by Relevo or other GDAL programs
chart::Ramp usual_ramp(const Array2d<float>& values, const std::string& name,
                       const std::string& unit);

/// Time of a scene's overlay, read from metadata only; nullopt if it is not a sun raster.
/// @throws Error (BadInput) as dem::band_metadata()
std::optional<OverlayTime> time_of(const scene::Overlay& overlay);

/// Reads a scene's overlay, resampled to the DEM's posts.
/// @param grid  of the DEM's posts
/// @throws Error (BadInput) as dem::read_band_over(), chart::named_ramp() and read_ramp()
Overlay read_overlay(const scene::Overlay& overlay, const dem::Grid& grid);

/// Adds the files of an overlay to the inputs of a run.
void add_files(const scene::Overlay& overlay, FilesInUse& files);

}  // namespace relevo::session

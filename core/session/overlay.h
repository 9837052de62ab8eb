#pragma once

#include <memory>
#include <optional>

#include "base/array2d.h"
#include "base/files_in_use.h"
#include "chart/legend.h"
#include "dem/grid.h"
#include "image/image.h"
#include "render/drape.h"
#include "scene/scene.h"
#include "session/overlay_time.h"

/// Rasters that lie on the ground, with what their colours mean.
namespace relevo::session {

struct Overlay {
    std::shared_ptr<const render::Drape> drape;
    chart::Legend legend;
    std::optional<OverlayTime> time{};  ///< where it is of the sun
    bool has_given_title = false;
};

/// The legend, with the time of an overlay of the sun in its title unless the title was given.
/// @param zone, middle  as clock_text()
chart::Legend dated_legend(const Overlay& overlay, const std::string& zone,
                           const geo::Geodetic& middle);

/// @param values  over the DEM's grid, as dem::BandOver has them
Overlay overlay_of(const Array2d<float>& values, chart::Legend legend, double opacity);

/// The ramp for values of a kind where nobody names one: hours from 0 on, shares from 0 to 1, else
/// from the least value to the greatest.
/// @param name, unit  of the band, as ours and GDAL's have them
chart::Ramp usual_ramp(const Array2d<float>& values, const std::string& name,
                       const std::string& unit);

/// The time of a scene's overlay, of which nothing else is read; none where it is not of the sun.
/// @throws Error (BadInput) as dem::band_metadata()
std::optional<OverlayTime> time_of(const scene::Overlay& overlay);

/// Reads the raster of a scene's overlay.
/// @param grid  of the DEM's posts
/// @throws Error (BadInput) as dem::read_band_over(), chart::named_ramp() and read_ramp()
Overlay read_overlay(const scene::Overlay& overlay, const dem::Grid& grid);

/// Adds what an overlay is read from to what a run reads.
void add_files(const scene::Overlay& overlay, FilesInUse& files);

}  // namespace relevo::session

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "base/output_file.h"
#include "figure/figure.h"
#include "session/overlay_time.h"
#include "sun/zone.h"

/// Figures of the sun as the window shows and saves them.
namespace relevo::session {

enum class SunFigure {
    Hours,        ///< of direct sun in a period
    FirstLight,   ///< minutes from the beginning of a period to the first direct sun
    LastLight,    ///< to the last one
    Irradiation,  ///< global clear-sky irradiation in a period, with the defaults of --linke,
                  ///< --albedo
    Shadow,       ///< at one time
    SkyView,      ///< sky-view factor
};

/// True for the figures of `relevo sun hours`, which are of a period.
bool is_of_period(SunFigure figure);
/// The band of `relevo sun hours` that has a figure: "first". Requires is_of_period().
std::string_view hours_word(SunFigure figure);

/// What to compute at each post.
struct SunRasterWanted {
    SunFigure figure = SunFigure::Hours;
    sun::Instant begin, end;  ///< a period; a shadow's time is `begin`
    sun::Zone zone;           ///< time zone in the metadata
    std::string refraction = "standard";
};

/// True if both request the same values.
bool same_figures(const SunRasterWanted& a, const SunRasterWanted& b);

/// Values over a part of a DEM.
struct SunRaster {
    Array2d<float> values;  ///< in the unit of band_of(). NaN in voids, and where there is no light
    std::int64_t holes = 0;
    std::string definition;
};

output::RasterBand band_of(SunFigure figure);

/// The time that such a raster shows, as overlay_time() of its file; nullopt for the sky view.
std::optional<OverlayTime> time_of(const dem::Posts& posts, const SunRasterWanted& wanted);

/// Computes parts of a raster, one after the other, with a shared plan.
using SunRasterMaker = std::function<SunRaster(const dem::Window& part)>;
/// @param window  posts that will be requested; zero columns: all
/// @param done    as light::ShadowOptions::done
/// @throws Error (BadInput) as light::sun_hours(), shadows() and sky_view()
SunRasterMaker sun_raster_maker(const dem::Posts& posts, const SunRasterWanted& wanted,
                                const dem::Window& window = {},
                                const std::function<void(double)>& done = {});

/// @param part  as in light::ShadowOptions; zero columns: all
/// @param done  as light::ShadowOptions::done; an exception from it ends the computation
/// @throws Error (BadInput) as light::sun_hours(), shadows() and sky_view()
SunRaster sun_raster(const dem::Posts& posts, const SunRasterWanted& wanted,
                     const dem::Window& part = {}, const std::function<void(double)>& done = {});

/// Writes the same bytes as `relevo sun hours`, `sun shadow` or `sun sky-view`.
/// @param whole    values at all posts if already computed; null: computed in parts
/// @param most     posts of a part
/// @param version  of Relevo
/// @param done     called with the fraction completed since its last call; an exception ends the
///     computation
/// @throws Error as sun_raster() and output::RasterWriter
void write_sun_raster(OutputFile& file, const dem::Posts& posts, const SunRasterWanted& wanted,
                      const SunRaster* whole, std::int64_t most, const std::string& version,
                      const std::function<void(double)>& done = {});

}  // namespace relevo::session

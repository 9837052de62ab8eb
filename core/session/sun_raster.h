#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "base/output_file.h"
#include "dem/posts.h"
#include "light/raster/shadows.h"
#include "output/raster_writer.h"
#include "session/overlay_time.h"
#include "sun/zone.h"

/// Rasters of sunlight over a DEM, identical from the command line and the viewer.
namespace relevo::session {

/// Defaults of --terrestrial-refraction, --step and --directions.
inline constexpr double kTerrestrialRefraction = 0.13;
inline constexpr double kSunStep_s = 180;
inline constexpr int kSkyDirections = 36;

/// Band names and units in files.
output::RasterBand shadow_band(bool soft);
output::RasterBand sky_view_band();

/// The sun as seen from the centre of a DEM.
struct SunOverMiddle {
    light::SunOverDem sun;
    double apparent_rad = 0;  ///< apparent elevation from the ground there
    std::optional<sun::Instant> utc;
};

/// @param refraction  as scene::Scene; computed at the height of the central post, or of the lowest
///     post if that is void
SunOverMiddle sun_over_middle(const dem::Posts& posts, sun::Instant utc,
                              const std::string& refraction);

/// Direction and time of the sun.
output::RasterMetadata metadata_of(const SunOverMiddle& sun);

/// Describes a refraction model, evaluated at each post.
std::string air_of_posts(const std::string& refraction, const dem::Posts& posts);

/// Metadata common to all rasters of light.
/// @param version  of Relevo
/// @param clip     window of the DEM's posts, if not all
output::RasterMetadata raster_metadata(const dem::Posts& posts, const std::string& version,
                                       const std::string& definition, double terrestrial_refraction,
                                       std::int64_t holes,
                                       const std::optional<dem::Window>& clip = {});

/// 0 in the shade, 1 lit, 255 without data. @param lit  as light::Shadows
Array2d<std::uint8_t> mask_of(const Array2d<float>& lit);

/// Splits a window into squares of at most `most_posts` posts and of whole 512-post blocks. Small
/// parts would sweep the same ground repeatedly.
std::vector<dem::Window> raster_parts(const dem::Window& window, std::int64_t most_posts);

/// Divisor of the memory limit in posts for a part of the result: a result post takes several times
/// the memory of a height.
inline constexpr std::int64_t kPostsAPart = 8;

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

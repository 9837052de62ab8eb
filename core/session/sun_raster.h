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
#include "sun/zone.h"

/// Rasters of the sun over a DEM, as the command line and the window make them alike.
namespace relevo::session {

/// --terrestrial-refraction, --step and --directions where nobody asks for others.
inline constexpr double kTerrestrialRefraction = 0.13;
inline constexpr double kSunStep_s = 180;
inline constexpr int kSkyDirections = 36;

/// Bands as files have them.
output::RasterBand sun_hours_band();
output::RasterBand shadow_band(bool soft);
output::RasterBand sky_view_band();

/// The sun over the middle of a DEM.
struct SunOverMiddle {
    light::SunOverDem sun;
    double apparent_rad = 0;  ///< elevation as seen from the ground there
    std::optional<sun::Instant> utc;
};

/// @param refraction  as scene::Scene; of the ground in the middle, or the lowest post's where that
///     is a hole
SunOverMiddle sun_over_middle(const dem::Posts& posts, sun::Instant utc,
                              const std::string& refraction);

/// Where the sun stands, and when.
output::RasterMetadata metadata_of(const SunOverMiddle& sun);

/// A refraction's model in words, over each post.
std::string air_of_posts(const std::string& refraction, const dem::Posts& posts);

/// What every raster of light says of itself.
/// @param version  of the program
/// @param clip     of the DEM's posts, where it is not all of them
output::RasterMetadata raster_metadata(const dem::Posts& posts, const std::string& version,
                                       const std::string& definition, double terrestrial_refraction,
                                       std::int64_t holes,
                                       const std::optional<dem::Window>& clip = {});

/// 0 in the shade, 1 lit, 255 without a figure. @param lit  as light::Shadows
Array2d<std::uint8_t> mask_of(const Array2d<float>& lit);

/// Squares of a window, one after the other, of so many posts at most, but of whole blocks of the
/// result: smaller ones would sweep the same ground again and again.
std::vector<dem::Window> raster_parts(const dem::Window& window, std::int64_t most_posts);

/// Of a DEM beyond its memory a part of the result has this share of the posts that may be in
/// memory, as each takes some times as much as a height.
inline constexpr std::int64_t kPostsAPart = 8;

enum class SunFigure { Hours, Shadow, SkyView };

/// What is asked of each post.
struct SunRasterWanted {
    SunFigure figure = SunFigure::Hours;
    sun::Instant begin, end;  ///< of the hours; a shadow's moment is `begin`
    sun::Zone zone;           ///< that they are told in
    std::string refraction = "standard";
};

/// Whether the figures are the same.
bool same_figures(const SunRasterWanted& a, const SunRasterWanted& b);

/// Figures of a part of a DEM.
struct SunRaster {
    Array2d<float> values;  ///< hours; 0 or 1; a share. NaN in holes
    std::int64_t holes = 0;
    std::string definition;
};

output::RasterBand band_of(SunFigure figure);

/// Makes the figures of parts of a DEM, one after the other, by one plan.
using SunRasterMaker = std::function<SunRaster(const dem::Window& part)>;
/// @param window  posts that will be asked for; without columns: all
/// @param done    as light::ShadowOptions::done
/// @throws Error (BadInput) as light::sun_hours(), shadows() and sky_view()
SunRasterMaker sun_raster_maker(const dem::Posts& posts, const SunRasterWanted& wanted,
                                const dem::Window& window = {},
                                const std::function<void(double)>& done = {});

/// @param part  as in light::ShadowOptions; without columns: all
/// @param done  likewise; what it throws ends the work
/// @throws Error (BadInput) as light::sun_hours(), shadows() and sky_view()
SunRaster sun_raster(const dem::Posts& posts, const SunRasterWanted& wanted,
                     const dem::Window& part = {}, const std::function<void(double)>& done = {});

/// Writes the file of `relevo sun hours`, `sun shadow` or `sun sky-view`, byte for byte.
/// @param whole    of all posts, where it has been made already; else it is made part by part
/// @param most     posts of a part
/// @param version  of the program
/// @param done     told which share has been done since it was told last; what it throws ends it
/// @throws Error as sun_raster() and output::RasterWriter
void write_sun_raster(OutputFile& file, const dem::Posts& posts, const SunRasterWanted& wanted,
                      const SunRaster* whole, std::int64_t most, const std::string& version,
                      const std::function<void(double)>& done = {});

}  // namespace relevo::session

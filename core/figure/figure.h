#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/array2d.h"
#include "dem/posts.h"
#include "figure/options.h"
#include "light/raster/beyond.h"
#include "output/raster_writer.h"

/// Figures of light for every post of a DEM, identical from the command line, the libraries and the
/// window.
namespace relevo::figure {

/// What came of a part of a raster.
struct PartMade {
    std::int64_t holes = 0;
    std::string definition;  ///< a sentence, for the file's metadata
};

/// Takes the values of a part in a band, by its number.
using Put = std::function<void(std::size_t band, const dem::Window& part, Array2d<float> values)>;

/// What a figure is made from, and where its values go.
struct Work {
    /// All of a DEM, or a tile with its halo. Outlive the maker.
    const dem::Posts& posts;
    dem::Window window{};    ///< posts of which parts will be asked for
    geo::Geodetic middle{};  ///< of the whole DEM
    Put put;
    /// Told of each share of a call that is done; an exception from it ends the work.
    std::function<void(double)> done{};
    bool is_estimate = false;  ///< only to measure the time: values may be meaningless
};

using PartMaker = std::function<PartMade(const dem::Window& part)>;

/// A figure with its options: a verb of `relevo sun` that writes a raster.
class Figure {
  public:
    double terrestrial_refraction = kTerrestrialRefraction.value;
    std::optional<double> highest_m;  ///< of terrain beyond the DEM, as light::terrain_beyond()

    Figure() = default;
    virtual ~Figure() = default;
    Figure(const Figure&) = delete;
    Figure& operator=(const Figure&) = delete;

    /// Bytes are masks: 0 in the shade, 1 lit, 255 without data.
    virtual output::RasterType type() const { return output::RasterType::Float; }
    /// Names and units. Band k of Work::put is the k-th.
    virtual std::vector<output::RasterBand> bands() const = 0;
    /// What a file says of its options. @param posts  of the whole DEM, here and below
    virtual output::RasterMetadata metadata(const dem::Posts& posts) const = 0;
    /// A part of a sentence, of heights that are true.
    virtual const char* accuracy() const = 0;
    /// Calls of core's functions that each part takes, as Work::done counts them.
    virtual std::size_t calls() const { return 1; }
    /// Of memory while computing, besides the DEM's heights (measured).
    virtual int bytes_a_post() const = 0;
    /// How far off ground can change a value [m].
    virtual double halo_m(const dem::Posts& posts) const = 0;
    /// Terrain outside the DEM that could change values of a window.
    virtual std::optional<light::Beyond> beyond(const dem::Posts& posts,
                                                const dem::Window& window) const = 0;
    /// What such terrain would do, as light::Beyond::text() takes it.
    virtual const char* would() const { return light::kHides; }
    /// Plans the work once for all parts.
    /// @throws Error (BadInput) as light::SunPlan and light::SunHoursPlan
    virtual PartMaker maker(Work work) const = 0;
};

}  // namespace relevo::figure

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/memory_budget.h"
#include "base/output_file.h"
#include "figure/figure.h"

/// Makes figures part by part, into arrays or files.
namespace relevo::figure {

/// Splits a window into squares of at most `most_posts` posts and of whole 512-post blocks. Small
/// parts would sweep the same ground repeatedly.
std::vector<dem::Window> raster_parts(const dem::Window& window, std::int64_t most_posts);
/// The parts that memory has room for: all at once if the DEM is in memory.
std::vector<dem::Window> raster_parts(const dem::Posts& posts, const dem::Window& window,
                                      const MemoryBudget& memory);

dem::Window whole_window(const dem::Grid& grid);

/// Makes parts one after the other.
/// @param begin  called before each
/// @returns the sum over all parts
PartMade make_parts(const PartMaker& make, const std::vector<dem::Window>& parts,
                    const std::function<void(const dem::Window& part)>& begin);

/// Makes all of a window, shaded by the whole DEM.
/// @param middle  as Work::middle
/// @param done    called with the fraction completed since its last call; an exception from it ends
///     the work
PartMade make_all(const Figure& figure, const dem::Posts& posts, const geo::Geodetic& middle,
                  const dem::Window& all, const MemoryBudget& memory, Put put,
                  const std::function<void(double)>& done = {});

/// The first band of a whole DEM.
struct Raster {
    Array2d<float> values;
    PartMade made;
};
/// In one part. @param done  as make_all()
Raster raster_of(const Figure& figure, const dem::Posts& posts,
                 const std::function<void(double)>& done = {});

/// What a raster says of itself: of all figures, then of this one.
/// @param version  of Relevo
/// @param made     sums over all parts
/// @param window   of the posts of the whole DEM
output::RasterMetadata metadata_of(const Figure& figure, const dem::Posts& posts,
                                   const std::string& version, const PartMade& made,
                                   const dem::Window& window);

/// A GeoTIFF of a figure.
class RasterFile {
  public:
    /// @param posts    of the whole DEM, outlive this; so does the figure
    /// @param window   of these, that the file has
    /// @param options  as output::RasterWriter
    /// @throws Error as output::RasterWriter, here and below
    RasterFile(OutputFile& file, const Figure& figure, const dem::Posts& posts,
               const dem::Window& window, std::vector<std::string> options = {});

    /// @param column, row  of the file
    void put(std::size_t band, int column, int row, const Array2d<float>& values) {
        writer_.put(band, column, row, values);
    }
    /// @param version  of Relevo
    /// @param made     sums over all parts
    /// @param more     metadata, after those of the figure
    void finish(const std::string& version, const PartMade& made,
                const output::RasterMetadata& more);

  private:
    const Figure& figure_;
    const dem::Posts& posts_;
    dem::Window window_;
    output::RasterWriter writer_;
};

/// Writes the raster of a whole DEM.
/// @param whole  its only band if already computed; null: it is computed in parts
/// @param done   as make_all()
void write_raster(OutputFile& file, const Figure& figure, const dem::Posts& posts,
                  const MemoryBudget& memory, const std::string& version,
                  const Raster* whole = nullptr, const std::function<void(double)>& done = {});

}  // namespace relevo::figure

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.h"
#include "dem/encoding.h"
#include "dem/heightfield.h"
#include "dem/opened_files.h"
#include "dem/placement.h"

namespace relevo::dem {

/// What a user may say about a raster; each replaces what the file says. (Every member has an
/// initializer so that `{.band = 2}` is a whole one.)
struct LoadOptions {
    std::string crs = {};   ///< `--crs`: as geo::Crs::parse takes it; empty: the file's
    int band = 0;           ///< `--band`, from 1; 0: the first
    std::string unit = {};  ///< `--unit`; empty: the file's, else metres as an assumption
    std::optional<double> nodata = {};  ///< `--nodata`: the stored value that marks a hole
    /// `--nodata none`: no value marks a hole, whatever the file says. NaN, infinities and masks
    /// still do.
    bool no_nodata = false;
    Encoding encoding = Encoding::None;  ///< `--encoding`: heights in the colours of a picture
    std::optional<Bounds> bounds = {};   ///< `--bounds`: instead of the file's georeference
    /// `--crop W,S,E,N` in degrees: only the posts in there; empty: all.
    std::string crop = {};
    /// `--memory`. load() averages a raster with more posts down by a power of two, and the
    /// description says by which.
    MemoryBudget memory = MemoryBudget::of_mib(MemoryBudget::kDefault_mib);
    /// `--surroundings`: wider and coarser DEMs in which this one lies, as their files say they
    /// are. Posts::load() alone reads them (surroundings.h).
    std::vector<std::string> surroundings = {};
    /// Averaged levels of large DEMs are kept in the user's cache (LevelCache). Never so for
    /// libraries, which write no files unasked.
    bool cached = false;

    bool operator==(const LoadOptions&) const = default;
};

/// A DEM that is open: what it is, and its heights on demand. Errors begin with `dem::load`.
///
/// Several files are one DEM. Its grid is that of the finest of them, over all; files on that grid
/// are read as they are, all others are resampled to it (bilinear) as they are read. Where files
/// overlap, the one named last is on top, as in gdalbuildvrt; its holes show what is below. Each
/// file keeps its own nodata value, unit, scale and mask.
///
/// An index (tile_index.h) stands for its tiles. One of them is opened with it; the others are
/// opened when heights of theirs are first read. Tiles that are missing or broken are voids, which
/// tiles() says.
class Source {
  public:
    /// Opens a raster of any dialect (docs/dem-formats.md) and settles what its numbers mean. Reads
    /// no heights but, where no nodata value is declared, a sample to see whether one is used;
    /// what was found there holds for every later read. Guesses are said with log::info.
    /// @param path  a file, a folder that is one raster (Esri grids), a folder of rasters, an
    ///              archive of one, an index of tiles, or another name that GDAL opens
    ///              ("/vsizip/alps.zip/alps.tif", "NETCDF:a.nc:topo")
    /// @throws Error (BadInput) `PATH: what, expected E but got G; remedy`
    static Source open(const std::string& path, const LoadOptions& options = {});

    /// The same for one file or more.
    /// @throws Error (BadInput) also where there are none, or where they cannot be joined
    static Source open(std::span<const std::string> paths, const LoadOptions& options = {});

    Source(Source&&) noexcept;
    Source& operator=(Source&&) noexcept;
    ~Source();

    /// From now on all heights are so much higher, but for stored().
    /// @param how  Description::joined
    void raise(double shift_m, const std::string& how);

    const Grid& grid() const;                ///< of all posts
    const Description& description() const;  ///< all but the statistics
    const OpenedFiles& opened_files() const;

    /// Heights in metres of a window, NaN for holes.
    ///
    /// With `columns` and `rows` those of the window, every post as stored. With fewer, means over
    /// equal parts of the window, each stored post counting by the area of its cell inside; a part
    /// of which less than half is valid is a hole. Means start from each file's coarsest overview
    /// that is still fine enough, where it has any (overviews made without knowledge of the holes,
    /// or of encoded colours, are left alone). Where the posts of the result are:
    /// grid().part(window, columns, rows). Rows of compressed GeoTIFFs are read on several threads.
    ///
    /// @param window  inside of the grid; at least as many columns and rows as are asked for
    /// @throws Error (BadInput) where the file is damaged or cut short: never a part of the heights
    /// Safe on several threads at once.
    Array2d<float> read(const Window& window, int columns, int rows) const;

    /// All posts, as stored.
    Array2d<float> read() const;

    /// Cells that the files are read for where all posts are read as means of `side` x `side`: of
    /// overviews, where there are any that are fine enough.
    double cells_for_means(int side) const;

    /// The number that a file stores for a post, as --nodata takes it: before scale, offset and
    /// unit; of encoded colours the height [m]. Of several files, that of the one on top that has a
    /// height there, else of the one on top; NaN where there is none.
    double stored(int column, int row) const;

    /// Rows at the top of a window that need not be read, because no file stores or covers them.
    struct Blank {
        int rows = 0;        ///< 0: the first one has to be read
        float height_m = 0;  ///< of each post there, NaN for holes
    };
    Blank blank(const Window& window) const;

    /// Which tiles of indexes are missing, broken or unlike the others. Only tiles of which heights
    /// have been read are in it.
    TileReport tiles() const;
    /// How many of them have broken while they were read.
    std::int64_t broken_while_read() const;
    /// From now on no more tiles than these may be missing or broken; one that is more is an error
    /// (BadInput) of what reads it, because what is known of the DEM would be wrong.
    void allow_voids(std::int64_t tiles) const;

    /// Rows that are read best at once, those of the files' blocks; of many files, of a file.
    int block_rows() const;

    /// Whether opening all of its files takes seconds: there are more than 400.
    bool opens_slowly() const;

    /// Columns and rows of the file's blocks; 64 x 64 for several files, since few such blocks lie
    /// in two files.
    glm::ivec2 block_size() const;

    /// The height at a place, as Heightfield::height_at() has it: four posts are read.
    double height_at(const geo::Geodetic& place) const;

  private:
    struct Impl;
    explicit Source(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::dem

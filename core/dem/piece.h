#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem/interpret.h"
#include "dem/sparse.h"

// One raster of a DEM. Inside of the layer only.

namespace relevo::dem {

/// The height of a post without one.
inline constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// How stored numbers become metres.
struct BandScale {
    std::optional<double> nodata;
    double beyond = 0;    // numbers further from zero are no heights; infinite: all are
    double scale = 1;     // metres in one step of the stored number
    double offset_m = 0;  // height of the stored number 0
};

/// One of a file's resolutions.
struct Resolution {
    int overview = -1;  ///< -1: the raster itself
    int columns = 0;
    int rows = 0;
};

/// How a raster is read on the DEM's grid (resample.h).
struct Resampling {
    Grid grid;         ///< the DEM's posts in Piece::place
    glm::dvec2 reach;  ///< of the tent, in posts of the raster
    /// To add to the DEM's longitudes where both have one CRS, whole turns; none: they have not.
    std::optional<double> shift;
};

/// One raster: where it is, what its numbers mean, and how they are read.
struct Piece {
    AllowedName path;       ///< by which GDAL opens it
    std::size_t files = 1;  ///< of the DEM
    Grid grid;              ///< its own
    Window place;           ///< its posts among those of the DEM, after resampling
    std::optional<Resampling> resampling;

    BandScale band_scale;
    Encoding encoding = Encoding::None;
    bool has_mask = false;     ///< a mask or an alpha band says where the holes are
    int alpha_band = 0;        ///< GDAL makes no mask of it, which it does of 8 and 16 bits alone
    bool wide = false;         ///< stored numbers need doubles
    bool threads_pay = false;  ///< the driver decodes blocks one by one, whichever handle asks
    bool knows_holes = true;   ///< overviews were made by who knew which numbers are heights
    int block_columns = 1;
    int block_rows = 1;
    std::vector<Resolution> levels;   ///< the raster itself, then its overviews
    std::optional<SparseMap> sparse;  ///< what of it the file does not store
    float unstored_m = 0;             ///< the height there, NaN for holes
    Description about;

    /// A handle of one's own. @throws Error (BadInput)
    Dataset open() const;

    /// Heights in metres of a window of a level, in its own posts, NaN for holes; row after row.
    /// @throws Error (BadInput) where they cannot all be read
    void read(void* dataset, const Resolution& level, const Window& window, float* height_m) const;

    /// The number that the file stores for a post, or would store for its height where that is
    /// made of several.
    /// @throws Error (BadInput) where it cannot be read
    double stored(void* dataset, int column, int row, float height_m) const;
};

/// Opens one file and settles what it means.
/// @param options  of all files
/// @param files    how many there are: of many, each is looked at less closely
/// @param opened   becomes the handle that was used for it, as by Piece::open()
Piece open_piece(const AllowedName& name, const LoadOptions& options, std::size_t files,
                 Dataset& opened);

}  // namespace relevo::dem

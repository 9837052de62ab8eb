#pragma once

#include <cstdint>
#include <optional>

#include "base/array2d.h"
#include "dem/grid.h"

// Which parts of a raster its file holds at all. Inside of the layer only.

namespace relevo::dem {

/// Parts of a raster that its file does not store: what is read there is one number, and nobody
/// needs to read it.
class SparseMap {
  public:
    /// Asks GDAL, where that can pay: for rasters of more than 2^28 posts whose files are small for
    /// that, in formats that know (GeoTIFF, virtual rasters of few sources).
    /// @param band, mask, alpha  GDAL's; the latter may be null
    /// @param file_bytes         of all files behind it
    static std::optional<SparseMap> of(void* dataset, void* band, void* mask, void* alpha,
                                       std::uint64_t file_bytes);

    /// Whether nothing of a window is stored.
    bool is_empty(const Window& window) const;

    /// The first rows of a window of which nothing is stored, by whole rows of the map; 0: the
    /// first is not such a one.
    int empty_rows(const Window& window) const;

    /// Share of the raster that is stored, 0 to 1.
    double stored_share() const;

    /// Some post that is not stored, column and row; nothing where all are.
    std::optional<glm::ivec2> empty_post() const;

  private:
    SparseMap(int columns, int rows);
    int first_post(int cell, int cells, int posts) const;
    int cell_of(int post, int cells, int posts) const;

    int columns_;
    int rows_;
    Array2d<std::uint8_t> stored_;
};

}  // namespace relevo::dem

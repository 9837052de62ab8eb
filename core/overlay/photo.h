#pragma once

#include <bitset>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "dem/grid.h"
#include "dem/places_over.h"

namespace relevo::overlay {

/// What a raster holds as an image of the ground.
enum class PhotoKind {
    None,     ///< no image: figures
    Colours,  ///< three or four bands of bytes: red, green, blue, alpha
    Palette,  ///< a band of bytes with a colour table
    Deep,     ///< red, green and blue of more than 8 bits, which have no range on a screen
};

/// @throws Error (BadInput) as Source::open()
PhotoKind photo_kind(const std::string& path);

/// The classes in the first band of a raster: those of 512 x 512 pixels at most, spread all over
/// it. Pixels without data do not count.
/// @throws Error (BadInput) if the band has no bytes, else as Source::open()
std::bitset<256> classes_of(const std::string& path);

/// An image of the ground in a file, in any CRS, read where it is needed.
///
/// Pixels are transparent where the mask or alpha says so, or where all bands are nodata. Memory
/// does not depend on the file's size: one part is read at a time, from overviews where the file
/// has them. Of a large file without overviews, a reduced copy of 64 MiB at most is kept.
class Photo {
  public:
    /// @param dem   what it is laid over; kept as a copy
    /// @throws Error (BadInput) if the file is not an image of 8 bits, has no georeference, or does
    ///     not reach the DEM
    static std::shared_ptr<const Photo> open(const std::string& path, const dem::Grid& dem);
    /// A raster of classes as an image: its first band, by a table.
    /// @param palette  0xAABBGGRR, premultiplied, by class from 0; classes beyond it are
    ///     transparent
    /// @throws Error (BadInput) if the band has no bytes, else as open()
    static std::shared_ptr<const Photo> open_classes(const std::string& path, const dem::Grid& dem,
                                                     std::vector<std::uint32_t> palette);
    ~Photo();
    Photo(const Photo&) = delete;
    Photo& operator=(const Photo&) = delete;

    /// Posts between which it lies on the DEM: a box, slightly too large.
    glm::dvec2 first_post() const;
    glm::dvec2 last_post() const;
    /// Its pixels per post, along columns and rows of the DEM, where they are densest.
    glm::dvec2 pixels_per_post() const;

    /// Colours at points of the DEM: 0xAABBGGRR, sRGB, premultiplied by alpha. Linear between
    /// pixels; means of pixels where points are wider apart. 0 outside of the image.
    ///
    /// Accuracy: the place is that of PlacesOver. Safe on several threads at once.
    /// @throws Error (BadInput) for a damaged file
    Array2d<std::uint32_t> read(const dem::PointsOver& points) const;

  private:
    struct Impl;
    explicit Photo(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace relevo::overlay

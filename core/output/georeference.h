#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/output_file.h"

/// How picture files say where on the Earth they lie, so that GIS programs read it.
namespace relevo::output {

struct Georeference {
    /// As GDAL has it: from columns and rows of the picture, (0, 0) the upper left corner of its
    /// first pixel, to x and y of the CRS.
    std::array<double, 6> geotransform{0, 1, 0, 0, 0, -1};
    std::string crs;  ///< as geo::Crs::text()
};

/// Whether a picture's format has it inside the file: GeoTIFF.
bool holds_georeference(const std::filesystem::path& picture);

/// The files beside a picture that have it: a world file, named by the first and the last letter of
/// the picture's ending and w (map.png: map.pgw), and GDAL's map.png.aux.xml, which has the CRS
/// too. None for a GeoTIFF.
std::vector<std::filesystem::path> georeference_files(const std::filesystem::path& picture);

/// Their texts, in the same order.
/// @throws Error (Failed) for a CRS that GDAL does not know
std::vector<std::string> georeference_texts(const Georeference& where);

/// Writes a TIFF as a GeoTIFF, all of it but finish().
/// @param tiff  the whole file
/// @throws Error (Failed) where GDAL or the disk refuses
void write_geotiff(OutputFile& file, std::span<const std::byte> tiff, const Georeference& where);

}  // namespace relevo::output

#pragma once

#include <cstdint>
#include <string>

#include "base/allowed_name.h"

// What a file from others must not make GDAL do. Inside of the layer only.

namespace relevo::dem {

/// Takes from GDAL, for the whole process, what a raster of lies could use: reading the program's
/// memory (MEM), running Python (pixel functions), running SQL (a GeoPackage's prelude), and the
/// net. What names a file of this machine is left. prepare_gdal() calls it once.
void disarm_gdal();

/// Gives the net back, for a name that a person has given. Safe on several threads at once.
void allow_remote();
bool is_remote_allowed();

/// The driver that would take a file, had it not been disarmed: "WMS"; empty where there is none.
std::string disarmed_driver_of(const AllowedName& name);

/// Refuses what would block or never end, and says why a file cannot be read where the system
/// knows. Names of GDAL's own ("/vsizip/a.zip/b.tif") are taken to pieces.
/// @throws Error (BadInput)
void refuse_unreadable(const std::string& path);

/// Refuses a virtual raster (VRT) that names, itself or through others that it names, what no file
/// may name, or itself. Other files pass.
/// @returns bytes of it and of all that it names, each as often as it is named
/// @throws Error (BadInput)
std::uint64_t refuse_unsafe_vrt(const AllowedName& name);

}  // namespace relevo::dem

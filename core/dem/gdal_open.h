#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <cpl_vsi.h>

#include "base/allowed_name.h"
#include "dem/gdal_support.h"

// All that core and its front ends open by GDAL is opened here.

namespace relevo::dem {

/// GDALOpenEx. @param flags  GDAL_OF_RASTER and so on
/// @param drivers   a list that ends with null; null: all drivers
/// @param siblings  the files of the folder as GDALOpenEx takes them; null: GDAL looks
/// @returns null where GDAL cannot open it
Dataset open_by_gdal(const AllowedName& name, unsigned flags, const char* const* drivers = nullptr,
                     const char* const* siblings = nullptr);

/// Whether this thread opens a name that may ask the net, for what GDAL opens within.
bool opens_of_the_net();

struct CloseVsiFile {
    void operator()(void* file) const;
};
/// An open VSILFILE*.
using VsiFile = std::unique_ptr<void, CloseVsiFile>;

/// VSIFOpenL for reading. @returns null where there is no such file
VsiFile open_vsi(const AllowedName& name);

/// VSIFOpenL for writing a new file or object; errors are GDAL's last one. @returns a VSILFILE*
VSILFILE* create_by_vsi(const AllowedName& name);

/// Reads up to `most` bytes from the file's beginning; fewer where it ends before.
std::string read_vsi(const AllowedName& name, std::uint64_t most);

/// Size of a file [bytes]; nothing where there is none.
std::optional<std::uint64_t> size_by_vsi(const AllowedName& name);

}  // namespace relevo::dem

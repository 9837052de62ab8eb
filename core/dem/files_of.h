#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/files_in_use.h"

namespace relevo::dem {

/// Every file on this machine that the rasters are read from: themselves, what lies beside them
/// (georeference, overviews, statistics), the sources of virtual rasters, whatever their depth, the
/// archives that hold any of them. Names that cannot be opened give what is there of their name.
/// Opens each raster, and reads no heights. Of an index itself, first, and the tiles that are
/// there, none of which is opened.
/// @param paths  as Source::open() takes them
std::vector<std::filesystem::path> files_of(std::span<const std::string> paths);

/// The same for rasters; nullopt if heights are also read from what is no file of this machine.
std::optional<std::vector<std::filesystem::path>> local_files_of(
    std::span<const std::string> rasters);

/// Adds the rasters that are named to what a run reads. @throws Error as FilesInUse::add_input
void add_named(std::span<const std::string> paths, FilesInUse& files,
               std::string_view what = "the DEM");

/// Adds files_of() too, where an output replaces a file: finding them takes time.
/// @param what  as FilesInUse::add_input
/// @throws Error as FilesInUse::add_input
void add_all(std::span<const std::string> paths, FilesInUse& files,
             std::string_view what = "the DEM");

}  // namespace relevo::dem

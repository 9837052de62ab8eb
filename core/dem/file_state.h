#pragma once

#include <optional>
#include <span>
#include <string>

#include "dem/opened_files.h"
#include "dem/source.h"

namespace relevo::dem {

/// The options that change heights or where they are, in lines.
std::string text_of(const LoadOptions& options);

/// Names, sizes and times of the last change of all files that rasters are read from, in lines:
/// it differs once one of them has changed. nullopt if that cannot be seen, such as for files of
/// the net, heights in memory, virtual rasters among more than 16 rasters or in an index, and an
/// index that is not alone.
/// @param paths  as Source::open() takes them
/// @param since  nullopt also if a file may have changed since then; null: that does not matter
std::optional<std::string> state_of_files(std::span<const std::string> paths,
                                          const OpenedFiles* since = nullptr);

}  // namespace relevo::dem

#pragma once

#include <filesystem>
#include <memory>

#include "sky/atmosphere.h"

namespace relevo::sky {

/// Tables of an atmosphere as a file: floats as they are in memory, in little-endian order.
void write_atmosphere(const std::filesystem::path& path, const Atmosphere& air);
/// @throws Error (BadInput) for a file that is none of these, or of another layout
Atmosphere read_atmosphere(const std::filesystem::path& path, const Air& air);

/// The atmosphere of an air: read from the program's data for the default one (0.3 ms), else
/// computed (2.2 s on two processors). Keeps the default one and the last four others. May be
/// called from several threads, which compute different airs concurrently.
std::shared_ptr<const Atmosphere> atmosphere_of(const Air& air);

}  // namespace relevo::sky

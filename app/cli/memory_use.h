#pragma once

#include <optional>
#include <string>

namespace relevo::cli {

/// The most memory that this process has had so far [MiB], shared libraries included.
double peak_memory_mib();

/// The memory of the program itself, which is not part of `--memory` [MiB]: the peak of another
/// process, which draws a DEM of 2 x 2 posts, 1280 x 1024 pixels, on a device. Takes about a
/// second; nullopt if that fails.
std::optional<double> memory_floor_mib(const std::string& device);

}  // namespace relevo::cli

#pragma once

#include <cstddef>
#include <string>

#include "base/allocation.h"

namespace relevo::cli {

/// A part of the work, where several programs share it.
struct Shard {
    std::size_t number = 1;  ///< from 1
    std::size_t count = 1;
};

/// Reads `2/4`; `array`, which takes both from the variables that Slurm, LSF, Grid Engine and AWS
/// Batch set for the tasks of an array; or `array/4`, for PBS, which does not say how many there
/// are: its tasks count from 1.
/// @throws Error (Usage) `--shard: text: what`
Shard parse_shard(const std::string& text, const Environment& environment);

}  // namespace relevo::cli

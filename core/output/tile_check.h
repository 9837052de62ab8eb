#pragma once

#include <filesystem>
#include <string>

#include "output/tile_plan.h"

namespace relevo::output {

/// A planned tile as a folder has it.
struct TileOnDisk {
    enum class State {
        Missing,
        Damaged,  ///< not readable, or cut short
        Other,    ///< of another command, another DEM or another grid
        Whole,
    };
    State state = State::Missing;
    std::string why;  ///< for people: "is of sun sky-view"; empty of those that are whole
};

/// Opens a tile, compares its grid and its command with those of the plan, and reads the last
/// blocks of each band, which a file that is cut short has lost.
TileOnDisk tile_on_disk(const std::filesystem::path& folder, const TilePlan& plan,
                        const PlannedTile& tile);

/// All of a plan, on several threads.
std::vector<TileOnDisk> tiles_on_disk(const std::filesystem::path& folder, const TilePlan& plan,
                                      const std::vector<PlannedTile>& tiles);

}  // namespace relevo::output

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "figure/far_ground.h"
#include "output/raster_writer.h"
#include "output/tile_plan.h"

/// Rasters as tiles in a folder: which there are, and which a run makes.
namespace relevo::figure {

/// Tiles in which rasters are made.
struct TileOptions {
    std::string tiles;                  ///< posts a side, or an index; empty: none
    std::string crs;                    ///< of an index, as `--crs` takes it; empty: its own
    std::optional<double> halo_km;      ///< means beyond
    std::size_t shard = 1, shards = 1;  ///< this one of so many
    bool resume = false;

    bool given() const { return !tiles.empty(); }
    /// The tiles of a window.
    /// @throws Error (Usage) for a number that no tile has, (BadInput) as output::tiles_of() and
    ///     output::tiles_of_index()
    std::vector<output::PlannedTile> of(const dem::Grid& grid, const dem::Window& window) const;
    /// What the tiles are, for people: "of 512 x 512 posts".
    std::string description() const;
};

/// The plan of a folder, if it has one. With --overwrite a file of another kind is none.
/// @throws Error (BadInput) as output::read_plan()
std::optional<output::TilePlan> plan_of(const std::filesystem::path& folder, bool overwrite);

/// Refuses a folder in which a plan would replace files that are not of a plan.
/// @throws Error (BadInput) naming the first
void check_plan_files(const std::filesystem::path& folder);

/// The folder of a run's tiles.
class TileFolder {
  public:
    /// Reads the folder's plan, or takes this one, and looks for tiles that are there already.
    /// @param plan      of this run, its digest of the meaning alone; gets that of the DEM, too
    /// @param is_plan   tiles are counted and not made, those that are there stay
    /// @throws Error (BadInput) where the folder has a plan or tiles of something else, and tiles
    ///     without `resume` or `overwrite`
    TileFolder(std::filesystem::path folder, output::TilePlan plan, const TileOptions& options,
               bool overwrite, bool is_plan);

    /// Writes the plan unless the folder has it.
    /// @param posts  of the DEM
    /// @param far    of it; null: all ground is posts
    void write_plan(const dem::Posts& posts, const FarGround* far) const;
    /// Opens the file of a tile.
    OutputFile open(const output::PlannedTile& tile, FilesInUse& files) const;

    /// Whether a tile is there and whole by now, made by another process.
    bool is_whole(const output::PlannedTile& tile) const;

    const output::TilePlan& plan() const { return plan_; }
    /// That are to be made, of this shard.
    const std::vector<output::PlannedTile>& todo() const { return todo_; }
    /// Of this shard, that are there and stay.
    std::size_t there() const { return there_; }

  private:
    void check_plan(const std::optional<output::TilePlan>& found) const;
    void take(const std::vector<output::PlannedTile>& wanted, bool keep, bool is_plan);

    std::filesystem::path folder_;
    output::TilePlan plan_;
    bool overwrite_, has_plan_ = false;
    std::vector<output::PlannedTile> todo_;
    std::vector<std::string> replaced_;  ///< names of tiles that are damaged
    std::vector<std::string> outdated_;  ///< names of tiles that a plan replaces
    std::size_t there_ = 0;
};

}  // namespace relevo::figure

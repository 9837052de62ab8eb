#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dem/posts.h"

/// Rasters that are made as tiles in a folder, by one process or by many.
namespace relevo::output {

struct PlannedTile {
    std::string name;    ///< its file, without a folder: "r0001_c0002.tif"
    dem::Window window;  ///< of the DEM's grid

    friend bool operator==(const PlannedTile&, const PlannedTile&) = default;
};

/// Tiles of a window on the DEM's own grid: squares of `side` posts from the DEM's first post on,
/// row by row, those at the window's edges cut off. Names count rows and columns of tiles of the
/// whole DEM from 1.
/// @throws Error (BadInput) for more than ten million tiles
std::vector<PlannedTile> tiles_of(const dem::Grid& grid, const dem::Window& window, int side);

/// Tiles of an index: the posts of a window that lie in the outline of each, under its name. Those
/// outside of the window are not there. Of tiles with the same posts, as of districts that share
/// them, only the first is made; how many are not is said.
/// @param path, crs  an OGR tile index or STAC Items, as dem::read_tile_index() takes them
/// @throws Error (BadInput) as dem::read_tile_index(), and where no tile has a post of the window
std::vector<PlannedTile> tiles_of_index(const dem::Grid& grid, const dem::Window& window,
                                        const std::string& path, const std::string& crs = {});

/// The I-th of N contiguous shares of a list, whose sizes differ by one at most.
/// @param number  from 1
/// @return the first one and the one after the last
std::pair<std::size_t, std::size_t> share_of(std::size_t count, std::size_t number,
                                             std::size_t shares);

/// What the tiles of a folder are: of which DEM, of which command. All processes that fill the
/// folder read it there, so that it also says what need not be found again: FOLDER/plan.json and,
/// of a DEM beyond memory, FOLDER/plan.tif.
struct TilePlan {
    std::string command;            ///< for people: "sun hours --date=2026-06-21"
    std::string digest;             ///< of what figures depend on; TilePlan::digest_of()
    std::vector<std::string> dems;  ///< as they were given
    dem::Grid grid;                 ///< of the DEM
    dem::Statistics statistics;     ///< of its posts
    std::uint64_t content = 0;      ///< dem::Posts::content()
    dem::TileReport dem_tiles;      ///< of an index: which of its tiles are missing or broken
    std::string stamp;              ///< stamp_of() of the DEM's files
    std::vector<PlannedTile> tiles;
};

/// Sizes and times of files, as a hash; of other names, the names alone.
std::string stamp_of(const std::vector<std::string>& files);

inline constexpr const char *kPlanFile = "plan.json", *kPostsFile = "plan.tif",
                            *kMeansFile = "plan_means.tif";
/// The files that a plan may have in a folder.
std::vector<std::filesystem::path> plan_files(const std::filesystem::path& folder);
/// Those of them that are there, but are not of a plan.
std::vector<std::filesystem::path> foreign_plan_files(const std::filesystem::path& folder);
/// Keys of a tile's metadata.
inline constexpr const char *kCommandKey = "RELEVO_COMMAND", *kDigestKey = "RELEVO_DIGEST";

/// Nothing where the folder has none.
/// @throws Error (BadInput) `plan: FOLDER/plan.json: what` for a file of another kind
std::optional<TilePlan> read_plan(const std::filesystem::path& folder);
/// Replaces the folder's plan. @throws Error as OutputFile
void write_plan(const std::filesystem::path& folder, const TilePlan& plan);

/// Heights that a folder's tasks share. Nothing where there is no such file, or one that is not of
/// a plan. @throws Error (BadInput) where it cannot be read, here and below
std::optional<Array2d<float>> read_heights(const std::filesystem::path& path);
/// Replaces an existing file.
void write_heights(const std::filesystem::path& path, const dem::Grid& grid,
                   const Array2d<float>& height_m, const std::string& definition);

/// What was found of a DEM's posts. Nothing where the folder has none.
/// @throws Error (BadInput) where the file cannot be read
std::optional<dem::PostsFacts> read_posts_facts(const std::filesystem::path& folder,
                                                const TilePlan& plan);
/// @param posts  beyond memory
void write_posts_facts(const std::filesystem::path& folder, const dem::Posts& posts);

}  // namespace relevo::output

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/plan.h"
#include "cli/sun_options.h"
#include "figure/raster_run.h"

/// What the verbs that give a figure for every post of a DEM share.
namespace relevo::cli {

/// DEM..., -o, --overwrite, --co, --clip, --clip-crs, --tiles, --halo, --shard, --resume, and for
/// the figure -k and --highest.
struct RasterArguments {
    DemArguments dem;
    ResultArguments output;
    std::vector<std::string> creation_options;
    std::string clip, clip_crs;
    bool dry_run = false;
    figure::TileOptions tiles;  ///< but for the shard
    std::string shard;
    PlanArguments plan;  ///< of a verb of `plan`
    std::optional<Verb> verb;

    /// @param figure  lives until the command line has been read
    void add_to(Verb verb_of_rasters, figure::Figure& figure);
    /// Opens the result, before any work is done; of tiles, each is opened later: null.
    /// @throws Error as open_result(), (Usage) for creation options that there are not
    OutputFile* open(FilesInUse& files) const;
    /// @throws Error (Usage, BadInput) as dem::load, dem::parse_clip and dem::window_of
    figure::RasterGround load() const;
    /// Makes the rasters, or says what they take: with --dry-run, and for `relevo plan`.
    /// @param file, ground  as of these
    /// @returns whether files were made
    bool make(OutputFile* file, FilesInUse& files, const figure::RasterGround& ground,
              const figure::Figure& figure) const;
    /// Whether the command line has an option of the verb.
    bool has(const char* option) const { return verb->option(option).count() > 0; }
};

}  // namespace relevo::cli

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cli/far_ground.h"
#include "cli/plan.h"
#include "cli/raster_estimate.h"
#include "cli/sun_options.h"
#include "cli/tile_folder.h"
#include "dem/clip.h"
#include "figure/run.h"

/// What the verbs that give a figure for every post of a DEM share.
namespace relevo::cli {

/// A DEM, and what of it rasters are made of.
struct RasterGround {
    dem::Posts posts;
    dem::Window window;          ///< that is asked for
    dem::LoadOptions options{};  ///< with which it was read
    bool is_planned = false;     ///< the folder's plan is of this DEM as it is
    std::string stamp{};         ///< of tiles: output::stamp_of() all files of the DEM
};

/// DEM..., -o, --overwrite, --co, --clip, --clip-crs, --tiles, --halo, --shard, --resume, and for
/// the figure -k and --highest.
struct RasterArguments {
    DemArguments dem;
    OutputArguments output;
    std::vector<std::string> creation_options;
    std::string clip, clip_crs;
    bool dry_run = false;
    TileArguments tiles;
    PlanArguments plan;  ///< of a verb of `plan`
    std::optional<Verb> verb;

    /// @param figure  lives until the command line has been read
    void add_to(Verb verb_of_rasters, figure::Figure& figure);
    /// Opens the result, before any work is done; of tiles, each is opened later: null.
    /// @throws Error as OutputArguments::open, (Usage) for creation options that there are not
    OutputFile* open(FilesInUse& files) const;
    /// @throws Error (Usage, BadInput) as dem::load, dem::parse_clip and dem::window_of
    RasterGround load() const;
    /// Whether the command line has an option of the verb.
    bool has(const char* option) const { return verb->option(option).count() > 0; }
};

/// Rasters being made, part by part, with a bar on a terminal: one, or the tiles of a folder. With
/// --dry-run so much of them is computed as tells how long they take, and nothing is written; the
/// same for `relevo plan`.
class RasterRun {
  public:
    /// @param file   as RasterArguments::open() gave it
    /// @param files  of this run
    /// @param figure  outlives this
    /// @throws Error as TileFolder
    RasterRun(const RasterArguments& arguments, OutputFile* file, FilesInUse& files,
              const RasterGround& ground, const figure::Figure& figure);

    /// Makes one part after the other. Files get their names once they are whole. Warns of terrain
    /// beyond the DEM that could change values, but a dry run does not.
    /// @return whether files were made: not if all are there already, nor by a dry run, which says
    ///     what it has found out
    bool make_all();

  private:
    bool is_done() const { return window_.is_empty(); }
    /// @param posts, around, window  as figure::Work
    figure::PartMaker maker_of(const dem::Posts& posts, const dem::Posts* around,
                               const dem::Window& window);
    void count(double of_call);
    /// Creation options of the result: as many threads as memory allows, and what the user says.
    std::vector<std::string> options_of_file() const;
    void choose_tiles();
    void make(const output::PlannedTile& tile, const dem::Window& raster,
              const figure::PartMaker& make_part, const dem::Posts& posts);
    std::vector<dem::Window> parts_of(const dem::Window& raster) const;
    void make_far(const output::PlannedTile& tile);
    void look_beyond(const dem::Window& raster, output::RasterMetadata& metadata);
    bool is_dry() const { return arguments_.dry_run || arguments_.plan.on; }
    void say_what_was_made() const;
    RasterEstimate estimate() const;
    void tell_plan(const RasterEstimate& estimate) const;
    bool has_been_made(const output::PlannedTile& tile) const;
    std::int64_t inner_voids_of(const dem::Window& raster, const dem::Posts& posts,
                                const dem::Window& of_posts) const;

    const RasterArguments& arguments_;
    const RasterGround& ground_;
    FilesInUse& files_;
    OutputFile* file_;
    const figure::Figure& figure_;
    std::vector<output::RasterBand> bands_;
    output::RasterMetadata far_metadata_;
    double halo_m_ = 0;
    std::optional<FarGround> far_;
    std::optional<TileFolder> folder_;
    std::vector<output::PlannedTile> todo_;
    dem::Window window_;
    double posts_ = 0;    ///< of all that is to be made
    dem::Window raster_;  ///< that is being made, of the posts that it is made from
    bool warned_ = false;
    std::int64_t inner_voids_ = 0;
    std::optional<figure::RasterFile> writer_;
    std::optional<ProgressBar> bar_;
    double share_ = 0, part_share_ = 0;
    SampledTime sampled_;
    double passed_s_ = 0, ready_s_ = 0;  ///< until now, and until the work proper began
    double sites_s_ = 0;                 ///< of these, to make tiles with their halos ready
    std::size_t sites_ = 0;
    Progress::Clock::time_point began_ = Progress::Clock::now();
};

}  // namespace relevo::cli

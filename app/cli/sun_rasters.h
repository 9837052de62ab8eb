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
#include "light/raster/beyond.h"
#include "output/raster_writer.h"

/// What the verbs that give a figure for every post of a DEM share.
namespace relevo::cli {

/// A DEM, and what of it rasters are made of.
struct RasterGround {
    dem::Posts posts;
    dem::Window window;           ///< that is asked for
    std::int64_t part_posts = 0;  ///< that are computed at once; 0: all of a raster
    dem::LoadOptions options{};   ///< with which it was read
    bool is_planned = false;      ///< the folder's plan is of this DEM as it is
    std::string stamp{};          ///< of tiles: output::stamp_of() all files of the DEM

    dem::Window whole() const { return {0, 0, posts.grid().columns(), posts.grid().rows()}; }
    dem::Grid grid_of(const dem::Window& raster) const;
    /// Of a raster, one after the other.
    std::vector<dem::Window> parts_of(const dem::Window& raster) const;
};

/// What a verb makes.
struct RasterWanted {
    output::RasterType type = output::RasterType::Float;
    std::vector<output::RasterBand> bands;
    output::RasterMetadata metadata;  ///< besides what every such file says of itself
    std::size_t calls = 1;            ///< of core's functions that each part takes
    int bytes_a_post = 0;  ///< of memory while computing, besides the DEM's heights (measured)
    double halo_m = 0;     ///< how far off ground can change a figure
};

/// What came of a part of a raster.
struct PartFigures {
    std::int64_t holes = 0;
    std::string definition;
};

/// Makes a part of a raster: a window of the posts that it is made from.
using PartMaker = std::function<PartFigures(const dem::Window& part)>;
/// What a verb has core find before any part is made.
/// @param posts   whose parts are made: all of a DEM, or a tile with its halo. Outlive the result
/// @param around  a wider and coarser DEM, as light::SunPlan takes it; may be null
/// @param window  posts of which parts will be asked for
using MakerOf = std::function<PartMaker(const dem::Posts& posts, const dem::Posts* around,
                                        const dem::Window& window)>;

/// DEM..., -k, -o, --overwrite, --co, --clip, --clip-crs, --highest, --tiles, --halo, --shard,
/// --resume.
struct RasterArguments {
    DemArguments dem;
    double terrestrial_refraction = 0.13;
    OutputArguments output;
    std::vector<std::string> creation_options;
    std::string clip, clip_crs;
    std::optional<double> highest_m;  ///< of terrain beyond the DEM
    bool dry_run = false;
    TileArguments tiles;
    PlanArguments plan;  ///< of a verb of `plan`
    std::optional<Verb> verb;

    void add_to(Verb verb_of_rasters);
    /// Opens the result, before any work is done; of tiles, each is opened later: null.
    /// @throws Error as OutputArguments::open, (Usage) for creation options that there are not
    OutputFile* open(FilesInUse& files) const;
    /// @throws Error (Usage, BadInput) as dem::load, dem::parse_clip and dem::window_of
    RasterGround load() const;
    /// What every such file says of itself; `more` besides.
    output::RasterMetadata about(const RasterGround& ground, const dem::Window& raster,
                                 const PartFigures& figures,
                                 const output::RasterMetadata& more) const;
};

/// Rasters being made, part by part, with a bar on a terminal: one, or the tiles of a folder. With
/// --dry-run so much of them is computed as tells how long they take, and nothing is written; the
/// same for `relevo plan`.
class RasterRun {
  public:
    /// @param file   as RasterArguments::open() gave it
    /// @param files  of this run
    /// @throws Error as TileFolder
    RasterRun(const RasterArguments& arguments, OutputFile* file, FilesInUse& files,
              const RasterGround& ground, RasterWanted wanted);

    /// Whether all is there already, which has been said then.
    bool is_done() const { return window_.is_empty(); }

    /// Warns of terrain beyond the DEM that could change figures, and writes it into the metadata.
    /// @param look   for it, around a raster; a dry run does not
    /// @param would  as light::Beyond::text()
    void warn_of(std::function<std::optional<light::Beyond>(const dem::Window&)> look,
                 std::string would);
    /// Makes one part after the other. Files get their names once they are whole.
    /// @return whether they have: not those of a dry run, which says what it has found out
    bool make_all(const MakerOf& maker_of);
    /// What the options of core's functions want to be told by.
    std::function<void(double)> done();
    template <typename T>
    void put(std::size_t band, const dem::Window& part, const Array2d<T>& values) {
        if (writer_)
            writer_->put(band, part.column - raster_.column, part.row - raster_.row, values);
    }

  private:
    /// Creation options of the result: as many threads as memory allows, and what the user says.
    std::vector<std::string> options_of_file() const;
    void choose_tiles();
    void make(const output::PlannedTile& tile, const dem::Window& raster,
              const PartMaker& make_part, const dem::Posts& posts);
    std::vector<dem::Window> parts_of(const dem::Window& raster) const;
    void make_far(const output::PlannedTile& tile, const MakerOf& maker_of);
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
    RasterWanted wanted_;
    std::optional<FarGround> far_;
    std::optional<TileFolder> folder_;
    std::vector<output::PlannedTile> todo_;
    dem::Window window_;
    double posts_ = 0;    ///< of all that is to be made
    dem::Window raster_;  ///< that is being made, of the posts that it is made from
    std::function<std::optional<light::Beyond>(const dem::Window&)> look_;
    std::string would_;
    bool warned_ = false;
    std::int64_t inner_voids_ = 0;
    std::optional<output::RasterWriter> writer_;
    std::optional<ProgressBar> bar_;
    double share_ = 0, part_share_ = 0;
    SampledTime sampled_;
    double passed_s_ = 0, ready_s_ = 0;  ///< until now, and until the work proper began
    double sites_s_ = 0;                 ///< of these, to make tiles with their halos ready
    std::size_t sites_ = 0;
    Progress::Clock::time_point began_ = Progress::Clock::now();
};

}  // namespace relevo::cli

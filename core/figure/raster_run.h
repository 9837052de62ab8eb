#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files_in_use.h"
#include "base/progress.h"
#include "figure/estimate.h"
#include "figure/far_ground.h"
#include "figure/run.h"
#include "figure/tile_folder.h"

namespace relevo::figure {

/// A DEM, and what of it rasters are made of.
struct RasterGround {
    dem::Posts posts;
    dem::Window window;              ///< that is asked for
    std::vector<std::string> paths;  ///< from which it was read
    dem::LoadOptions options{};      ///< with which it was read
    bool is_planned = false;         ///< the folder's plan is of this DEM as it is
    std::string stamp{};             ///< of tiles: output::stamp_of() all files of the DEM
};

/// How the rasters of a figure are made.
struct RasterRunOptions {
    enum class Purpose {
        Make,
        Estimate,  ///< of so much as tells how long all takes; writes nothing
        Plan,      ///< the same; also writes the plan of the folder
    };
    Purpose purpose = Purpose::Make;
    std::string version;  ///< of Relevo
    std::string output;   ///< a file, or the folder of tiles
    bool overwrite = false;
    std::vector<std::string> creation_options;  ///< as output::RasterWriter
    TileOptions tiles;
    std::string command;  ///< TilePlan::command
    /// Options that change values, in lines: with metadata and the DEM TilePlan::digest.
    std::string meaning;
    /// Told of each share that is done, instead of a bar; an exception from it ends the work.
    std::function<void(double)> done{};
};

/// Of all files that a DEM is read from, also those that a name stands for, and of how they are
/// read: RasterGround::stamp.
std::string stamp_of_dem(const std::vector<std::string>& paths, const dem::LoadOptions& options);

/// Rasters being made, part by part, with a bar on a terminal: one, or the tiles of a folder.
class RasterRun {
  public:
    /// @param file     of one raster, opened; null for tiles
    /// @param files    of this run
    /// @param options, ground, figure  outlive this
    /// @throws Error as TileFolder
    RasterRun(const RasterRunOptions& options, OutputFile* file, FilesInUse& files,
              const RasterGround& ground, const Figure& figure);

    /// Makes one part after the other. Files get their names once they are whole. Warns of terrain
    /// beyond the DEM that could change values, and of voids.
    void make_all();

    /// Whether there is nothing to make.
    bool is_done() const { return window_.is_empty(); }
    /// After make_all().
    RasterEstimate estimate() const;
    const std::vector<output::PlannedTile>& todo() const { return todo_; }
    /// Null: one raster.
    const TileFolder* folder() const { return folder_ ? &*folder_ : nullptr; }
    /// How far off ground can change a value.
    double halo_m() const { return halo_m_; }

  private:
    /// @param posts, window  as Work
    PartMaker maker_of(const dem::Posts& posts, const dem::Window& window);
    void count(double of_call);
    /// Creation options of the result: as many threads as memory allows, and what the user says.
    std::vector<std::string> options_of_file() const;
    void choose_tiles();
    void make(const output::PlannedTile& tile, const dem::Window& raster,
              const PartMaker& make_part, const dem::Posts& posts);
    std::vector<dem::Window> parts_of(const dem::Window& raster) const;
    void make_far(const output::PlannedTile& tile);
    void look_beyond(const dem::Window& raster, output::RasterMetadata& metadata);
    bool is_dry() const { return options_.purpose != RasterRunOptions::Purpose::Make; }
    void say_what_was_made() const;
    int bytes_a_value() const { return figure_.type() == output::RasterType::Float ? 4 : 1; }
    void estimate_memory(RasterEstimate& found) const;
    bool has_been_made(const output::PlannedTile& tile) const;
    std::int64_t inner_voids_of(const dem::Window& raster, const dem::Posts& posts,
                                const dem::Window& of_posts) const;

    const RasterRunOptions& options_;
    const RasterGround& ground_;
    FilesInUse& files_;
    OutputFile* file_;
    const Figure& figure_;
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
    std::optional<RasterFile> writer_;
    std::optional<ProgressBar> bar_;
    double share_ = 0, part_share_ = 0;
    SampledTime sampled_;
    double passed_s_ = 0, ready_s_ = 0;  ///< until now, and until the work proper began
    double sites_s_ = 0;                 ///< of these, to make tiles with their halos ready
    std::size_t sites_ = 0;
    Progress::Clock::time_point began_ = Progress::Clock::now();
};

}  // namespace relevo::figure

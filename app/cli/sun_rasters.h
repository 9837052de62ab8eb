#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cli/sun_options.h"
#include "dem/clip.h"
#include "light/raster/beyond.h"
#include "output/raster_writer.h"

/// What the verbs that give a figure for every post of a DEM share.
namespace relevo::cli {

/// A DEM, and what of it a raster is made of.
struct RasterGround {
    dem::Posts posts;
    dem::Window window;              ///< that is asked for
    std::vector<dem::Window> parts;  ///< of it, one after the other

    bool whole() const;
    dem::Grid grid() const;  ///< of the result
};

/// DEM..., -k, -o, --overwrite, --co, --clip, --clip-crs, --highest.
struct RasterArguments {
    DemArguments dem;
    double terrestrial_refraction = 0.13;
    OutputArguments output;
    std::vector<std::string> creation_options;
    std::string clip, clip_crs;
    std::optional<double> highest_m;  ///< of terrain beyond the DEM
    bool dry_run = false;

    void add_to(Verb verb);
    /// Opens the result, before any work is done. @throws Error as OutputArguments::open, (Usage)
    /// for creation options that there are not
    OutputFile& open(FilesInUse& files) const;
    /// @throws Error (Usage, BadInput) as dem::load, dem::parse_clip and dem::window_of
    RasterGround load() const;
    /// What every such file says of itself; `more` besides.
    output::RasterMetadata about(const RasterGround& ground, const std::string& definition,
                                 std::int64_t holes, output::RasterMetadata more) const;
};

/// A raster being made: part by part, with a bar on a terminal. With --dry-run so much of it is
/// computed as tells how long it takes, and nothing is written.
class RasterRun {
  public:
    /// @param calls           of core's functions that each part takes
    /// @param bytes_a_post    of memory while computing, besides the DEM's heights (measured)
    RasterRun(const RasterArguments& arguments, OutputFile& file, const RasterGround& ground,
              output::RasterType type, const std::vector<output::RasterBand>& bands,
              std::size_t calls, int bytes_a_post);

    /// Calls `body` with one part after the other.
    /// @return whether all of them are done: not where a dry run knows enough
    bool each_part(const std::function<void(const dem::Window&)>& body);
    /// What the options of core's functions want to be told by.
    std::function<void(double)> done();
    template <typename T>
    void put(std::size_t band, const dem::Window& part, const Array2d<T>& values) {
        if (writer_)
            writer_->put(band, part.column - ground_.window.column, part.row - ground_.window.row,
                         values);
    }
    /// Terrain beyond the DEM that could change figures is told of, and written into the file.
    /// @param look   for it; a dry run does not
    /// @param would  as light::Beyond::text()
    void warn_of(const std::function<std::optional<light::Beyond>()>& look,
                 const std::string& would);
    /// Gives the file its name; for a dry run says instead what it has found out.
    /// @return whether there is a file
    bool finish(const std::string& definition, std::int64_t holes, output::RasterMetadata more);

  private:
    void tell() const;
    std::int64_t inner_voids_of(const dem::Window& part) const;

    const RasterArguments& arguments_;
    const RasterGround& ground_;
    std::int64_t inner_voids_ = 0;
    std::string beyond_;
    std::optional<output::RasterWriter> writer_;
    std::optional<ProgressBar> bar_;
    std::size_t calls_, bands_;
    int bytes_a_post_, bytes_a_value_;
    double share_ = 0, part_share_ = 0;
    double passed_s_ = 0, ready_s_ = 0;  ///< until now, and until the work proper began
    Progress::Clock::time_point began_ = Progress::Clock::now();
};

}  // namespace relevo::cli

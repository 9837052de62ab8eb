#include "cli/sun_rasters.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/held_notices.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "light/point/horizon.h"
#include "light/sweep/sweep.h"
#include "session/sun_raster.h"

namespace relevo::cli {
namespace {

// Measured: the program with its libraries; what GDAL keeps of a file that it writes, and how many
// tiles of all bands it has at once then.
constexpr double kProgram_mib = 120, kWriting_mib = 256, kTilesAtOnce = 20;
constexpr double kTile = 512;  // posts a side

}  // namespace

bool RasterGround::whole() const {
    return window == dem::Window{0, 0, posts.grid().columns(), posts.grid().rows()};
}

dem::Grid RasterGround::grid() const {
    return whole() ? posts.grid() : posts.grid().part(window, window.columns, window.rows);
}

void RasterArguments::add_to(Verb verb) {
    dem.add_to(verb);
    verb.add_option(
            "-k,--terrestrial-refraction", terrestrial_refraction,
            "Terrestrial refraction: curvature of a line of sight in units of the Earth's (0.13)")
        .check(in_range(-1.0, 0.9));
    output.endings = {"tif", "tiff"};
    verb.add_option("-o,--output", output.path,
                    "Cloud-optimised GeoTIFF to write, on the DEM's grid")
        .required();
    verb.add_flag("--overwrite", output.overwrite, "Replace an existing file");
    verb.add_option("--co", creation_options,
                    "Creation option of GDAL's COG driver: COMPRESS=ZSTD; may be repeated")
        .one_word();
    verb.add_option("--clip", clip,
                    "Compute only the posts in W,S,E,N of the DEM's CRS; the terrain around still "
                    "casts shadows")
        .type_name("W,S,E,N");
    verb.add_option("--clip-crs", clip_crs, "CRS of --clip: EPSG:4326");
    verb.add_option("--highest", highest_m,
                    "Upper bound of the terrain outside the DEM, m (the DEM's highest post)")
        .check(in_range(-500.0, light::kHighestTerrain_m));
    verb.add_flag("--dry-run", dry_run,
                  "Estimate time and memory from a small part; write nothing");
}

OutputFile& RasterArguments::open(FilesInUse& files) const {
    output::check_creation_options(creation_options);
    return *output.open(files, dem);
}

RasterGround RasterArguments::load() const {
    if (clip.empty() && !clip_crs.empty()) bad_usage("--clip-crs: needs --clip");
    std::optional<dem::Clip> rectangle;
    if (!clip.empty()) rectangle = dem::parse_clip(clip, "--clip");
    if (!clip_crs.empty()) rectangle->crs = geo::Crs::parse(clip_crs, "--clip-crs");
    log::HeldNotices notices;
    dem::Posts posts = dem::Posts::load(dem.paths, dem.options());
    notices.release();
    const dem::Grid& grid = posts.grid();
    const dem::Window window = rectangle ? dem::window_of(grid, *rectangle, "--clip")
                                         : dem::Window{0, 0, grid.columns(), grid.rows()};
    std::vector<dem::Window> parts{window};
    if (!posts.in_memory())
        parts = session::raster_parts(window, dem.options().memory.posts / session::kPostsAPart);
    return {std::move(posts), window, std::move(parts)};
}

output::RasterMetadata RasterArguments::about(const RasterGround& ground,
                                              const std::string& definition, std::int64_t holes,
                                              output::RasterMetadata more) const {
    std::optional<dem::Window> part;
    if (!ground.whole()) part = ground.window;
    output::RasterMetadata about = session::raster_metadata(
        ground.posts, RELEVO_VERSION, definition, terrestrial_refraction, holes, part);
    for (auto& item : more)
        about.push_back(std::move(item));
    return about;
}

namespace {

constexpr double kEnough_s = 2;  // of computing, to say how long all of it takes

/// A dry run knows enough.
struct Enough {};

double seconds_since(Progress::Clock::time_point began) {
    return std::chrono::duration<double>(Progress::Clock::now() - began).count();
}

double posts_of(const dem::Window& window) {
    return double(window.columns) * window.rows;
}

}  // namespace

RasterRun::RasterRun(const RasterArguments& arguments, OutputFile& file, const RasterGround& ground,
                     output::RasterType type, const std::vector<output::RasterBand>& bands,
                     std::size_t calls, int bytes_a_post)
    : arguments_(arguments),
      ground_(ground),
      calls_(calls),
      bands_(bands.size()),
      bytes_a_post_(bytes_a_post),
      bytes_a_value_(type == output::RasterType::Float ? 4 : 1) {
    if (!arguments.dry_run) {
        writer_.emplace(file, ground.grid(), type, bands, arguments.creation_options);
        bar_.emplace(printable(file.path().string()));
    }
    began_ = Progress::Clock::now();
}

std::function<void(double)> RasterRun::done() {
    return [this](double of_call) {
        share_ += of_call * part_share_ / static_cast<double>(calls_);
        passed_s_ = seconds_since(began_);
        if (bar_) bar_->show(share_);
        if (!writer_ && passed_s_ - ready_s_ > kEnough_s && share_ < 1) throw Enough();
    };
}

bool RasterRun::each_part(const std::function<void(const dem::Window&)>& body) {
    ready_s_ = passed_s_ = seconds_since(began_);
    try {
        for (const dem::Window& part : ground_.parts) {
            part_share_ = posts_of(part) / posts_of(ground_.window);
            body(part);
            if (writer_) inner_voids_ += inner_voids_of(part);
        }
    } catch (const Enough&) {
        return false;
    }
    return true;
}

std::int64_t RasterRun::inner_voids_of(const dem::Window& part) const {
    const dem::Posts& posts = ground_.posts;
    std::vector<float> buffer;
    const dem::Posts::View view = posts.view(part, buffer);
    std::int64_t count = 0;
    for (int row = part.row; row < part.row + part.rows; ++row)
        for (int column = part.column; column < part.column + part.columns; ++column)
            count += std::isnan(*view.at(column, row)) && !posts.is_outside(column, row);
    return count;
}

void RasterRun::warn_of(const std::function<std::optional<light::Beyond>()>& look,
                        const std::string& would) {
    if (!writer_) return;
    const std::optional<light::Beyond> beyond = look();
    if (!beyond) return;
    beyond_ = beyond->text(would);
    log::warning(beyond->advice());
    log::debug(beyond_);
}

bool RasterRun::finish(const std::string& definition, std::int64_t holes,
                       output::RasterMetadata more) {
    bar_.reset();
    if (!writer_) {
        tell();
        return false;
    }
    if (inner_voids_ > 0)
        log::warning(fmt::format("the DEM has {} voids: they get no value and cast no shadow",
                                 inner_voids_));
    if (!beyond_.empty()) more.emplace_back("BEYOND_DEM", beyond_);
    writer_->finish(arguments_.about(ground_, definition, holes, std::move(more)));
    return true;
}

void RasterRun::tell() const {
    constexpr double kMiB = 1 << 20;
    const double posts = posts_of(ground_.window);
    double most = 0;  // posts of a part
    for (const dem::Window& part : ground_.parts)
        most = std::max(most, posts_of(part));
    const dem::Grid& grid = ground_.posts.grid();
    const MemoryBudget memory = arguments_.dem.options().memory;
    // What sweeps keep; those beyond memory have what is kept of the heights, and the file's
    // blocks.
    const double heights =
        ground_.posts.in_memory()
            ? (sizeof(float) + light::Sweep::kBytesAPost) * grid.columns() * grid.rows()
            : static_cast<double>(sizeof(float)) * static_cast<double>(memory.posts) +
                  static_cast<double>(memory.block_bytes);
    // A result is written from what is kept of it.
    const double tiles =
        std::ceil(ground_.window.columns / kTile) * std::ceil(ground_.window.rows / kTile);
    const double band = bytes_a_value_, tile = kTile * kTile * band * static_cast<double>(bands_);
    const double writing = most * band + std::min(kWriting_mib * kMiB, tiles * tile) +
                           std::min(kTilesAtOnce, 3 * tiles + 2) * tile;
    fmt::print("posts               {:.0f}, in {} part{}\n", posts, ground_.parts.size(),
               ground_.parts.size() == 1 ? "" : "s");
    fmt::print("memory              some {:.0f} MiB, {:.0f} of them heights\n",
               (heights + std::max(most * bytes_a_post_, writing)) / kMiB + kProgram_mib,
               heights / kMiB);
    fmt::print("computing           some {}, as {:.3g} % of it took {:.2g} s on {} threads\n",
               duration_text(ready_s_ + (passed_s_ - ready_s_) / std::max(share_, 1e-9)),
               100 * share_, passed_s_, thread_count());
    fmt::print(
        "result              {} band{} of {:.0f} MiB before compression, temporary space in the "
        "folder of the result\n",
        bands_, bands_ == 1 ? "" : "s", posts * bytes_a_value_ / kMiB);
}

}  // namespace relevo::cli

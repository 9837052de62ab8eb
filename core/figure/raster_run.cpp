#include "figure/raster_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/sha256.h"
#include "base/text.h"
#include "dem/file_state.h"
#include "dem/files_of.h"
#include "light/sweep/sweep.h"

namespace relevo::figure {
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

/// Whether some posts of a window have heights, by those that are at hand.
bool has_ground(const dem::Posts& posts, const dem::Window& window) {
    constexpr int kSide = 8;
    for (int i = 0; i < kSide * kSide; ++i)
        if (!std::isnan(posts.thinned_m(window.column + window.columns * (i % kSide) / kSide,
                                        window.row + window.rows * (i / kSide) / kSide)))
            return true;
    return false;
}

/// A window around both.
dem::Window around(const dem::Window& a, const dem::Window& b) {
    if (a.is_empty()) return b;
    const int column = std::min(a.column, b.column), row = std::min(a.row, b.row);
    return {column, row, std::max(a.end_column(), b.end_column()) - column,
            std::max(a.end_row(), b.end_row()) - row};
}

}  // namespace

std::string stamp_of_dem(const std::vector<std::string>& paths, const dem::LoadOptions& options) {
    std::vector<std::string> files = paths;
    for (const auto& of : {paths, options.surroundings})
        for (const std::filesystem::path& file : dem::files_of(of))
            files.push_back(file.string());
    return sha256_of_text(output::stamp_of(files) + dem::text_of(options));
}

RasterRun::RasterRun(const RasterRunOptions& options, OutputFile* file, FilesInUse& files,
                     const RasterGround& ground, const Figure& figure)
    : options_(options),
      ground_(ground),
      files_(files),
      file_(file),
      figure_(figure),
      bands_(figure.bands()),
      halo_m_(figure.halo_m(ground.posts)) {
    if (options.tiles.given())
        choose_tiles();
    else
        todo_ = {{"", ground.window}};
    for (const output::PlannedTile& tile : todo_) {
        window_ = around(window_, tile.window);
        posts_ += posts_of(tile.window);
    }
    if (!is_dry() && !is_done() && !options.done) bar_.emplace(printable(options.output));
    began_ = Progress::Clock::now();
    if (is_done() && options.purpose != RasterRunOptions::Purpose::Plan)
        log::info(fmt::format("no tile is to be made; {} are there already", folder_->there()));
}

std::vector<std::string> RasterRun::options_of_file() const {
    constexpr std::int64_t kThread_mib = 128;  // a quarter is what one of GDAL's threads takes
    const std::int64_t most = std::max<std::int64_t>(1, ground_.options.memory.mib() / kThread_mib);
    std::vector<std::string> options{
        fmt::format("NUM_THREADS={}", std::min<std::int64_t>(most, thread_count()))};
    std::ranges::copy(options_.creation_options, std::back_inserter(options));
    return options;
}

void RasterRun::choose_tiles() {
    const dem::Posts& posts = ground_.posts;
    std::vector<output::PlannedTile> tiles = options_.tiles.of(posts.grid(), ground_.window);
    if (options_.tiles.halo_km) {
        if (posts.surroundings())
            bad_usage("--halo: not with --surroundings; make tiles without a halo");
        halo_m_ = *options_.tiles.halo_km * 1000;
        for (const output::PlannedTile& tile : tiles)
            FarGround::require_room(posts.grid(), halo_m_, tile.window, ground_.options.memory);
        far_.emplace(ground_.paths, ground_.options, posts, halo_m_, options_.output,
                     ground_.is_planned);
        far_metadata_.emplace_back("FAR_GROUND", far_->description());
    }
    output::RasterMetadata metadata = figure_.metadata(posts);
    std::ranges::copy(far_metadata_, std::back_inserter(metadata));
    for (const output::RasterBand& band : bands_) {
        metadata.emplace_back("band", band.name);
        std::ranges::copy(band.metadata, std::back_inserter(metadata));
    }
    std::string meaning = options_.meaning;
    for (const auto& [key, value] : metadata)
        meaning += key + "=" + value + "\n";
    const bool is_plan = options_.purpose == RasterRunOptions::Purpose::Plan;
    folder_.emplace(options_.output,
                    output::TilePlan{.command = options_.command,
                                     .digest = std::move(meaning),
                                     .dems = ground_.paths,
                                     .grid = posts.grid(),
                                     .statistics = posts.about().statistics,
                                     .content = posts.content(),
                                     .dem_tiles = posts.about().tiles,
                                     .stamp = ground_.stamp,
                                     .tiles = std::move(tiles)},
                    options_.tiles, options_.overwrite, is_plan);
    todo_ = folder_->todo();
    if (options_.purpose != RasterRunOptions::Purpose::Estimate)
        folder_->write_plan(posts, far_ ? &*far_ : nullptr);
    // The middle of a DEM says more of how long it takes than its corner, and ground than voids.
    if (is_dry()) {
        std::rotate(todo_.begin(), todo_.begin() + static_cast<std::ptrdiff_t>(todo_.size() / 2),
                    todo_.end());
        std::stable_partition(todo_.begin(), todo_.end(), [&](const output::PlannedTile& tile) {
            return has_ground(posts, tile.window);
        });
    }
}

void RasterRun::count(double of_call) {
    const double step = of_call * part_share_ / static_cast<double>(figure_.calls());
    share_ += step;
    passed_s_ = seconds_since(began_);
    sampled_.end_step(step, passed_s_);
    if (bar_) bar_->show(share_);
    if (options_.done) options_.done(step);
    const double worked_s = passed_s_ - ready_s_ - sites_s_;
    if (is_dry() && worked_s > kEnough_s && share_ < 1 && sampled_.suffices()) throw Enough();
}

PartMaker RasterRun::maker_of(const dem::Posts& posts, const dem::Window& window) {
    return figure_.maker(
        {.posts = posts,
         .window = window,
         .middle = ground_.posts.grid().center(),
         .put =
             [this](std::size_t band, const dem::Window& part, const Array2d<float>& values) {
                 if (writer_)
                     writer_->put(band, part.column - raster_.column, part.row - raster_.row,
                                  values);
             },
         .done = [this](double of_call) { count(of_call); },
         .is_estimate = is_dry()});
}

void RasterRun::make_all() {
    if (is_done()) return;
    try {
        PartMaker make_part;
        if (!far_) make_part = maker_of(ground_.posts, window_);
        ready_s_ = passed_s_ = seconds_since(began_);
        for (const output::PlannedTile& tile : todo_)
            if (far_)
                make_far(tile);
            else
                make(tile, tile.window, make_part, ground_.posts);
    } catch (const Enough&) {
    }
    bar_.reset();
    if (!is_dry()) say_what_was_made();
}

/// A tile with its halo is in memory, and made at once.
std::vector<dem::Window> RasterRun::parts_of(const dem::Window& raster) const {
    return far_ ? std::vector{raster} : raster_parts(ground_.posts, raster, ground_.options.memory);
}

void RasterRun::make_far(const output::PlannedTile& tile) {
    const Progress::Clock::time_point began = Progress::Clock::now();
    const FarGround::Site site = far_->site_of(tile.window);
    const PartMaker make_part = maker_of(*site.posts, site.tile);
    sites_s_ += seconds_since(began);
    ++sites_;
    make(tile, site.tile, make_part, *site.posts);
}

/// @param raster  the tile's window of `posts`, from which it is made
void RasterRun::make(const output::PlannedTile& tile, const dem::Window& raster,
                     const PartMaker& make_part, const dem::Posts& posts) {
    raster_ = raster;
    std::optional<OutputFile> own;
    output::RasterMetadata metadata = far_metadata_;
    if (!is_dry()) {
        try {
            if (folder_) own.emplace(folder_->open(tile, files_));
        } catch (const Error&) {
            if (has_been_made(tile)) return;
            throw;
        }
        writer_.emplace(own ? *own : *file_, figure_, ground_.posts, tile.window,
                        options_of_file());
        look_beyond(tile.window, metadata);
    }
    const auto begin = [&](const dem::Window& part) {
        part_share_ = posts_of(part) / posts_;
        sampled_.begin_part(part_share_, seconds_since(began_));
    };
    const PartMade made = make_parts(make_part, parts_of(raster), begin);
    if (!writer_) return;
    inner_voids_ += inner_voids_of(tile.window, posts, raster);
    if (folder_) {
        metadata.emplace_back(output::kCommandKey, folder_->plan().command);
        metadata.emplace_back(output::kDigestKey, folder_->plan().digest);
    }
    try {
        writer_->finish(options_.version, made, metadata);
    } catch (const Error&) {
        if (!has_been_made(tile)) throw;
    }
    writer_.reset();
}

/// By another process, since this one looked: a task that was requeued while it still runs.
bool RasterRun::has_been_made(const output::PlannedTile& tile) const {
    if (!folder_ || !options_.tiles.resume || !folder_->is_whole(tile)) return false;
    log::info(fmt::format("{}: another process has made it meanwhile", printable(tile.name)));
    return true;
}

/// @param raster    of the DEM
/// @param of_posts  the same of `posts`
std::int64_t RasterRun::inner_voids_of(const dem::Window& raster, const dem::Posts& posts,
                                       const dem::Window& of_posts) const {
    const int right = raster.column - of_posts.column, down = raster.row - of_posts.row;
    std::vector<float> buffer;
    std::int64_t count = 0;
    for (const dem::Window& part : parts_of(of_posts)) {
        const dem::Posts::View view = posts.view(part, buffer);
        for (int row = part.row; row < part.end_row(); ++row)
            for (int column = part.column; column < part.end_column(); ++column)
                count += std::isnan(*view.at(column, row)) &&
                         !ground_.posts.is_outside(column + right, row + down);
    }
    return count;
}

void RasterRun::look_beyond(const dem::Window& raster, output::RasterMetadata& metadata) {
    const std::optional<light::Beyond> beyond = figure_.beyond(ground_.posts, raster);
    if (!beyond) return;
    metadata.emplace_back("BEYOND_DEM", beyond->text(figure_.would()));
    if (!std::exchange(warned_, true)) log::warning(beyond->advice());
    log::debug(beyond->text(figure_.would()));
}

void RasterRun::say_what_was_made() const {
    if (inner_voids_ > 0)
        log::warning(fmt::format("the DEM has {} voids: they get no value and cast no shadow",
                                 inner_voids_));
    if (!folder_) return;
    log::info(fmt::format(
        "{} tiles in {}{}", todo_.size(), duration_text(passed_s_),
        folder_->there() > 0 ? fmt::format("; {} were there already", folder_->there()) : ""));
}

void RasterRun::estimate_memory(RasterEstimate& found) const {
    // Measured: the program with its libraries; what GDAL keeps of a file that it writes, and how
    // many tiles of all bands it has at once then; what is put together while a tile is read with
    // its halo.
    constexpr double kMiB = 1 << 20, kProgram_mib = 120, kWriting_mib = 256, kTilesAtOnce = 20,
                     kSite_mib = 64;
    constexpr double kTile = 512;  // posts a side
    double part_posts = 0, far_bytes = 0;
    dem::Window largest;
    for (const output::PlannedTile& tile : todo_) {
        if (posts_of(tile.window) > posts_of(largest)) largest = tile.window;
        if (far_) far_bytes = std::max(far_bytes, far_->kept_bytes(tile.window));
        for (const dem::Window& part : parts_of(tile.window)) {
            part_posts = std::max(part_posts, posts_of(part));
            ++found.parts;
        }
    }
    // What is kept of the heights, what sweeps keep of those in memory, and the file's blocks.
    const MemoryBudget& memory = ground_.options.memory;
    const double all = posts_of(whole_window(ground_.posts.grid())), a_height = sizeof(float);
    const double held =
        ground_.posts.in_memory()
            ? all * (a_height + (far_ ? 0 : light::Sweep::kBytesAPost))
            : a_height * double(memory.posts / (far_ ? FarGround::kShareOfOthers : 1));
    const double heights = held + std::min(double(memory.block_bytes), a_height * all) +
                           (far_ ? far_bytes + kSite_mib * kMiB : 0);
    // A result is written from what is kept of it.
    const double tiles = std::ceil(largest.columns / kTile) * std::ceil(largest.rows / kTile);
    const double band = bytes_a_value(), tile = kTile * kTile * band * double(bands_.size());
    const double writing = part_posts * band + std::min(kWriting_mib * kMiB, tiles * tile) +
                           std::min(kTilesAtOnce, 3 * tiles + 2) * tile;
    found.heights_mib = heights / kMiB;
    found.memory_mib =
        (heights + std::max(part_posts * figure_.bytes_a_post(), writing)) / kMiB + kProgram_mib;
}

RasterEstimate RasterRun::estimate() const {
    const double sites_s =
        sites_s_ / double(std::max<std::size_t>(1, sites_)) * double(todo_.size());
    RasterEstimate found{.posts = posts_,
                         .ready_s = ready_s_,
                         .computing_s = ready_s_ + sites_s + sampled_.all_s(),
                         .sampled_share = share_,
                         .sampled_s = passed_s_,
                         .threads = thread_count(),
                         .bands = bands_.size(),
                         .result_bytes = posts_ * bytes_a_value() * double(bands_.size())};
    estimate_memory(found);
    return found;
}

}  // namespace relevo::figure

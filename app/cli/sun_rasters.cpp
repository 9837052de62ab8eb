#include "cli/sun_rasters.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/held_notices.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/sha256.h"
#include "base/text.h"
#include "dem/file_state.h"
#include "dem/files_of.h"

namespace relevo::cli {
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

void RasterArguments::add_to(Verb verb_of_rasters, figure::Figure& figure) {
    verb = verb_of_rasters;
    dem.add_to(*verb);
    add_number(*verb, figure::kTerrestrialRefraction, figure.terrestrial_refraction, "-k,");
    output.endings = {"tif", "tiff"};
    verb->add_option("-o,--output", output.path,
                     "Cloud-optimised GeoTIFF to write, on the DEM's grid; with --tiles a folder")
        .required();
    verb->add_flag("--overwrite", output.overwrite, "Replace an existing file");
    verb->add_option("--co", creation_options,
                     "Creation option of GDAL's COG driver: COMPRESS=ZSTD; may be repeated")
        .one_word();
    verb->add_option("--clip", clip,
                     "Compute only the posts in W,S,E,N of the DEM's CRS; the terrain around still "
                     "casts shadows")
        .type_name("W,S,E,N");
    verb->add_option("--clip-crs", clip_crs, "CRS of --clip: EPSG:4326");
    add_number(*verb, figure::kHighest_m, figure.highest_m);
    tiles.add_to(*verb);
    if (PlanArguments::is_for(*verb))
        plan.add_to(*verb);
    else
        verb->add_flag("--dry-run", dry_run,
                       "Estimate time and memory from a small part; write nothing");
}

namespace {

/// Refuses names of what a run in tiles writes besides its tiles, before any work.
void check_results(const RasterArguments& arguments, const std::filesystem::path& folder,
                   const FilesInUse& files) {
    const bool overwrite = arguments.output.overwrite;
    std::vector<std::filesystem::path> results = arguments.plan.scripts();
    const auto folder_of = [](const std::filesystem::path& file) {
        return std::filesystem::absolute(file).lexically_normal().parent_path();
    };
    const std::filesystem::path of_plan = folder / output::kPlanFile;
    for (const std::filesystem::path& script : results)
        if (folder_of(script) == folder_of(of_plan))
            make_folder_of(of_plan, "-o");  // as the plan would
    arguments.plan.check(files, arguments.tiles.shard, overwrite);
    results.push_back(folder);
    std::ranges::copy(output::plan_files(folder), std::back_inserter(results));
    files.check_planned(results, "-o");
    if (!overwrite) check_plan_files(folder);
}

}  // namespace

OutputFile* RasterArguments::open(FilesInUse& files) const {
    output::check_creation_options(creation_options);
    tiles.check();
    if (plan.on && !tiles.given()) bad_usage("plan: needs --tiles");
    if (!tiles.given()) return output.open(files, dem);
    const std::filesystem::path folder = output.path;
    dem::add_named(dem.paths, files);
    if (output.overwrite)
        for (const std::filesystem::path& path : dem::files_of(dem.paths))
            files.add_input(path, "a file that the DEM is read from,");
    if (!parse_number(tiles.tiles)) files.add_input(tiles.tiles, "the index of tiles");
    check_results(*this, folder, files);
    return nullptr;
}

namespace {

/// --crs is about the DEM, and so about the index of tiles where the DEM is that index.
std::string crs_of_tiles(const RasterArguments& arguments) {
    return contains(arguments.dem.paths, arguments.tiles.tiles) ? arguments.dem.options().crs : "";
}

/// Of all files that the DEM is read from, also those that a name stands for, and of how they are
/// read.
std::string stamp_of_dem(const std::vector<std::string>& paths, const dem::LoadOptions& options) {
    std::vector<std::string> files = paths;
    for (const std::filesystem::path& file : dem::files_of(paths))
        files.push_back(file.string());
    return sha256_of_text(output::stamp_of(files) + dem::text_of(options));
}

}  // namespace

RasterGround RasterArguments::load() const {
    if (clip.empty() && !clip_crs.empty()) bad_usage("--clip-crs: needs --clip");
    std::optional<dem::Clip> rectangle;
    if (!clip.empty()) rectangle = dem::parse_clip(clip, "--clip");
    if (!clip_crs.empty()) rectangle->crs = geo::Crs::parse(clip_crs, "--clip-crs");
    dem::LoadOptions options = dem.options();
    std::optional<dem::PostsFacts> facts;
    bool is_planned = false;
    std::string stamp;
    if (tiles.given()) {
        if (!dem.values.has("--memory")) options.memory = memory_of_allocation(options.memory);
        say_allocation(options.memory);
        const auto known = plan_of(output.path, output.overwrite);
        stamp = stamp_of_dem(dem.paths, options);
        is_planned = known && known->stamp == stamp;
        if (is_planned) facts = output::read_posts_facts(output.path, *known);
    }
    dem::LoadOptions of_others = options;
    if (tiles.halo_km) {
        of_others.memory.posts /= FarGround::kShareOfOthers;
        of_others.memory.whole_posts /= FarGround::kShareOfOthers;
    }
    log::HeldNotices notices;
    dem::Posts posts = dem::Posts::load(dem.paths, of_others, facts ? &*facts : nullptr);
    notices.release();
    const dem::Window window = rectangle ? dem::window_of(posts.grid(), *rectangle, "--clip")
                                         : figure::whole_window(posts.grid());
    return {std::move(posts), window, options, is_planned, std::move(stamp)};
}

RasterRun::RasterRun(const RasterArguments& arguments, OutputFile* file, FilesInUse& files,
                     const RasterGround& ground, const figure::Figure& figure)
    : arguments_(arguments),
      ground_(ground),
      files_(files),
      file_(file),
      figure_(figure),
      bands_(figure.bands()),
      halo_m_(figure.halo_m(ground.posts)) {
    if (arguments.tiles.given())
        choose_tiles();
    else
        todo_ = {{"", ground.window}};
    for (const output::PlannedTile& tile : todo_) {
        window_ = around(window_, tile.window);
        posts_ += posts_of(tile.window);
    }
    if (!is_dry() && !is_done()) {
        if (file_) writer_.emplace(*file_, figure, ground.posts, ground.window, options_of_file());
        bar_.emplace(printable(arguments.output.path));
    }
    began_ = Progress::Clock::now();
    if (!is_done()) return;
    if (arguments.plan.on)
        tell_plan({});
    else
        log::info(fmt::format("no tile is to be made; {} are there already", folder_->there()));
}

std::vector<std::string> RasterRun::options_of_file() const {
    constexpr std::int64_t kThread_mib = 128;  // a quarter is what one of GDAL's threads takes
    const std::int64_t most = std::max<std::int64_t>(1, ground_.options.memory.mib() / kThread_mib);
    std::vector<std::string> options{
        fmt::format("NUM_THREADS={}", std::min<std::int64_t>(most, thread_count()))};
    std::ranges::copy(arguments_.creation_options, std::back_inserter(options));
    return options;
}

void RasterRun::choose_tiles() {
    const dem::Posts& posts = ground_.posts;
    const Verb& verb = *arguments_.verb;
    std::vector<output::PlannedTile> tiles =
        arguments_.tiles.of(posts.grid(), ground_.window, crs_of_tiles(arguments_));
    if (arguments_.tiles.halo_km) {
        for (const output::PlannedTile& tile : tiles)
            FarGround::require_room(posts.grid(), *arguments_.tiles.halo_km * 1000, tile.window,
                                    ground_.options.memory);
        far_.emplace(arguments_.dem.paths, ground_.options, posts, *arguments_.tiles.halo_km * 1000,
                     arguments_.output.path, ground_.is_planned);
        far_metadata_.emplace_back("FAR_GROUND", far_->description());
        halo_m_ = *arguments_.tiles.halo_km * 1000;
    }
    output::RasterMetadata meaning = figure_.metadata(posts);
    std::ranges::copy(far_metadata_, std::back_inserter(meaning));
    for (const output::RasterBand& band : bands_) {
        meaning.emplace_back("band", band.name);
        meaning.insert(meaning.end(), band.metadata.begin(), band.metadata.end());
    }
    folder_.emplace(arguments_.output.path,
                    output::TilePlan{.command = command_text(verb.command(), verb.given()),
                                     .digest = meaning_of(verb.command(), verb.given(), meaning),
                                     .dems = arguments_.dem.paths,
                                     .grid = posts.grid(),
                                     .statistics = posts.about().statistics,
                                     .content = posts.content(),
                                     .dem_tiles = posts.about().tiles,
                                     .stamp = ground_.stamp,
                                     .tiles = std::move(tiles)},
                    arguments_.tiles, arguments_.output.overwrite, arguments_.plan.on);
    todo_ = folder_->todo();
    if (!arguments_.dry_run) folder_->write_plan(posts, far_ ? &*far_ : nullptr);
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
    if (!writer_ && passed_s_ - ready_s_ - sites_s_ > kEnough_s && share_ < 1 &&
        sampled_.suffices())
        throw Enough();
}

figure::PartMaker RasterRun::maker_of(const dem::Posts& posts, const dem::Posts* around,
                                      const dem::Window& window) {
    return figure_.maker(
        {.posts = posts,
         .around = around,
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

bool RasterRun::make_all() {
    if (is_done()) return false;
    try {
        figure::PartMaker make_part;
        if (!far_) make_part = maker_of(ground_.posts, nullptr, window_);
        ready_s_ = passed_s_ = seconds_since(began_);
        for (const output::PlannedTile& tile : todo_)
            if (far_)
                make_far(tile);
            else
                make(tile, tile.window, make_part, ground_.posts);
    } catch (const Enough&) {
    }
    bar_.reset();
    if (arguments_.plan.on)
        tell_plan(estimate());
    else if (arguments_.dry_run)
        estimate().print();
    else
        say_what_was_made();
    return !is_dry();
}

/// A tile with its halo is in memory, and made at once.
std::vector<dem::Window> RasterRun::parts_of(const dem::Window& raster) const {
    return far_ ? std::vector{raster}
                : figure::raster_parts(ground_.posts, raster, ground_.options.memory);
}

void RasterRun::make_far(const output::PlannedTile& tile) {
    const Progress::Clock::time_point began = Progress::Clock::now();
    const FarGround::Site site = far_->site_of(tile.window);
    const figure::PartMaker make_part = maker_of(*site.posts, site.around, site.tile);
    sites_s_ += seconds_since(began);
    ++sites_;
    make(tile, site.tile, make_part, *site.posts);
}

/// @param raster  the tile's window of `posts`, from which it is made
void RasterRun::make(const output::PlannedTile& tile, const dem::Window& raster,
                     const figure::PartMaker& make_part, const dem::Posts& posts) {
    raster_ = raster;
    std::optional<OutputFile> own;
    if (folder_ && !is_dry()) {
        try {
            own.emplace(folder_->open(tile, files_));
        } catch (const Error&) {
            if (has_been_made(tile)) return;
            throw;
        }
        writer_.emplace(*own, figure_, ground_.posts, tile.window, options_of_file());
    }
    output::RasterMetadata metadata = far_metadata_;
    if (writer_) look_beyond(tile.window, metadata);
    const auto begin = [&](const dem::Window& part) {
        part_share_ = posts_of(part) / posts_;
        sampled_.begin_part(part_share_, seconds_since(began_));
    };
    const figure::PartMade made = figure::make_parts(make_part, parts_of(raster), begin);
    if (!writer_) return;
    inner_voids_ += inner_voids_of(tile.window, posts, raster);
    if (folder_) {
        metadata.emplace_back(output::kCommandKey, folder_->plan().command);
        metadata.emplace_back(output::kDigestKey, folder_->plan().digest);
    }
    try {
        writer_->finish(RELEVO_VERSION, made, metadata);
    } catch (const Error&) {
        if (!has_been_made(tile)) throw;
    }
    writer_.reset();
}

/// By another process, since this one looked: a task that was requeued while it still runs.
bool RasterRun::has_been_made(const output::PlannedTile& tile) const {
    if (!folder_ || !arguments_.tiles.resume || !folder_->is_whole(tile)) return false;
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

RasterEstimate RasterRun::estimate() const {
    RasterEstimate found;
    double most = 0;  // posts of a part
    dem::Window largest;
    for (const output::PlannedTile& tile : todo_) {
        if (posts_of(tile.window) > posts_of(largest)) largest = tile.window;
        for (const dem::Window& part : parts_of(tile.window)) {
            most = std::max(most, posts_of(part));
            ++found.parts;
        }
    }
    const int bytes_a_value = figure_.type() == output::RasterType::Float ? 4 : 1;
    MemoryBudget memory_of_posts = ground_.options.memory;
    double far_bytes = 0;
    if (far_) {
        memory_of_posts.posts /= FarGround::kShareOfOthers;
        for (const output::PlannedTile& tile : todo_)
            far_bytes = std::max(far_bytes, far_->kept_bytes(tile.window));
    }
    const RasterMemory memory =
        raster_memory(ground_.posts, most, largest, figure_.bytes_a_post(), bytes_a_value,
                      bands_.size(), memory_of_posts, far_bytes);
    found.posts = posts_;
    found.memory_mib = memory.all_mib;
    found.heights_mib = memory.heights_mib;
    found.ready_s = ready_s_;
    const double sites_s = sites_s_ / static_cast<double>(std::max<std::size_t>(1, sites_)) *
                           static_cast<double>(todo_.size());
    found.computing_s = ready_s_ + sites_s + sampled_.all_s();
    found.sampled_share = share_;
    found.sampled_s = passed_s_;
    found.threads = thread_count();
    found.bands = bands_.size();
    found.result_bytes = posts_ * bytes_a_value * static_cast<double>(bands_.size());
    return found;
}

void RasterRun::tell_plan(const RasterEstimate& estimate) const {
    RasterPlan plan{.estimate = estimate,
                    .tiles = folder_->plan().tiles.size(),
                    .there = folder_->there(),
                    .bands = bands_.size(),
                    .kind = arguments_.tiles.description(),
                    .halo_m = halo_m_,
                    .is_far = far_.has_value(),
                    .folder = arguments_.output.path,
                    .words = arguments_.plan.words(*arguments_.verb),
                    .overwrite = arguments_.output.overwrite};
    if (!arguments_.dem.values.has("--memory"))
        plan.words.insert(plan.words.begin() + 2,
                          fmt::format("--memory={}", ground_.options.memory.mib()));
    tell_raster_plan(arguments_.plan, plan, ground_.posts, todo_);
}

}  // namespace relevo::cli

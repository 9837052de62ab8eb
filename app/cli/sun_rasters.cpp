#include "cli/sun_rasters.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/allocation.h"
#include "base/contains.h"
#include "base/error.h"
#include "base/held_notices.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/shard.h"
#include "dem/clip.h"
#include "dem/files_of.h"

namespace relevo::cli {
namespace {

/// The verb, without `plan`, and those options that change values: "sun hours",
/// "--date=2026-06-21".
std::vector<std::string> meaning_of(const Verb& verb) {
    constexpr std::array<std::string_view, 7> kOfThisRun{
        "DEM", "--output", "--overwrite", "--shard", "--resume", "--dry-run", "--memory"};
    constexpr std::string_view kPlan = "plan ";
    const std::string command = verb.command();
    std::vector<std::string> words{command.starts_with(kPlan) ? command.substr(kPlan.size())
                                                              : command};
    for (const GivenOption& option : verb.given()) {
        if (contains(kOfThisRun, option.name) || contains(PlanArguments::kNames, option.name))
            continue;
        words.push_back(option.name);
        if (!option.is_flag) words.back() += fmt::format("={}", fmt::join(option.values, ","));
    }
    return words;
}

void print(const figure::RasterEstimate& estimate) {
    fmt::print("posts               {:.0f}, in {} part{}\n", estimate.posts, estimate.parts,
               estimate.parts == 1 ? "" : "s");
    fmt::print("memory              some {:.0f} MiB, {:.0f} of them heights\n", estimate.memory_mib,
               estimate.heights_mib);
    fmt::print("computing           some {}, as {:.3g} % of it took {:.2g} s on {} threads\n",
               duration_text(estimate.computing_s), 100 * estimate.sampled_share,
               estimate.sampled_s, estimate.threads);
    fmt::print(
        "result              {} band{} of {:.0f} MiB before compression, temporary space in the "
        "folder of the result\n",
        estimate.bands, estimate.bands == 1 ? "" : "s",
        estimate.result_bytes / static_cast<double>(estimate.bands) / kMiB);
}

/// Memory of a task, which may have less than the machine; the program itself takes some of it.
MemoryBudget memory_of_allocation(const MemoryBudget& memory) {
    constexpr std::int64_t kLeast_mib = 16, kProgram_mib = 256;
    const Allocation& given = allocation();
    if (!given.memory_bytes) return memory;
    const std::int64_t mib = *given.memory_bytes / MemoryBudget::kMiB - kProgram_mib;
    return MemoryBudget::of_mib(std::clamp(mib, kLeast_mib, memory.mib()));
}

/// Says how many threads and how much memory a task has, and what limits them.
void say_allocation(const MemoryBudget& memory) {
    const Allocation& given = allocation();
    const auto by = [](const std::string& name) {
        return name.empty() ? std::string() : " (" + name + ")";
    };
    log::info(fmt::format("{} threads{}, {} MiB of memory{}", given.threads, by(given.threads_by),
                          memory.mib(), by(given.memory_by)));
}

void add_tiles(Verb verb, RasterArguments& arguments) {
    verb.add_option("--tiles", arguments.tiles.tiles,
                    "Write a GeoTIFF for each tile into the folder that -o names: tiles of N x N "
                    "posts, or the tiles of an index by gdaltindex or STAC")
        .type_name("N|INDEX")
        .group("Tiles");
    add_number(verb, figure::kHalo_km, arguments.tiles.halo_km).group("Tiles");
    verb.add_option("--shard", arguments.shard,
                    "Make one part of the tiles: I/N, or array in an array task of a scheduler")
        .group("Tiles");
    verb.add_flag("--resume", arguments.tiles.resume,
                  "Keep tiles that are there, complete and of this command")
        .group("Tiles");
}

}  // namespace

void RasterArguments::add_to(Verb verb_of_rasters, figure::Figure& figure) {
    verb = verb_of_rasters;
    dem.add_to(*verb);
    dem.add_surroundings_to(*verb);
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
    add_tiles(*verb, *this);
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
    arguments.plan.check(files, arguments.shard, overwrite);
    results.push_back(folder);
    std::ranges::copy(output::plan_files(folder), std::back_inserter(results));
    files.check_planned(results, "-o");
    if (!overwrite) figure::check_plan_files(folder);
}

}  // namespace

OutputFile* RasterArguments::open(FilesInUse& files) const {
    output::check_creation_options(creation_options);
    if (!tiles.given() && !shard.empty()) bad_usage("--shard: needs --tiles");
    if (!tiles.given() && tiles.resume) bad_usage("--resume: needs --tiles");
    if (!tiles.given() && tiles.halo_km) bad_usage("--halo: needs --tiles");
    if (plan.on && !tiles.given()) bad_usage("plan: needs --tiles");
    if (!tiles.given()) return open_result(output, files, dem);
    const std::filesystem::path folder = output.path;
    dem.add_named(files);
    if (output.overwrite)
        for (const auto& paths : {dem.paths, dem.surroundings})
            for (const std::filesystem::path& path : dem::files_of(paths))
                files.add_input(path, "a file that the DEM is read from,");
    if (!parse_number(tiles.tiles)) files.add_input(tiles.tiles, "the index of tiles");
    check_results(*this, folder, files);
    return nullptr;
}

figure::RasterGround RasterArguments::load() const {
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
        const auto known = figure::plan_of(output.path, output.overwrite);
        stamp = figure::stamp_of_dem(dem.paths, options);
        is_planned = known && known->stamp == stamp;
        if (is_planned) facts = output::read_posts_facts(output.path, *known);
    }
    dem::LoadOptions of_others = options;
    if (tiles.halo_km) {
        of_others.memory.posts /= figure::FarGround::kShareOfOthers;
        of_others.memory.whole_posts /= figure::FarGround::kShareOfOthers;
    }
    log::HeldNotices notices;
    dem::Posts posts = dem::Posts::load(dem.paths, of_others, facts ? &*facts : nullptr);
    notices.release();
    const dem::Window window = rectangle ? dem::window_of(posts.grid(), *rectangle, "--clip")
                                         : figure::whole_window(posts.grid());
    return {std::move(posts), window, dem.paths, options, is_planned, std::move(stamp)};
}

bool RasterArguments::make(OutputFile* file, FilesInUse& files, const figure::RasterGround& ground,
                           const figure::Figure& figure) const {
    using Purpose = figure::RasterRunOptions::Purpose;
    const std::vector<std::string> meaning = meaning_of(*verb);
    figure::RasterRunOptions options{
        .purpose = plan.on   ? Purpose::Plan
                   : dry_run ? Purpose::Estimate
                             : Purpose::Make,
        .version = RELEVO_VERSION,
        .output = output.path,
        .overwrite = output.overwrite,
        .creation_options = creation_options,
        .tiles = tiles,
        .command = fmt::format("{}", fmt::join(meaning, " ")),
        .meaning = fmt::format("relevo " RELEVO_VERSION "\n{}\n", fmt::join(meaning, "\n"))};
    // --crs is about the DEM, and so about the index of tiles where the DEM is that index.
    if (contains(dem.paths, tiles.tiles)) options.tiles.crs = dem.options().crs;
    if (!shard.empty()) {
        const Shard part = parse_shard(shard, environment_variable);
        options.tiles.shard = part.number;
        options.tiles.shards = part.count;
    }
    figure::RasterRun run(options, file, files, ground, figure);
    run.make_all();
    if (plan.on) {
        std::vector<std::string> words = plan.words(*verb);
        if (!dem.values.has("--memory"))
            words.insert(words.begin() + 2,
                         fmt::format("--memory={}", ground.options.memory.mib()));
        tell_raster_plan(plan, run, options, ground.posts, std::move(words));
    } else if (dry_run && !run.is_done()) {
        print(run.estimate());
    }
    return options.purpose == Purpose::Make && !run.is_done();
}

}  // namespace relevo::cli

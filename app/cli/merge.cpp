#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files_in_use.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/percent.h"
#include "base/text.h"
#include "cli/commands.h"
#include "output/stac.h"
#include "output/tile_check.h"
#include "output/tile_mosaic.h"
#include "output/tile_plan.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
    std::string folder, output, stac, base;
    bool overwrite = false, allow_missing = false;
};

/// The tiles that are whole. Names the others.
/// @throws Error (Failed) where there are others, unless that is allowed, or none is whole
std::vector<output::PlannedTile> whole_tiles(const MergeArguments& arguments,
                                             const output::TilePlan& plan) {
    constexpr std::size_t kMostNamed = 20;
    const auto found = output::tiles_on_disk(arguments.folder, plan, plan.tiles);
    std::vector<output::PlannedTile> whole;
    std::size_t others = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i].state == output::TileOnDisk::State::Whole) {
            whole.push_back(plan.tiles[i]);
            continue;
        }
        const std::string name = (fs::path(arguments.folder) / plan.tiles[i].name).string();
        if (others++ < kMostNamed) log::error(fmt::format("{}: {}", printable(name), found[i].why));
    }
    if (whole.empty())
        failed(fmt::format("merge: none of {} tiles is there and whole; make them with --resume",
                           found.size()));
    if (others > 0 && !arguments.allow_missing)
        failed(
            fmt::format("merge: {} of {} tiles are missing or not whole; make them with "
                        "--resume, or pass --allow-missing",
                        others, found.size()));
    return whole;
}

void run_merge(const MergeArguments& arguments) {
    const auto plan = output::read_plan(arguments.folder);
    if (!plan)
        bad_input(fmt::format("merge: {}: has no {}; expected a folder that --tiles has made",
                              printable(arguments.folder), output::kPlanFile));
    if (!arguments.base.empty() && arguments.stac.empty()) bad_usage("--href-base: needs --stac");
    if (arguments.base.starts_with("file:") && !path_of_file_uri(arguments.base))
        bad_usage(fmt::format("--href-base: {}: expected file:/// and an absolute path",
                              printable(arguments.base)));
    FilesInUse files;
    files.add_input(fs::path(arguments.folder) / output::kPlanFile, "the plan");
    std::vector<OutputFile*> results;
    const auto open = [&](const std::string& path, const char* who) -> OutputFile* {
        if (path.empty()) return nullptr;
        results.push_back(&files.open_output(path, arguments.overwrite, who));
        return results.back();
    };
    OutputFile* const vrt = open(arguments.output, "-o");
    OutputFile* const stac = open(arguments.stac, "--stac");
    for (const OutputFile* const result : results)
        for (const output::PlannedTile& tile : plan->tiles)
            if (result->replaces(fs::path(arguments.folder) / tile.name))
                bad_input(fmt::format("{}: {}: is a tile; choose another name", result->who(),
                                      printable(result->path().string())));
    const std::vector<output::PlannedTile> tiles = whole_tiles(arguments, *plan);
    if (vrt) vrt->write(output::mosaic_text(arguments.output, arguments.folder, *plan, tiles));
    if (stac)
        stac->write(
            output::stac_text(arguments.stac, arguments.folder, arguments.base, *plan, tiles));
    OutputFile::finish_all(results);
    log::info(fmt::format("{} of {} tiles are there, of {}", tiles.size(), plan->tiles.size(),
                          printable(plan->command)));
}

}  // namespace

void add_merge(Verb app) {
    const auto arguments = std::make_shared<MergeArguments>();
    const Verb verb =
        app.add_verb("merge", "Checks the tiles of a folder; a VRT and a STAC collection of them");
    verb.add_option("FOLDER", arguments->folder, "Folder that --tiles has filled").required();
    verb.add_option("-o,--output", arguments->output, "VRT to write, over all tiles");
    verb.add_option("--stac", arguments->stac, "STAC ItemCollection to write, JSON");
    verb.add_option("--href-base", arguments->base,
                    "Where the collection says that the tiles are, a URL or a folder; default: "
                    "names relative to the collection");
    verb.add_flag("--overwrite", arguments->overwrite, "Replace existing files");
    verb.add_flag("--allow-missing", arguments->allow_missing,
                  "Write them over the tiles that are there");
    verb.callback([arguments] { run_merge(*arguments); });
}

}  // namespace relevo::cli

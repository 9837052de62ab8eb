#include "cli/tile_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/allocation.h"
#include "base/contains.h"
#include "base/error.h"
#include "base/sha256.h"
#include "base/text.h"
#include "cli/shard.h"
#include "cli/shared.h"
#include "output/tile_check.h"

namespace relevo::cli {
namespace {

namespace fs = std::filesystem;

/// Options that change no figure, and those of `relevo plan`.
bool is_of_this_run(const GivenOption& option) {
    constexpr std::array<std::string_view, 12> kOfThisRun{
        "DEM",      "--output", "--overwrite", "--shard", "--resume",       "--dry-run",
        "--memory", "--slurm",  "--parallel",  "--cpus",  "--task-minutes", "--most-tasks"};
    return contains(kOfThisRun, option.name);
}

std::string text_of(const GivenOption& option) {
    if (option.is_flag) return option.name;
    std::string text = option.name + "=";
    for (std::size_t i = 0; i < option.values.size(); ++i)
        text += (i > 0 ? "," : "") + option.values[i];
    return text;
}

/// That of a verb of `plan` is that of the verb itself.
std::string without_plan(std::string command) {
    constexpr std::string_view kPlan = "plan ";
    return command.starts_with(kPlan) ? command.substr(kPlan.size()) : command;
}

/// With what is known of the DEM.
std::string digest_of(const output::TilePlan& plan) {
    const dem::Statistics& found = plan.statistics;
    std::string text = plan.digest;
    for (const double number : plan.grid.affine().geotransform())
        text += fmt::format("\n{}", number);
    return sha256_of_text(text + fmt::format("\n{} {}\n{}\n{} {} {} {} {:016x}",
                                             plan.grid.columns(), plan.grid.rows(),
                                             plan.grid.crs().text(), found.min_m, found.max_m,
                                             found.valid, found.holes, plan.content));
}

std::string name_in(const fs::path& folder, const std::string& name) {
    return printable((folder / name).string());
}

}  // namespace

void TileArguments::add_to(Verb verb) {
    verb.add_option("--tiles", tiles,
                    "Write tiles into the folder that -o names, a GeoTIFF each: of N x N posts, or "
                    "those of an index, as gdaltindex and STAC have it")
        .type_name("N|INDEX")
        .group("Tiles");
    verb.add_option("--halo", halo_km,
                    "Posts only so many km around a tile, ground beyond as means, exact to 0.1 "
                    "degrees (all posts)")
        .check(in_range(0.1, 1000.0))
        .group("Tiles");
    verb.add_option("--shard", shard,
                    "Make one part of the tiles: I/N, or array in an array task of a scheduler")
        .group("Tiles");
    verb.add_flag("--resume", resume, "Keep tiles that are there, complete and of this command")
        .group("Tiles");
}

void TileArguments::check() const {
    if (!given() && !shard.empty()) bad_usage("--shard: needs --tiles");
    if (!given() && resume) bad_usage("--resume: needs --tiles");
    if (!given() && halo_km) bad_usage("--halo: needs --tiles");
}

std::vector<output::PlannedTile> TileArguments::of(const dem::Grid& grid, const dem::Window& window,
                                                   const std::string& crs) const {
    const auto side = parse_number(tiles);
    if (!side) return output::tiles_of_index(grid, window, tiles, crs);
    constexpr double kLeast = 64, kMost = 1 << 20;
    if (!(*side >= kLeast && *side <= kMost && *side == std::floor(*side)))
        bad_usage(fmt::format("--tiles: {}: expected a whole number from {} to {}, or an index",
                              tiles, kLeast, kMost));
    return output::tiles_of(grid, window, static_cast<int>(*side));
}

std::string TileArguments::description() const {
    return parse_number(tiles) ? fmt::format("of {0} x {0} posts", tiles)
                               : "of " + printable(tiles);
}

std::string meaning_of(const std::string& command, const std::vector<GivenOption>& given,
                       const output::RasterMetadata& metadata) {
    std::string text = "relevo " RELEVO_VERSION "\n" + without_plan(command) + "\n";
    for (const GivenOption& option : given)
        if (!is_of_this_run(option)) text += text_of(option) + "\n";
    for (const auto& [key, value] : metadata)
        text += key + "=" + value + "\n";
    return text;
}

std::string command_text(const std::string& command, const std::vector<GivenOption>& given) {
    std::string text = without_plan(command);
    for (const GivenOption& option : given)
        if (!is_of_this_run(option)) text += " " + text_of(option);
    return text;
}

std::optional<output::TilePlan> plan_of(const fs::path& folder, bool overwrite) {
    if (overwrite && contains(output::foreign_plan_files(folder), folder / output::kPlanFile))
        return std::nullopt;
    return output::read_plan(folder);
}

void check_plan_files(const fs::path& folder) {
    const std::vector<fs::path> foreign = output::foreign_plan_files(folder);
    if (!foreign.empty())
        bad_input(
            fmt::format("-o: {}: exists, and a plan of tiles needs its name; use another "
                        "folder, or pass --overwrite to replace it",
                        printable(foreign.front().string())));
}

TileFolder::TileFolder(fs::path folder, output::TilePlan plan, const TileArguments& arguments,
                       bool overwrite, bool is_plan)
    : folder_(std::move(folder)), plan_(std::move(plan)), overwrite_(overwrite) {
    plan_.digest = digest_of(plan_);
    std::error_code error;
    if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
        bad_input(fmt::format("-o: {}: is a file; with --tiles it is a folder",
                              printable(folder_.string())));
    const std::optional<output::TilePlan> found = plan_of(folder_, overwrite);
    if (!overwrite) check_plan(found);
    has_plan_ = found && found->digest == plan_.digest && found->tiles == plan_.tiles &&
                found->stamp == plan_.stamp;
    std::vector<output::PlannedTile> wanted = plan_.tiles;
    if (!arguments.shard.empty()) {
        const Shard shard = parse_shard(arguments.shard, environment_variable);
        const auto [first, end] = output::share_of(wanted.size(), shard.number, shard.count);
        wanted = {wanted.begin() + static_cast<std::ptrdiff_t>(first),
                  wanted.begin() + static_cast<std::ptrdiff_t>(end)};
    }
    take(wanted, arguments.resume || is_plan, is_plan);
}

void TileFolder::check_plan(const std::optional<output::TilePlan>& found) const {
    if (!found || (found->digest == plan_.digest && found->tiles == plan_.tiles)) return;
    bad_input(fmt::format(
        "-o: {}: is of {}; use another folder, or --overwrite", name_in(folder_, output::kPlanFile),
        found->command == plan_.command ? "another DEM, or of another version of relevo"
                                        : "another command, " + found->command));
}

/// @param keep     tiles that are whole
/// @param is_plan  its tasks replace nothing: what is to be replaced is removed with the plan
void TileFolder::take(const std::vector<output::PlannedTile>& wanted, bool keep, bool is_plan) {
    using State = output::TileOnDisk::State;
    const std::vector<output::TileOnDisk> found = output::tiles_on_disk(folder_, plan_, wanted);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto& [state, why] = found[i];
        if (keep && state == State::Whole) {
            ++there_;
            continue;
        }
        todo_.push_back(wanted[i]);
        if (state == State::Missing) continue;
        if (keep && state == State::Damaged) {
            replaced_.push_back(wanted[i].name);
            continue;
        }
        if (overwrite_) {
            if (is_plan) outdated_.push_back(wanted[i].name);
            continue;
        }
        bad_input(keep ? fmt::format("-o: {}: {}; pass --overwrite to replace it",
                                     name_in(folder_, wanted[i].name), why)
                       : fmt::format("-o: {}: exists; pass --overwrite to replace it, or --resume "
                                     "to make what is missing",
                                     name_in(folder_, wanted[i].name)));
    }
}

void TileFolder::write_plan(const dem::Posts& posts, const FarGround* far) const {
    make_folder_of(folder_ / output::kPlanFile, "-o");
    for (const std::string& name : outdated_)
        remove_result(folder_ / name);
    const bool has_heights = (posts.in_memory() || is_taken(folder_ / output::kPostsFile)) &&
                             (!far || is_taken(folder_ / output::kMeansFile)) &&
                             output::foreign_plan_files(folder_).empty();
    if (has_plan_ && has_heights) return;
    if (!posts.in_memory()) output::write_posts_facts(folder_, posts);
    if (far) far->write(folder_);
    output::write_plan(folder_, plan_);
}

bool TileFolder::is_whole(const output::PlannedTile& tile) const {
    return output::tile_on_disk(folder_, plan_, tile).state == output::TileOnDisk::State::Whole;
}

OutputFile TileFolder::open(const output::PlannedTile& tile, FilesInUse& files) const {
    return files.open_alone(folder_ / tile.name, overwrite_ || contains(replaced_, tile.name),
                            "-o");
}

}  // namespace relevo::cli

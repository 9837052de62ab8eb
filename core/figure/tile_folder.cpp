#include "figure/tile_folder.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/sha256.h"
#include "base/text.h"
#include "output/tile_check.h"

namespace relevo::figure {
namespace {

namespace fs = std::filesystem;

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

std::vector<output::PlannedTile> TileOptions::of(const dem::Grid& grid,
                                                 const dem::Window& window) const {
    const auto side = parse_number(tiles);
    if (!side) return output::tiles_of_index(grid, window, tiles, crs);
    constexpr double kLeast = 64, kMost = 1 << 20;
    if (!(*side >= kLeast && *side <= kMost && *side == std::floor(*side)))
        bad_usage(fmt::format("--tiles: {}: expected a whole number from {} to {}, or an index",
                              tiles, kLeast, kMost));
    return output::tiles_of(grid, window, static_cast<int>(*side));
}

std::string TileOptions::description() const {
    return parse_number(tiles) ? fmt::format("of {0} x {0} posts", tiles)
                               : "of " + printable(tiles);
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

TileFolder::TileFolder(fs::path folder, output::TilePlan plan, const TileOptions& options,
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
    const auto [first, end] = output::share_of(wanted.size(), options.shard, options.shards);
    wanted = {wanted.begin() + static_cast<std::ptrdiff_t>(first),
              wanted.begin() + static_cast<std::ptrdiff_t>(end)};
    take(wanted, options.resume || is_plan, is_plan);
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

}  // namespace relevo::figure

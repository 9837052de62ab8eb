#include "output/tile_plan.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/local_copy.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/sha256.h"
#include "base/text.h"
#include "dem/clip.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/tile_index.h"
#include "output/raster_writer.h"

// Rejected: reading a tile with a halo around it and no more, whose edge would count as the edge
// of the ground; messages between processes; and lists of finished tiles, which are wrong after a
// crash.
namespace relevo::output {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::int64_t kMostTiles = 10'000'000;
constexpr int kVersion = 1;  // of the file
constexpr const char *kVersionKey = "relevo_plan", *kHeightsKey = "RELEVO_PLAN";
constexpr std::array<const char*, 2> kGeoTiff = {"GTiff", nullptr};

Json json_of(const dem::Window& window) {
    return {window.column, window.row, window.columns, window.rows};
}

/// A whole number that T holds. The library would convert others to any number.
/// @throws std::exception, here and below, for what is damaged
template <typename T>
T whole(const Json& json) {
    const bool fits = json.is_number_unsigned()
                          ? std::in_range<T>(json.get<std::uint64_t>())
                          : json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
    if (!fits) throw std::out_of_range("expected a whole number");
    return json.get<T>();
}

/// A window of a grid, which has posts.
dem::Window window_of(const Json& json, const dem::Grid& grid) {
    const dem::Window window{whole<int>(json.at(0)), whole<int>(json.at(1)), whole<int>(json.at(2)),
                             whole<int>(json.at(3))};
    if (window.column < 0 || window.row < 0 || window.is_empty() ||
        window.columns > grid.columns() - window.column || window.rows > grid.rows() - window.row)
        throw std::out_of_range("expected posts of the grid");
    return window;
}

dem::Grid grid_of(const Json& dem, const std::string& name) {
    const int columns = whole<int>(dem.at("size").at(0)), rows = whole<int>(dem.at("size").at(1));
    const std::array<double, 6> transform = dem.at("geotransform");
    if (columns <= 0 || rows <= 0) throw std::out_of_range("expected posts");
    return {columns, rows, dem::Affine::of_geotransform(transform),
            geo::Crs::parse(dem.at("crs").get<std::string>(), name)};
}

Json json_of(const dem::NamedTiles& tiles) {
    return {{"count", tiles.count}, {"first", tiles.first}};
}

dem::NamedTiles named_of(const Json& json) {
    return {.count = whole<std::int64_t>(json.at("count")), .first = json.at("first")};
}

Json json_of(const TilePlan& plan) {
    Json tiles = Json::array();
    for (const PlannedTile& tile : plan.tiles)
        tiles.push_back({tile.name, json_of(tile.window)});
    const dem::Statistics& found = plan.statistics;
    return {{kVersionKey, kVersion},
            {"command", plan.command},
            {"digest", plan.digest},
            {"dem",
             {{"files", plan.dems},
              {"size", {plan.grid.columns(), plan.grid.rows()}},
              {"geotransform", plan.grid.affine().geotransform()},
              {"crs", plan.grid.crs().text()},
              {"lowest_m", found.min_m},
              {"highest_m", found.max_m},
              {"posts_with_height", found.valid},
              {"voids", found.holes},
              {"outliers", found.outliers},
              {"content", fmt::format("{:016x}", plan.content)},
              {"tiles", plan.dem_tiles.tiles},
              {"missing", json_of(plan.dem_tiles.missing)},
              {"broken", json_of(plan.dem_tiles.broken)},
              {"stamp", plan.stamp}}},
            {"tiles", tiles}};
}

/// Whether it is the name of a file of the plan's folder, and of no other.
bool is_plain_name(const std::string& name) {
    return name.ends_with(".tif") && name.find_first_of(std::string_view("/\0", 2)) == name.npos;
}

TilePlan plan_of(const Json& json, const std::string& name) {
    const Json& dem = json.at("dem");
    TilePlan plan{.command = json.at("command"),
                  .digest = json.at("digest"),
                  .dems = dem.at("files"),
                  .grid = grid_of(dem, name),
                  .statistics = {.min_m = dem.at("lowest_m"),
                                 .max_m = dem.at("highest_m"),
                                 .valid = whole<std::int64_t>(dem.at("posts_with_height")),
                                 .holes = whole<std::int64_t>(dem.at("voids")),
                                 .outliers = whole<std::int64_t>(dem.at("outliers"))},
                  .content = std::stoull(dem.at("content").get<std::string>(), nullptr, 16),
                  .dem_tiles = {.tiles = whole<std::int64_t>(dem.at("tiles")),
                                .missing = named_of(dem.at("missing")),
                                .broken = named_of(dem.at("broken"))},
                  .stamp = dem.at("stamp"),
                  .tiles = {}};
    for (const Json& tile : json.at("tiles")) {
        plan.tiles.push_back({tile.at(0), window_of(tile.at(1), plan.grid)});
        if (!is_plain_name(plan.tiles.back().name))
            bad_input(
                fmt::format("{}: a tile has the name \"{}\", expected that of a file of its "
                            "folder; use another folder",
                            name, printable(plan.tiles.back().name)));
    }
    return plan;
}

/// Every thinning-th post of a grid.
dem::Grid thinned_grid(const dem::Posts& posts, const Array2d<float>& thinned_m) {
    dem::Affine affine = posts.grid().affine();
    const int step = posts.thinning();
    affine.x_column *= step, affine.y_column *= step;
    affine.x_row *= step, affine.y_row *= step;
    return {thinned_m.width(), thinned_m.height(), affine, posts.grid().crs()};
}

/// The posts of a window that are in a rectangle, if there are any.
std::optional<dem::Window> window_within(const dem::Grid& grid, const dem::Clip& clip,
                                         const dem::Window& window) {
    try {
        const dem::Window found = common(dem::window_of(grid, clip, "--tiles"), window);
        return found.is_empty() ? std::nullopt : std::optional(found);
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Whether a file begins as write_plan() has it begin.
bool is_plan(const fs::path& path) {
    constexpr std::size_t kHead = 64;
    std::string head(kHead, '\0');
    const LocalCopy copy(path, "plan");
    InputStream file = input_stream(AllowedName(copy.path().string()));
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    return head.find(kVersionKey) != std::string::npos;
}

/// A file of write_heights(); null for others.
dem::Dataset open_heights(const fs::path& path) {
    dem::prepare_gdal();
    const dem::GdalMessages messages;
    dem::Dataset dataset =
        dem::open_by_gdal(AllowedName(path.string()), GDAL_OF_RASTER, kGeoTiff.data());
    if (dataset && !GDALGetMetadataItem(dataset.get(), kHeightsKey, nullptr)) dataset.reset();
    return dataset;
}

/// Has all of a folder's files follow one rule: what this program has made for itself is replaced.
OutputFile own_file(const fs::path& path) {
    return {path, /*overwrite=*/true, "plan"};
}

}  // namespace

std::vector<PlannedTile> tiles_of(const dem::Grid& grid, const dem::Window& window, int side) {
    const auto count = [side](int posts) { return (posts - 1) / side + 1; };
    const int columns = count(grid.columns()), rows = count(grid.rows());
    if (std::int64_t{columns} * rows > kMostTiles)
        bad_input(fmt::format(
            "--tiles: {}: makes {} tiles of a DEM of {} x {} posts; expected at "
            "most {}",
            side, std::int64_t{columns} * rows, grid.columns(), grid.rows(), kMostTiles));
    const auto digits = std::to_string(std::max({columns, rows, 1000})).size();
    std::vector<PlannedTile> tiles;
    for (int row = window.row / side; row <= (window.end_row() - 1) / side; ++row)
        for (int column = window.column / side; column <= (window.end_column() - 1) / side;
             ++column)
            tiles.push_back(
                {fmt::format("r{:0{}}_c{:0{}}.tif", row + 1, digits, column + 1, digits),
                 common(window, {column * side, row * side, side, side})});
    return tiles;
}

std::vector<PlannedTile> tiles_of_index(const dem::Grid& grid, const dem::Window& window,
                                        const std::string& path, const std::string& crs) {
    const dem::TileIndex index = dem::read_tile_index(path, crs);
    std::vector<PlannedTile> tiles;
    std::set<std::array<int, 4>> windows;  // of these
    std::size_t repeated = 0;
    for (const dem::IndexedTile& tile : index.tiles) {
        const dem::Extent& box = tile.extent;
        dem::Clip clip{box.west, box.south, box.east, box.north, std::nullopt, tile.name};
        if (tile.crs >= 0 && index.crs[std::size_t(tile.crs)].text() != grid.crs().text())
            clip.crs = index.crs[std::size_t(tile.crs)];
        const std::optional<dem::Window> posts = window_within(grid, clip, window);
        if (!posts) continue;
        if (tile.name + ".tif" == kPostsFile || tile.name + ".tif" == kMeansFile)
            bad_input(
                fmt::format("--tiles: {}: a tile has the name \"{}\", which is taken; rename "
                            "it",
                            printable(path), tile.name));
        if (!windows.insert({posts->column, posts->row, posts->columns, posts->rows}).second) {
            ++repeated;
            continue;
        }
        tiles.push_back({tile.name + ".tif", *posts});
    }
    if (tiles.empty())
        bad_input(fmt::format("--tiles: {}: no tile has a post of the DEM", printable(path)));
    if (repeated > 0)
        log::info(fmt::format(
            "--tiles: {}: {} tiles have the outline of an earlier one, and are not made again",
            printable(path), repeated));
    return tiles;
}

std::pair<std::size_t, std::size_t> share_of(std::size_t count, std::size_t number,
                                             std::size_t shares) {
    return {count * (number - 1) / shares, count * number / shares};
}

std::string stamp_of(const std::vector<std::string>& files) {
    std::string text;
    for (const std::string& file : files) {
        struct stat found {};
        text += file;
        if (stat(file.c_str(), &found) == 0)
            text += fmt::format("\n{} {}.{:09}", found.st_size, found.st_mtim.tv_sec,
                                found.st_mtim.tv_nsec);
        text += '\n';
    }
    return sha256_of_text(text);
}

std::vector<fs::path> plan_files(const fs::path& folder) {
    return {folder / kPlanFile, folder / kPostsFile, folder / kMeansFile};
}

std::vector<fs::path> foreign_plan_files(const fs::path& folder) {
    std::vector<fs::path> foreign;
    for (const fs::path& path : plan_files(folder)) {
        if (!is_taken(path)) continue;
        if (!(path.filename() == kPlanFile ? is_plan(path) : open_heights(path) != nullptr))
            foreign.push_back(path);
    }
    return foreign;
}

std::optional<TilePlan> read_plan(const fs::path& folder) {
    const fs::path path = folder / kPlanFile;
    const LocalCopy copy(path, "plan");
    InputStream file = input_stream(AllowedName(copy.path().string()));
    if (!file) return std::nullopt;
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::string name = "plan: " + printable(path.string());
    const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object() || !json.contains(kVersionKey))
        bad_input(name + ": is no plan of relevo; use another folder");
    if (json.at(kVersionKey) != kVersion)
        bad_input(name + ": is of another version of relevo; use another folder");
    try {
        return plan_of(json, name);
    } catch (const Error&) {
        throw;
    } catch (const std::exception&) {
        bad_input(name + ": is damaged; remove it, and plan again");
    }
}

void write_plan(const fs::path& folder, const TilePlan& plan) {
    OutputFile file = own_file(folder / kPlanFile);
    file.write(json_of(plan).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    file.finish();
}

std::optional<Array2d<float>> read_heights(const fs::path& file) {
    const std::string path = file.string();
    const dem::Dataset dataset = is_taken(file) ? open_heights(file) : nullptr;
    if (!dataset) return std::nullopt;
    const dem::GdalMessages messages;
    Array2d<float> height_m(GDALGetRasterXSize(dataset.get()), GDALGetRasterYSize(dataset.get()));
    if (GDALRasterIO(GDALGetRasterBand(dataset.get(), 1), GF_Read, 0, 0, height_m.width(),
                     height_m.height(), height_m.data(), height_m.width(), height_m.height(),
                     GDT_Float32, 0, 0) != CE_None)
        bad_input(fmt::format("plan: {}: cannot be read, {}; remove it, and plan again",
                              printable(path), messages.failure(path)));
    return height_m;
}

void write_heights(const fs::path& path, const dem::Grid& grid, const Array2d<float>& height_m,
                   const std::string& definition) {
    OutputFile file = own_file(path);
    RasterWriter writer(file, grid, RasterType::Float, {{"height", "m"}});
    writer.put(0, 0, 0, height_m);
    writer.finish({{"DEFINITION", definition}, {kHeightsKey, "1"}});
}

std::optional<dem::PostsFacts> read_posts_facts(const fs::path& folder, const TilePlan& plan) {
    std::optional<Array2d<float>> thinned_m = read_heights(folder / kPostsFile);
    if (!thinned_m) return std::nullopt;
    return dem::PostsFacts{plan.statistics, std::move(*thinned_m), plan.content, plan.dem_tiles};
}

void write_posts_facts(const fs::path& folder, const dem::Posts& posts) {
    const dem::PostsFacts facts = posts.facts();
    write_heights(folder / kPostsFile, thinned_grid(posts, facts.thinned_m), facts.thinned_m,
                  fmt::format("every {}th post of the DEM, each way, from the first on; for the "
                              "tasks of this folder",
                              posts.thinning()));
}

}  // namespace relevo::output

#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "dem/collar.h"
#include "dem/level_cache.h"
#include "dem/load.h"
#include "dem/surface.h"
#include "render/ground.h"
#include "session/session.h"
#include "session/stopwatch.h"

namespace relevo::session {
namespace {

using Voids = dem::Pyramid::Voids;

/// The ground within a collar; nullopt where there is none, or where it is to stay.
std::optional<dem::Heightfield> within_collar(const dem::Heightfield& field,
                                              const dem::LoadOptions& options) {
    if (field.reduction > 1 || options.no_nodata) return std::nullopt;
    const std::optional<dem::Collar> collar = dem::find_collar(field.height_m);
    if (!collar) return std::nullopt;
    dem::Heightfield ground{dem::without_collar(field.height_m, *collar), field.grid, field.about};
    ground.about.statistics = dem::statistics(ground.height_m);
    if (ground.about.statistics.valid == 0) return std::nullopt;
    log::info(fmt::format("{}: pictures leave this edge out; --nodata none draws it",
                          printable(field.about.path)));
    return ground;
}

/// @param known  water that was found before; null: it is found
LoadedDem::Drawn drawn_of(const dem::Heightfield& field, const scene::Scene& scene,
                          dem::Water* known) {
    LoadedDem::Drawn drawn;
    std::optional<dem::Heightfield> within = within_collar(field, scene.dem);
    drawn.has_no_collar = within.has_value();
    const dem::Heightfield& given = within ? *within : field;
    if (given.about.statistics.holes > 0) {
        dem::FilledHoles filled =
            dem::fill_small_holes(given.height_m, scene.holes, dem::ThinGround::Dropped);
        drawn.holes_text = filled.text(scene.holes);
        drawn.has_covers = filled.covered_posts > 0;
        if (!filled.height_m.empty()) {
            drawn.filled.emplace(dem::Heightfield{std::move(filled.height_m), given.grid,
                                                  given.about, given.reduction});
            drawn.is_filled = std::move(filled.filled);
        }
    }
    if (within && !drawn.filled) drawn.filled = std::move(within);
    drawn.water =
        known ? std::move(*known)
              : dem::find_water(drawn.filled ? drawn.filled->height_m : field.height_m, field.grid);
    drawn.has_houses =
        dem::looks_like_surface(drawn.filled ? drawn.filled->height_m : field.height_m, field.grid);
    return drawn;
}

/// DEMs with more posts first get a preview; number of its posts.
constexpr std::int64_t kManyPosts = std::int64_t{1} << 24, kPreviewPosts = std::int64_t{1} << 22;

/// Greatest magnitude of drawable heights [m], so that the ground fits on the Earth.
constexpr double kMostHeight_m = 2e6;

void check_heights(const dem::Description& about) {
    const dem::Statistics& s = about.statistics;
    if (s.min_m >= -kMostHeight_m && s.max_m <= kMostHeight_m) return;
    bad_input(
        fmt::format("{}: heights of {:g} to {:g} m cannot be drawn, expected {:g} to {:g} m; "
                    "--unit sets the unit, --nodata V marks voids",
                    about.path, s.min_m, s.max_m, -kMostHeight_m, kMostHeight_m));
}

/// @param known  what an earlier run has found; null: it is computed
std::shared_ptr<LoadedDem> loaded_dem(std::shared_ptr<const dem::Source> source,
                                      dem::Heightfield field, const scene::Scene& scene,
                                      dem::Levels* known = nullptr) {
    auto dem = std::make_shared<LoadedDem>(
        LoadedDem{.source = std::move(source), .field = std::move(field)});
    dem->drawn = drawn_of(dem->field, scene, known ? &known->water : nullptr);
    dem->pyramid.emplace(
        dem::Pyramid::of(dem->to_draw(), dem->source.get(), scene.dem.memory,
                         scene.holes == dem::Holes::Cut ? Voids::Kept : Voids::Filled,
                         known ? &known->bounds : nullptr));
    return dem;
}

/// The cache, which keeps large DEMs of which only means are in memory.
dem::LevelCache cache_of(const dem::Source& source, int reduction, const scene::Scene& scene) {
    dem::LoadOptions options = scene.dem;
    const std::int64_t posts = std::int64_t{source.grid().columns()} * source.grid().rows();
    options.cached = options.cached && reduction > 1 && posts >= dem::LevelCache::kLeastPosts;
    return {source.opened_files(), scene.dems, options, scene.holes, dem::user_level_cache()};
}

}  // namespace

std::shared_ptr<const LoadedDem> load_dem(std::shared_ptr<const dem::Source> source,
                                          const scene::Scene& scene) {
    const auto began = Clock::now();
    const dem::Grid& grid = source->grid();
    const MemoryBudget memory = scene.dem.memory.for_pictures();
    const int reduction = dem::reduction_of(grid, memory);
    const dem::LevelCache cache = cache_of(*source, reduction, scene);
    std::optional<dem::Levels> known = cache.read(grid, reduction);
    dem::Heightfield field =
        dem::load(*source, memory, known ? std::move(known->height_m) : Array2d<float>());
    dem::check_heights(field, scene.dem);
    check_heights(field.about);
    auto dem = loaded_dem(std::move(source), std::move(field), scene, known ? &*known : nullptr);
    // What is wrong with tiles is only found by reading them.
    if (!known && !dem->source->tiles().has_faults())
        cache.write(dem->field, *dem->pyramid, dem->drawn.water);
    dem->took_ms = milliseconds_since(began);
    return dem;
}

std::shared_ptr<const LoadedDem> load_preview(std::shared_ptr<const dem::Source> source,
                                              const scene::Scene& scene) {
    const auto began = Clock::now();
    const dem::Grid& grid = source->grid();
    if (std::int64_t{grid.columns()} * grid.rows() <= kManyPosts) return nullptr;
    const int reduction = dem::reduction_of(grid, scene.dem.memory.for_pictures());
    if (cache_of(*source, reduction, scene).has(reduction)) return nullptr;
    std::optional<dem::Heightfield> field = dem::load_quickly(*source, kPreviewPosts);
    if (!field || dem::is_refused(*field, scene.dem)) return nullptr;
    auto dem = loaded_dem(std::move(source), std::move(*field), scene);
    dem->is_preview = true;
    dem->took_ms = milliseconds_since(began);
    return dem;
}

render::Ground ground_of(const LoadedDem& dem) {
    render::Ground ground = render::make_ground(dem.to_frame(), dem.source->grid());
    ground.sea_floor_share = dem.drawn.water.sea_floor_share();
    ground.sea_rim_share = dem.drawn.water.sea_rim_share();
    return ground;
}

double LoadedDem::height_m(const geo::Geodetic& at) const {
    if (field.reduction > 1) return source->height_at(at);
    const glm::dvec2 post = field.grid.post(at);
    return field.height_at(post.x, post.y);
}

std::vector<std::string> LoadedDem::ground_words(dem::Holes holes) const {
    std::vector<std::string> words;
    if (drawn.water.any()) words.emplace_back("water");
    if (holes == dem::Holes::Mark && !drawn.is_filled.empty()) words.emplace_back("marked_holes");
    if (drawn.has_covers) words.emplace_back("covered_voids");
    return words;
}

}  // namespace relevo::session

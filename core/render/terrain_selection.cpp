#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "render/ground_in_view.h"
#include "render/ground_probe.h"
#include "render/pages.h"
#include "render/terrain.h"
#include "render/tile_grid.h"

namespace relevo::render {
namespace {

/// How many times the wanted tolerance may be, at most, to save vertices. Rings of tiles around the
/// eye, one for each level, are left beyond: with less than these all detail would be lost at once.
constexpr double kMostCoarser = 3;

}  // namespace

int TileSelection::finest_level() const {
    int finest = tiles_.empty() ? 0 : tiles_.front().draw.key.level;
    for (const Tile& tile : tiles_)
        finest = std::min(finest, tile.draw.key.level);
    return finest;
}

double TileSelection::nearest_m() const {
    double nearest_m = tiles_.empty() ? 0 : tiles_.front().draw.distance_m;
    for (const Tile& tile : tiles_)
        nearest_m = std::min(nearest_m, tile.draw.distance_m);
    return nearest_m;
}

bool Terrain::sees_ground(const TileSelection& selection, const LodView& view) {
    return std::ranges::any_of(selection.tiles_, [&](const TileSelection::Tile& tile) {
        const double morph_start_m = tile.per_morph_m > 0 ? double{tile.morph_start_m}
                                                          : std::numeric_limits<double>::infinity();
        return !view.eye_m || view.sees_beyond_limb ||
               is_ground_in_view(pyramid_, tile.draw, tree_.net(tile.draw.key), morph_start_m,
                                 tree_.displacement(), view);
    });
}

/// @param first, last  posts of the box
bool Terrain::is_detailed(const Box& box, const glm::ivec2& first, const glm::ivec2& last,
                          const DetailedGround& detailed) {
    const double nearest_m = box.distance(detailed.eye_m);
    if (nearest_m < detailed.near_m) return true;
    const dem::Water* const water = options_.water ? options_.water
                                    : own_water_   ? &*own_water_
                                                   : nullptr;
    if (!water || !water->any()) return false;
    if (!wet_posts_) wet_posts_.emplace(water->kind);
    const double farthest_m = nearest_m + length(box.high - box.low);
    const double reach = std::min(std::ceil(farthest_m * detailed.water_posts_per_m) + 2, 1e6);
    const auto grown = static_cast<int>(reach);
    return wet_posts_->any((first - grown) / reduction_, (last + grown) / reduction_);
}

std::vector<Box> Terrain::boxes(const TileSelection& selection, const DetailedGround& detailed) {
    constexpr int kWindows = 8;  // of a tile, along either side
    std::vector<Box> found;
    for (const TileSelection::Tile& tile : selection.tiles_) {
        const TileKey& key = tile.draw.key;
        const int quad = 1 << key.level, side = kTileQuads * quad / kWindows;
        const glm::ivec2 first = key.at * (kTileQuads * quad);
        // A vertex may have a height from the posts beside its own: of a mean, or while it morphs.
        const auto box_between = [&](const glm::ivec2& from, const glm::ivec2& to) {
            return tree_.box(glm::dvec2(from - 2 * quad), glm::dvec2(to + 2 * quad),
                             detailed.exaggeration);
        };
        const glm::ivec2 last = first + kWindows * side;
        const auto whole = box_between(first, last);
        if (!whole || !is_detailed(*whole, first, last, detailed)) continue;
        for (int i = 0; i < kWindows * kWindows; ++i) {
            const glm::ivec2 from = first + side * glm::ivec2(i % kWindows, i / kWindows);
            const auto box = box_between(from, from + side);
            if (box && is_detailed(*box, from, from + side, detailed)) found.push_back(*box);
        }
    }
    return found;
}

bool Terrain::in_budget(const LodView& wanted, double tolerance,
                        const std::vector<TileDraw>& draws) const {
    return tolerance >= kMostCoarser * wanted.tolerance ||
           static_cast<double>(draws.size() * kGridVertices) <=
               wanted.frames * options_.vertex_budget;
}

TileSelection Terrain::select_below(const FrameInputs& inputs, const glm::ivec2& picture_px) {
    const double exaggeration = inputs.exaggeration;
    const double pixel_error = this->pixel_error(exaggeration);
    const double tolerance = tolerance_in_budget(view_of(inputs, picture_px));
    scene::Camera vertical =
        GroundProbe::camera_below(inputs.camera, frame_, tolerance, pixel_error);
    LodView view = LodView::of_camera(vertical, 1, 1, pixel_error, exaggeration);
    // Includes coarser ancestors, which Loading::Background requires.
    std::vector<TileKey> keys;
    const auto is_there = [](const TileKey&) { return true; };
    std::vector<TileDraw> draws = tree_.select(view, TileTree::Resident{is_there, keys});
    if (draws.empty()) {  // the eye is below all ground
        vertical.forward = -vertical.forward;
        view = LodView::of_camera(vertical, 1, 1, pixel_error, exaggeration);
        draws = tree_.select(view, TileTree::Resident{is_there, keys});
    }
    heights_.require(keys);
    update_surface_layers();
    prepare_surface(LodView::of_camera(vertical, 1, 1, 1, exaggeration), Loading::Wait,
                    inputs.deterministic);
    return ready(view, draws);
}

}  // namespace relevo::render

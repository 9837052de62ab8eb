#include "render/overlay_pages.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "base/log.h"
#include "render/pages.h"

namespace relevo::render {
namespace {

/// Factor of the angle of a pixel between attempts.
constexpr double kCoarserPixel = 1.2;
/// Pixels are measured by depth, which is less than distance in the corners of the frame.
constexpr double kCorner = 0.7;

glm::ivec2 pages_of(const OverlayTexels& texels, int level) {
    const int side = kNormalNodes << level;
    return glm::max((texels.count - 1 + side - 1) / side, glm::ivec2(1));
}

int pages_of_all_levels(const OverlayTexels& texels) {
    double sum = 0;
    for (int level = 0; level < texels.levels; ++level) {
        const glm::dvec2 count(pages_of(texels, level));
        sum += count.x * count.y;
    }
    return static_cast<int>(std::min(sum, 1e6));
}

}  // namespace

OverlayPages::OverlayPages(std::shared_ptr<const OverlayRaster> raster, const dem::Pyramid& pyramid,
                           double spacing_m, int slots, std::string name)
    : name_(std::move(name)),
      overlay_(std::move(raster)),
      pyramid_(pyramid),
      texels_(overlay_texels(*overlay_, pyramid)) {
    if (overlay_->photo &&
        glm::any(glm::lessThan(texels_.per_post, overlay_->photo->pixels_per_post())))
        log::info(fmt::format(
            "{}: it has more than 262144 pixels along a side, the limit; it is drawn coarser",
            name_));
    texel_m_ = spacing_m / std::sqrt(texels_.per_post.x * texels_.per_post.y);
    const glm::ivec2 finest = pages_of(texels_, 0);
    table_ = PageTable(std::max(finest.x, finest.y), "overlay table");
    const auto make = [this](const TileKey& key) {
        return overlay_->values.empty()
                   ? bytes_of(overlay_page(*overlay_, pyramid_, key.level, key.at))
                   : bytes_of(value_page(*overlay_, pyramid_, key.level, key.at));
    };
    const gl::Format format = overlay_->values.empty() ? gl::Format::RGBA8 : gl::Format::RG32F;
    cache_ = PageCache({{name_ + "_pages", format, kNormalPage_px, gl::Filter::Linear, make}},
                       std::min(slots, pages_of_all_levels(texels_)));
}

/// Adds the visible pages of a page, from coarse to fine as far as a view shows them.
/// @param angle  of a pixel [rad]
void OverlayPages::visit(TileTree& tree, const LodView& view, double angle, const TileKey& key,
                         std::vector<TileKey>& pages) const {
    const glm::dvec2 low(key.at * (kNormalNodes << key.level));
    const glm::dvec2 first = texels_.first_post + low / texels_.per_post;
    const glm::dvec2 last = first + double(kNormalNodes << key.level) / texels_.per_post;
    if (!view.has_posts(first, last)) return;
    const std::optional<Box> box = tree.box(first, last, view.exaggeration);
    if (!box || tree.hidden(*box, view)) return;
    pages.push_back(key);
    const double distance_m = view.eye_m ? box->distance(*view.eye_m) : 0;
    if (key.level == 0 || kCorner * distance_m * angle >= texel_m_ * std::exp2(key.level)) return;
    const glm::ivec2 count = pages_of(texels_, key.level - 1);
    for (int q = 0; q < 4; ++q) {
        const glm::ivec2 at = 2 * key.at + glm::ivec2(q & 1, q >> 1);
        if (at.x < count.x && at.y < count.y) visit(tree, view, angle, {key.level - 1, at}, pages);
    }
}

bool OverlayPages::prepare(TileTree& tree, const LodView& view, Loading loading,
                           bool deterministic) {
    std::vector<TileKey> pages;
    for (double angle = view.tolerance;; angle *= kCoarserPixel) {
        pages.clear();
        visit(tree, view, angle, {texels_.levels - 1, {0, 0}}, pages);
        if (static_cast<int>(pages.size()) <= cache_.slots()) break;
    }
    const bool came = cache_.load(pages, loading);
    if (came || deterministic || table_is_narrowed_)
        table_.write(cache_, deterministic ? &pages : nullptr);
    table_is_narrowed_ = deterministic;
    return std::ranges::all_of(pages, [&](const TileKey& key) { return cache_.slot(key) >= 0; });
}

const gl::Texture* OverlayPages::texture(std::string_view name) const {
    if (!name.starts_with(name_)) return nullptr;
    return name.substr(name_.size()) == "_table" ? &table_.texture() : cache_.find(name);
}

}  // namespace relevo::render

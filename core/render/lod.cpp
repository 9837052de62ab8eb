#include "render/lod.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "geo/ellipsoid.h"
#include "render/pages.h"
#include "scene/map_view.h"

namespace relevo::render {
namespace {

using geo::kEquatorialRadius_m;
using geo::kFlattening;

/// Start of morphing as a fraction of a level's range (Strugar, section 4.2).
constexpr double kMorphStart = 0.66;

/// Fraction of tiles whose error determines a level's range. The others are spikes and cliffs,
/// which exceed any range.
constexpr double kVouchedShare = 0.98;

/// Error of a level, in RMS distances from the posts.
constexpr double kSigmas = 4;

/// Error of the biquadratic proxy grid over a tile of side s on a sphere of radius R, in s^3 / R^2:
/// interpolation of a sine at three points along both axes, plus a margin for the projection.
constexpr double kNetError = 0.03;

}  // namespace

double Box::distance(const glm::dvec3& point) const {
    return length(glm::max(glm::max(low - point, point - high), glm::dvec3(0)));
}

bool Box::outside(std::span<const glm::dvec4> planes) const {
    for (const glm::dvec4& plane : planes) {
        const glm::dvec3 n(plane);
        const glm::dvec3 farthest(n.x > 0 ? high.x : low.x, n.y > 0 ? high.y : low.y,
                                  n.z > 0 ? high.z : low.z);
        if (dot(n, farthest) + plane.w < 0) return true;
    }
    return false;
}

LodView LodView::of_camera(const scene::Camera& camera, int width_px, int height_px,
                           double pixel_error, double exaggeration) {
    LodView view;
    const double frames = std::max(1.0, double{1} * width_px * height_px / kFrame_px);
    if (camera.map) {
        const glm::dvec2 sides = camera.map->size_px();
        const double pixel =
            2 * std::tan(camera.fov_y_rad / 2) * std::sqrt(camera.map_aspect / (sides.x * sides.y));
        view.eye_m = camera.eye_m;
        view.tolerance = pixel_error * pixel;
        view.exaggeration = exaggeration;
        view.sees_beyond_limb = true;
        view.frames = frames;
        return view;
    }
    const double tan_y = std::tan(camera.fov_y_rad / 2);
    const double tan_x = tan_y * width_px / height_px;
    const glm::dvec3 right = cross(camera.forward, camera.up);
    const auto plane = [&](const glm::dvec3& normal) {
        const glm::dvec3 n = normalize(normal);
        view.planes.emplace_back(n, -dot(n, camera.eye_m));
    };
    plane(camera.forward);
    plane(tan_x * camera.forward + right);
    plane(tan_x * camera.forward - right);
    plane(tan_y * camera.forward + camera.up);
    plane(tan_y * camera.forward - camera.up);
    view.eye_m = camera.eye_m;
    view.tolerance = pixel_error * 2 * tan_y / height_px;
    view.exaggeration = exaggeration;
    view.frames = frames;
    return view;
}

bool LodView::has_posts(const glm::dvec2& first, const glm::dvec2& last) const {
    return !posts ||
           (first.x <= posts->z && first.y <= posts->w && last.x >= posts->x && last.y >= posts->y);
}

LodView LodView::around_camera(const scene::Camera& camera, int width_px, int height_px,
                               double pixel_error, double exaggeration) {
    constexpr double kPictures = 6;  // of a usual angle, in a panorama
    LodView view = of_camera(camera, width_px, height_px, pixel_error, exaggeration);
    view.planes.clear();
    view.frames = kPictures;
    return view;
}

TileTree::TileTree(const dem::Pyramid& pyramid, const dem::Grid& grid, const geo::LocalFrame& frame)
    : pyramid_(&pyramid), grid_(&grid), frame_(&frame) {
    earth_centre_m_ = frame.to_local({0, 0, -kEquatorialRadius_m});
    polar_axis_ = frame.up(kPi / 2, 0);

    // The widest spacing of geographic grids is nearest to the equator.
    constexpr int kSamples = 8;
    const glm::dvec2 last(grid.columns() - 1, grid.rows() - 1);
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i) {
            const glm::dvec2 at = glm::min(last * glm::dvec2(i, j) / double{kSamples}, last - 1.0);
            const auto point = [&](double column, double row) {
                return frame.to_local(grid.place(at.x + column, at.y + row));
            };
            const glm::dvec3 here = point(0, 0);
            longest_spacing_m_ = std::max(
                {longest_spacing_m_, length(point(1, 0) - here), length(point(0, 1) - here)});
        }
    }
    for (int level = 0; level < pyramid.levels(); ++level)
        error_m_.push_back(kSigmas *
                               pyramid.error_m(level, &dem::Pyramid::Bounds::rms_m, kVouchedShare) +
                           net_error_m(level));
    measure_relief();
}

void TileTree::measure_relief() {
    const dem::Pyramid::Bounds whole = pyramid_->bounds(pyramid_->levels() - 1, {0, 0});
    lowest_m_ = displacement_.range_m(whole.lowest_m, whole.highest_m).first;
    relief_m_.clear();
    for (int level = 0; level < pyramid_->levels(); ++level) {
        double relief_m = 0;
        const glm::ivec2 count = pyramid_->tiles(level);
        for (int y = 0; y < count.y; ++y) {
            for (int x = 0; x < count.x; ++x) {
                const dem::Pyramid::Bounds bounds = pyramid_->bounds(level, {x, y});
                if (bounds.empty()) continue;
                const auto [low, high] = displacement_.range_m(bounds.lowest_m, bounds.highest_m);
                relief_m = std::max(relief_m, high - low);
            }
        }
        relief_m_.push_back(relief_m);
    }
}

void TileTree::displace(const Displacement& displacement) {
    if (displacement == displacement_) return;
    displacement_ = displacement;
    for (auto& [key, node] : nodes_)
        node.exaggeration = -1;
    measure_relief();
}

double TileTree::net_error_m(int level) const {
    const double side_m = longest_spacing_m_ * (kTileQuads << level);
    return kNetError * side_m * side_m * side_m / (kEquatorialRadius_m * kEquatorialRadius_m);
}

TileTree::Node& TileTree::node(const TileKey& key) {
    const auto [found, is_new] = nodes_.try_emplace(key.packed());
    if (is_new) {
        const glm::ivec2 first = key.at * (kTileQuads << key.level);
        found->second.net = fit_patch_net(
            [this](double column, double row) { return grid_->place(column, row); }, *frame_,
            glm::dvec2(first), glm::dvec2(span_on_dem(*pyramid_, first, kTileQuads << key.level)));
    }
    found->second.frame = frames_;
    return found->second;
}

void TileTree::begin_frame() {
    if (nodes_.size() > kMostKept)
        std::erase_if(nodes_, [this](const auto& entry) { return entry.second.frame != frames_; });
    ++frames_;
}

const PatchNet& TileTree::net(const TileKey& key) {
    return node(key).net;
}

Box TileTree::box(const TileKey& key, double exaggeration) {
    Node& n = node(key);
    if (n.exaggeration == exaggeration) return n.box;
    n.box = box_of(key, {0, 0}, {1, 1}, exaggeration);
    n.exaggeration = exaggeration;
    return n.box;
}

/// @param from, to  parts of the tile's sides, 0 to 1
Box TileTree::box_of(const TileKey& key, const glm::dvec2& from, const glm::dvec2& to,
                     double exaggeration) {
    const PatchNet& net = node(key).net;
    const dem::Pyramid::Bounds bounds = pyramid_->bounds(key.level, key.at);
    const auto [low_m, high_m] = displacement_.range_m(bounds.lowest_m, bounds.highest_m);
    Box box{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    for (const double u : {from.x, 0.5 * (from.x + to.x), to.x}) {
        for (const double v : {from.y, 0.5 * (from.y + to.y), to.y}) {
            for (const double h : {low_m, high_m}) {
                const glm::dvec3 p = net.place(u, v, h * exaggeration);
                box.low = glm::min(box.low, p);
                box.high = glm::max(box.high, p);
            }
        }
    }
    // Between those points the proxy grid deviates by up to 1/16 of its second differences.
    const auto& p = net.position_m;
    const double bulge =
        (length(p[2]) + length(p[6]) + length(p[5]) + length(p[7]) + length(p[8])) / 16;
    const double margin = bulge + 0.01 + displacement_.aside_m;
    box.low -= margin;
    box.high += margin;
    return box;
}

std::optional<Box> TileTree::box(const glm::dvec2& first, const glm::dvec2& last,
                                 double exaggeration) {
    const double side = std::max(last.x - first.x, last.y - first.y);
    int level = 0;
    while (level + 1 < pyramid_->levels() && (kTileQuads << level) < side)
        ++level;
    const double tile = kTileQuads << level;
    const glm::ivec2 most = pyramid_->tiles(level) - 1;
    const glm::ivec2 low = glm::clamp(glm::ivec2(glm::floor(first / tile)), glm::ivec2(0), most),
                     high = glm::clamp(glm::ivec2(glm::floor(last / tile)), low, most);
    std::optional<Box> all;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            const TileKey key{level, {x, y}};
            if (pyramid_->bounds(level, key.at).empty()) continue;
            const glm::dvec2 span(
                span_on_dem(*pyramid_, key.at * (kTileQuads << level), kTileQuads << level));
            const auto share = [&](const glm::dvec2& post) {
                return glm::clamp((post - glm::dvec2(key.at) * tile) / glm::max(span, 1.0), 0.0,
                                  1.0);
            };
            const Box part = box_of(key, share(first), share(last), exaggeration);
            all = all ? Box{glm::min(all->low, part.low), glm::max(all->high, part.high)} : part;
        }
    return all;
}

bool TileTree::below_horizon(const Box& box, const LodView& view) const {
    // In coordinates in which the ellipsoid, lowered to the lowest drawn ground, is the unit
    // sphere. Source: P. Cozzi, K. Ring, 3D Engine Design for Virtual Globes, 2011, section 12.
    const double lowered = std::min(lowest_m_ * view.exaggeration, 0.0);
    const double a = kEquatorialRadius_m + lowered;
    const double b = kEquatorialRadius_m * (1 - kFlattening) + lowered;
    const auto scaled = [&](const glm::dvec3& p) {
        const glm::dvec3 q = p - earth_centre_m_;
        const double along = dot(q, polar_axis_);
        return (q - along * polar_axis_) / a + along / b * polar_axis_;
    };
    const glm::dvec3 eye = scaled(*view.eye_m);
    const double to_horizon2 = dot(eye, eye) - 1;
    if (to_horizon2 <= 0) return false;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 to =
            scaled({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                    corner & 4 ? box.high.z : box.low.z}) -
            eye;
        const double down = -dot(to, eye);
        if (down <= to_horizon2 || down * down <= to_horizon2 * dot(to, to)) return false;
    }
    return true;
}

bool TileTree::hidden(const Box& box, const LodView& view) const {
    return box.outside(view.planes) ||
           (view.eye_m && !view.sees_beyond_limb && below_horizon(box, view));
}

LodRanges TileTree::ranges(const LodView& view) {
    LodRanges ranges;
    const std::size_t top = error_m_.size() - 1;
    ranges.levels.resize(top + 1);
    for (std::size_t k = 0; k <= top; ++k) {
        LodRanges::Range& level = ranges.levels[k];
        if (k == top || view.tolerance <= 0) {
            level = {kInfinity, kInfinity};
            continue;
        }
        const double error_m = error_m_[k + 1] * view.exaggeration;
        level.range_m = error_m / view.tolerance / kMorphStart;
        if (k > 0 && ranges.levels[k - 1].range_m > 0) {
            const double side_m = longest_spacing_m_ * (kTileQuads << (k - 1));
            const double across_m =
                std::hypot(1.05 * side_m, 1.05 * side_m, relief_m_[k - 1] * view.exaggeration);
            level.range_m =
                std::max(level.range_m, (ranges.levels[k - 1].range_m + across_m) / kMorphStart);
        }
        level.morph_start_m = kMorphStart * level.range_m;
    }
    return ranges;
}

std::vector<TileDraw> TileTree::select_orthographic(const LodView& view) {
    std::vector<TileDraw> draws;
    const auto take = [&](auto&& self, const TileKey& key) -> void {
        const dem::Pyramid::Bounds bounds = pyramid_->bounds(key.level, key.at);
        if (bounds.empty() || hidden(box(key, view.exaggeration), view)) return;
        const double error_m = kSigmas * bounds.rms_m + net_error_m(key.level);
        if (key.level == 0 || error_m * view.exaggeration <= view.tolerance)
            draws.push_back({key});
        else
            for_children(key, [&](const TileKey& child, int) { self(self, child); });
    };
    take(take, root());
    return draws;
}

std::vector<TileDraw> TileTree::select(const LodView& view) {
    return view.eye_m ? select_from_eye(view, nullptr) : select_orthographic(view);
}

std::vector<TileDraw> TileTree::select(const LodView& view, const Resident& resident) {
    return select_from_eye(view, &resident);
}

std::vector<TileDraw> TileTree::select_from_eye(const LodView& view, const Resident* resident) {
    const LodRanges ranges = this->ranges(view);
    std::vector<TileDraw> draws;
    // Returns false if the parent has to draw the tile's quadrant.
    const auto take = [&](auto&& self, const TileKey& key) -> bool {
        if (pyramid_->bounds(key.level, key.at).empty()) return true;
        const Box b = box(key, view.exaggeration);
        const double distance_m = b.distance(*view.eye_m);
        if (distance_m >= ranges.levels[static_cast<std::size_t>(key.level)].range_m) {
            return hidden(b, view);
        }
        if (hidden(b, view)) return true;
        if (resident) {
            resident->needed.push_back(key);
            if (!resident->is_there(key)) return false;
        }
        if (key.level == 0 ||
            distance_m >= ranges.levels[static_cast<std::size_t>(key.level - 1)].range_m) {
            draws.push_back({key, 0xf, distance_m});
            return true;
        }
        std::uint8_t quadrants = 0;
        for_children(key, [&](const TileKey& child, int q) {
            if (!self(self, child)) quadrants |= static_cast<std::uint8_t>(1 << q);
        });
        if (quadrants) draws.push_back({key, quadrants, distance_m});
        return true;
    };
    take(take, root());
    std::ranges::sort(
        draws, [](const TileDraw& a, const TileDraw& b) { return a.distance_m < b.distance_m; });
    return draws;
}

}  // namespace relevo::render

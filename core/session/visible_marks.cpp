#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/units.h"
#include "session/marks.h"
#include "session/seen_ground.h"

// Which marks a picture shows, and where.

namespace relevo::session {
namespace {

using Order = effect::MarksSpec::Order;

/// Pixels that are tested along the heights that a mark may have.
constexpr double kMostSamples = 48;
/// Ground that is nearer than a mark by this fraction of its depth is not the crest that it is on.
constexpr double kCrest = 0.05;

/// The same of a mark that is on no crest. The ground's depth changes by less from pixel to pixel.
constexpr double kCrossed = 0.01;

/// A mark in the picture.
struct Candidate {
    const StandingMarks::Mark* mark;
    /// Image positions and depths of the highest and the lowest place where it may stand.
    glm::dvec2 top, bottom;
    double top_m, bottom_m;
    std::size_t first = 0;  ///< of its pixels among those of all candidates
    int samples = 1;        ///< from top to bottom
};

/// Where points are in a picture of one camera or around it.
class Projection {
  public:
    explicit Projection(const MarkView& view)
        : view_(view), plane_(view.camera, view.width_px, view.height_px, {}) {}

    std::optional<glm::dvec2> project(const glm::dvec3& point_m) const {
        if (!view_.around) return plane_.project(point_m);
        const glm::dvec3 way_m = point_m - view_.camera.eye_m;
        return view_.around->map.project(transpose(view_.around->axes) * way_m);
    }
    double depth_m(const glm::dvec3& point_m) const {
        const glm::dvec3 way_m = point_m - view_.camera.eye_m;
        return view_.around ? length(way_m) : dot(way_m, view_.camera.forward);
    }
    double px_per_m(double depth_m) const {
        return view_.around ? view_.around->map.px_per_rad() / depth_m : plane_.px_per_m(depth_m);
    }
    /// As SeenGround::moved().
    glm::dvec2 moved(const glm::dvec3& point_m, const glm::dvec3& direction) const {
        if (!view_.around) return plane_.moved(point_m, direction);
        const auto at = project(point_m), then = project(point_m + direction);
        return at && then ? *then - *at : glm::dvec2(1, 0);
    }

  private:
    const MarkView& view_;
    SeenGround plane_;
};

/// Projects marks, and finds which of them are on ground or visible before it.
class Finder {
  public:
    Finder(const Marks& marks, const MarkView& view)
        : marks_(marks),
          view_(view),
          projection_(view),
          reach_px_(std::max(kHidden_px, marks.pixel_error)) {}

    std::vector<chart::MarkPoint> run() {
        for (const StandingMarks::Mark& mark : marks_.standing->marks)
            if (std::optional<Candidate> candidate = project(mark))
                candidates_.push_back(*candidate);
        sort();
        for (Candidate& candidate : candidates_)
            add_pixels(candidate);
        depths_m_ = view_.depths_m(pixels_);
        std::vector<chart::MarkPoint> points;
        for (const Candidate& candidate : candidates_)
            if (const std::optional<glm::dvec2> at = find(candidate))
                points.push_back(point(*candidate.mark, *at));
        return points;
    }

  private:
    chart::MarkPoint point(const StandingMarks::Mark& mark, const glm::dvec2& at) const {
        const MarkPlaces& places = *marks_.standing->places;
        chart::MarkPoint result{at, places.places[mark.index].name};
        if (!places.looks.empty()) result.symbol = places.looks[mark.index].symbol;
        if (mark.along == glm::vec3(0)) return result;
        const glm::dvec2 along = projection_.moved(mark.at_m, glm::dvec3(mark.along));
        // Never upside down.
        const double turn = std::atan2(along.y, along.x);
        result.turn_deg = degrees(std::remainder(turn, std::numbers::pi));
        return result;
    }

    bool is_inside(const glm::dvec2& at) const {
        return at.x >= 0 && at.y >= 0 && at.x < view_.width_px && at.y < view_.height_px;
    }

    double depth_m(const glm::dvec3& point_m) const { return projection_.depth_m(point_m); }

    std::optional<Candidate> project(const StandingMarks::Mark& mark) const {
        const glm::dvec3 up(mark.up);
        const glm::dvec3 at_m = mark.at_m + marks_.above_m * marks_.exaggeration * up;
        glm::dvec3 top_m = at_m, bottom_m = at_m;
        if (mark.on_ground && marks_.above_m == 0 && depth_m(at_m) > 0) {
            const auto [low_m, high_m] = marks_.displacement.range_m(mark.height_m, mark.height_m);
            const double reach_m = reach_px_ / projection_.px_per_m(depth_m(at_m));
            top_m += ((high_m - mark.height_m) * marks_.exaggeration + reach_m) * up;
            bottom_m += ((low_m - mark.height_m) * marks_.exaggeration - reach_m) * up;
        }
        const auto top = projection_.project(top_m), bottom = projection_.project(bottom_m);
        if (!top || !bottom || (!is_inside(*top) && !is_inside(*bottom))) return std::nullopt;
        return Candidate{&mark, *top, *bottom, depth_m(top_m), depth_m(bottom_m)};
    }

    /// By importance; equally important ones in the order of the places.
    void sort() {
        if (marks_.order == Order::Nearest)
            std::ranges::stable_sort(candidates_, {}, &Candidate::bottom_m);
        if (marks_.order == Order::Highest)
            std::ranges::stable_sort(candidates_, std::ranges::greater{},
                                     [](const Candidate& c) { return c.mark->height_m; });
    }

    void add_pixels(Candidate& candidate) {
        const double length = distance(candidate.top, candidate.bottom);
        if (length >= 1)
            candidate.samples = 1 + static_cast<int>(std::min(std::ceil(length), kMostSamples - 1));
        candidate.first = pixels_.size();
        for (int k = 0; k < candidate.samples; ++k) {
            const double share = candidate.samples == 1 ? 0.5 : k / (candidate.samples - 1.0);
            const glm::dvec2 at = glm::mix(candidate.top, candidate.bottom, share);
            pixels_.emplace_back(
                std::clamp(static_cast<int>(std::floor(at.x)), 0, view_.width_px - 1),
                std::clamp(static_cast<int>(std::floor(at.y)), 0, view_.height_px - 1));
        }
    }

    std::size_t index(const Candidate& candidate, int k) const {
        return candidate.first + static_cast<std::size_t>(k);
    }
    /// Where the centre of a sample's pixel is between top and bottom, 0 to 1.
    double share(const Candidate& candidate, int k) const {
        if (candidate.samples == 1) return 0;
        const glm::dvec2 way = candidate.bottom - candidate.top;
        const glm::dvec2 center = glm::dvec2(pixels_[index(candidate, k)]) + 0.5;
        return dot(center - candidate.top, way) / dot(way, way);
    }
    /// How far ground is behind the mark, if that is at a sample [m]; negative before it.
    double behind_m(const Candidate& candidate, int k) const {
        return depths_m_[index(candidate, k)] -
               glm::mix(candidate.top_m, candidate.bottom_m, share(candidate, k));
    }

    /// Where the mark stands in the picture; nullopt if it is hidden or outside.
    std::optional<glm::dvec2> find(const Candidate& candidate) const {
        // Downwards to the first pixel that shows no ground behind the mark.
        int k = 0;
        double behind = behind_m(candidate, 0), before = 0;
        while (behind > 0 && k < candidate.samples - 1) {
            before = behind;
            behind = behind_m(candidate, ++k);
        }
        const double crest_m = (candidate.mark->on_crests ? kCrest : kCrossed) * candidate.top_m;
        if (k == 0 && behind < -kNear * candidate.top_m) return std::nullopt;
        // Level ground far away comes nearer by as much from pixel to pixel, but not across a
        // crest.
        if (behind < -crest_m && before > crest_m) return std::nullopt;
        double at = candidate.samples == 1 ? 0.5 : share(candidate, k);
        if (k > 0 && behind < 0 && before < crest_m)
            at = glm::mix(share(candidate, k - 1), at, before / (before - behind));
        const glm::dvec2 found =
            glm::mix(candidate.top, candidate.bottom, std::clamp(at, 0.0, 1.0));
        return is_inside(found) ? std::optional(found) : std::nullopt;
    }

    const Marks& marks_;
    const MarkView& view_;
    Projection projection_;
    double reach_px_;  // of the drawn ground above and below the posts
    std::vector<Candidate> candidates_;
    std::vector<glm::ivec2> pixels_;
    std::vector<float> depths_m_;
};

}  // namespace

MarkView view_of(const scene::Camera& camera, int width_px, int height_px,
                 const std::vector<float>& depths_m) {
    return {camera, width_px, height_px, [=, &depths_m](std::span<const glm::ivec2> pixels) {
                std::vector<float> found;
                found.reserve(pixels.size());
                for (const glm::ivec2& at : pixels)
                    found.push_back(depths_m[static_cast<std::size_t>(height_px - 1 - at.y) *
                                                 static_cast<std::size_t>(width_px) +
                                             static_cast<std::size_t>(at.x)]);
                return found;
            }};
}

MarkView view_of(const scene::Camera& camera, const MarkView::Around& around,
                 const std::vector<float>& distances_m) {
    const glm::ivec2 size = around.map.picture_px();
    return {camera, size.x, size.y,
            [width = static_cast<std::size_t>(size.x),
             &distances_m](std::span<const glm::ivec2> pixels) {
                std::vector<float> found;
                found.reserve(pixels.size());
                for (const glm::ivec2& at : pixels)
                    found.push_back(distances_m[static_cast<std::size_t>(at.y) * width +
                                                static_cast<std::size_t>(at.x)]);
                return found;
            },
            around};
}

std::vector<chart::MarkPoint> visible_marks(const Marks& marks, const MarkView& view) {
    if (!marks.standing || view.width_px <= 0 || view.height_px <= 0) return {};
    return Finder(marks, view).run();
}

void draw_marks(std::span<const Marks> lists, const MarkView& view, const chart::Rect& within,
                std::span<const chart::Rect> taken, chart::Drawing& drawing) {
    chart::FreeRoom room(within);
    for (const chart::Rect& rect : taken)
        room.take(rect);
    for (const Marks& marks : lists) {
        const std::vector<chart::MarkPoint> points = visible_marks(marks, view);
        chart::draw_marks(chart::place_marks(points, marks.style, room), marks.style, drawing);
    }
}

}  // namespace relevo::session

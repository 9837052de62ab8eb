#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "session/marks.h"
#include "session/seen_ground.h"

// Which marks a picture shows, and where.

namespace relevo::session {
namespace {

using Order = effect::MarksSpec::Order;

/// Pixels that are tested along the heights that a mark may have.
constexpr int kMostSamples = 48;
/// Ground that is nearer than the mark by this fraction of its depth is other ground before it.
constexpr double kOnGround = 0.02;

/// A mark in the picture.
struct Candidate {
    const StandingMarks::Mark* mark;
    /// Image positions and depths of the highest and the lowest place where it may stand.
    glm::dvec2 top, bottom;
    double top_m, bottom_m;
    std::size_t first = 0;  ///< of its pixels among those of all candidates
    int samples = 1;        ///< from top to bottom; those of the tolerance above them come first
};

/// Projects marks, and finds which of them are on ground or visible before it.
class Finder {
  public:
    Finder(const Marks& marks, const MarkView& view)
        : marks_(marks), view_(view), projection_(view.camera, view.width_px, view.height_px, {}) {}

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
                points.push_back(
                    {*at, marks_.standing->places->places[candidate.mark->index].name});
        return points;
    }

  private:
    bool is_inside(const glm::dvec2& at) const {
        return at.x >= 0 && at.y >= 0 && at.x < view_.width_px && at.y < view_.height_px;
    }

    double depth_m(const glm::dvec3& point_m) const {
        return dot(point_m - view_.camera.eye_m, view_.camera.forward);
    }

    std::optional<Candidate> project(const StandingMarks::Mark& mark) const {
        const glm::dvec3 up = marks_.exaggeration * glm::dvec3(mark.up);
        const glm::dvec3 at_m = mark.at_m + marks_.above_m * up;
        glm::dvec3 top_m = at_m, bottom_m = at_m;
        if (marks_.displacement.any() && !std::isnan(mark.ground_m)) {
            const auto [low_m, high_m] = marks_.displacement.range_m(mark.ground_m, mark.ground_m);
            top_m += (high_m - mark.ground_m) * up;
            bottom_m += (low_m - mark.ground_m) * up;
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

    /// Place of a sample from top to bottom, 0 to 1.
    static double share(const Candidate& candidate, int k) {
        return k <= 0 ? 0 : k / (candidate.samples - 1.0);
    }
    /// Position of a sample; 0 is the top one, negative ones are above it.
    static glm::dvec2 sample(const Candidate& candidate, int k) {
        return glm::mix(candidate.top, candidate.bottom, share(candidate, k)) +
               glm::dvec2(0, std::min(k, 0));
    }

    void add_pixels(Candidate& candidate) {
        const double length = distance(candidate.top, candidate.bottom);
        candidate.samples =
            1 + static_cast<int>(std::ceil(std::clamp(length, 0.0, kMostSamples - 1.0)));
        candidate.first = pixels_.size();
        for (int k = -kHidden_px; k < candidate.samples; ++k) {
            const glm::dvec2 at = sample(candidate, k);
            pixels_.emplace_back(
                std::clamp(static_cast<int>(std::floor(at.x)), 0, view_.width_px - 1),
                std::clamp(static_cast<int>(std::floor(at.y)), 0, view_.height_px - 1));
        }
    }

    /// Where the mark stands in the picture; nullopt if it is hidden or outside.
    std::optional<glm::dvec2> find(const Candidate& candidate) const {
        const auto seen_m = [&](int k) {
            return double{depths_m_[candidate.first + static_cast<std::size_t>(k + kHidden_px)]};
        };
        bool visible = false;
        for (int k = -kHidden_px; k <= 0; ++k)
            visible = visible || seen_m(k) >= candidate.top_m * (1 - kNear);
        if (!visible) return std::nullopt;
        const auto own_m = [&](int k) {
            return glm::mix(candidate.top_m, candidate.bottom_m, share(candidate, k));
        };
        // Downwards to the first pixel that shows no ground behind the mark.
        int k = 0;
        while (k < candidate.samples - 1 && seen_m(k) > own_m(k))
            ++k;
        if (k > 0 && seen_m(k) < own_m(k) * (1 - kOnGround)) return std::nullopt;
        const glm::dvec2 at = sample(candidate, k);
        return is_inside(at) ? std::optional(at) : std::nullopt;
    }

    const Marks& marks_;
    const MarkView& view_;
    SeenGround projection_;
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

std::vector<chart::MarkPoint> visible_marks(const Marks& marks, const MarkView& view) {
    if (!marks.standing || view.width_px <= 0 || view.height_px <= 0) return {};
    return Finder(marks, view).run();
}

void draw_marks(std::span<const Marks> lists, const MarkView& view, const chart::Rect& within,
                chart::Drawing& drawing) {
    chart::FreeRoom room(within);
    for (const Marks& marks : lists) {
        const std::vector<chart::MarkPoint> points = visible_marks(marks, view);
        chart::draw_marks(chart::place_marks(points, marks.style, room), marks.style, drawing);
    }
}

}  // namespace relevo::session

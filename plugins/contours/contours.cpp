// Heights on index contours: finds places for them, which core draws as marks.
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <relevo/plugin.hpp>

#include "cells.h"
#include "levels.h"

namespace {

using namespace relevo::plugin;
using contours::Candidate;
using contours::Place;
using contours::View;

/// Index lines that are nearer than this have no labels, in heights of the letters.
constexpr double kClosest = 1.3;
/// A line is straight so far on either side of a label's middle, the same. "1200 m" is 3.6 wide.
constexpr double kStraight = 1.0;
/// Sine of the least angle between ground with labels and the way to the eye.
constexpr double kGlancing = 0.1;
/// Lines that look so much shorter than they are have none.
constexpr double kForeshortened = 0.15;

class Contours : public Instance {
  public:
    explicit Contours(const Host& host)
        : params_(host), frame_(host), heights_(host), geo_(host), marks_(host) {}

    void prepare() override {
        std::vector<Mark> marks;
        if (params_.get("contours.labels") != 0) marks = labels(frame_.get());
        if (marks == shown_) return;
        marks_.set("heights", marks);
        shown_ = std::move(marks);
    }

  private:
    std::vector<Mark> labels(const relevo_frame& frame) {
        const double relief_m = frame.highest_m - frame.lowest_m;
        const double step_m = params_.get("contours.index") *
                              contours::interval(params_.get("contours.interval_m"), relief_m);
        const double size_px = params_.get("contours.label_px");
        const View view(frame);
        const contours::Ground ground(heights_, geo_, frame.exaggeration);
        cells_.update(frame.ground, frame.exaggeration, step_m);
        std::vector<Mark> marks;
        for (const Candidate& candidate : cells_.candidates(ground, view)) {
            const Place& place = *candidate.place;
            if (!has_room(place, view, size_px, step_m, frame.exaggeration)) continue;
            marks.push_back({.lat_deg = place.lat_deg,
                             .lon_deg = place.lon_deg,
                             .text = contours::text_of(place.level_m, step_m),
                             .height_of = RELEVO_ON_KNOWN_GROUND,
                             .height_m = place.level_m,
                             .rank = candidate.rank,
                             .azimuth_deg = place.azimuth_deg});
        }
        return marks;
    }

    /// Whether a label in the picture is on a straight piece of a line apart from others.
    static bool has_room(const Place& place, const View& view, double size_px, double step_m,
                         double exaggeration) {
        if (!(view.dot_forward(place.at_m) > 0)) return false;
        const glm::dvec2 at = view.project(place.at_m);
        if (std::abs(at.x) > view.half_width_px || std::abs(at.y) > view.half_height_px)
            return false;
        // Ground that is seen at a glancing angle, or from behind.
        const glm::dvec3 normal = place.up - exaggeration * place.slope * place.uphill;
        const glm::dvec3 to_eye = view.eye_m - place.at_m;
        if (dot(normal, to_eye) < kGlancing * length(normal) * length(to_eye)) return false;
        // Pixels a metre, of a metre at the place's depth.
        const double px_per_m = view.px_per_m(place.at_m), small_m = 1 / px_per_m;
        const double along =
            length(view.project(place.at_m + small_m * place.along) - at) / small_m;
        const glm::dvec3 climb =
            place.uphill / place.slope * step_m + exaggeration * step_m * place.up;
        const double share = small_m / length(climb);
        const double apart_px = length(view.project(place.at_m + share * climb) - at) / share;
        return along > kForeshortened * px_per_m &&
               place.straight_m * along >= kStraight * size_px && apart_px >= kClosest * size_px;
    }

    Params params_;
    Frame frame_;
    Heights heights_;
    Geo geo_;
    Marks marks_;
    contours::Cells cells_;
    std::vector<Mark> shown_;
};

}  // namespace

RELEVO_PLUGIN("contours", Contours)

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/units.h"
#include "scene/ground_path.h"
#include "scene/motion.h"
#include "scene/series.h"
#include "scene/spline.h"

namespace relevo::scene {
namespace {

/// A camera's place and direction. The height has the exaggeration.
struct Pose {
    geo::Geodetic eye;
    double heading_rad = 0, pitch_rad = 0;
    double fov_y_rad = 0;  ///< 0: of the scene's view
};

/// The direction of a vector at a place.
void point_along(const glm::dvec3& forward, const geo::LocalFrame& frame, Pose& pose) {
    const geo::Axes axes = frame.axes(pose.eye.lat_rad, pose.eye.lon_rad);
    const double east = dot(forward, axes.east), north = dot(forward, axes.north);
    pose.heading_rad = std::atan2(east, north);
    pose.pitch_rad = std::atan2(dot(forward, axes.up), std::hypot(east, north));
}

/// The share of the way at each frame.
std::vector<double> shares(const FlightMotion& motion) {
    std::vector<double> result;
    for (int i = 0; i < motion.frames; ++i) {
        const double share = motion.frames > 1 ? static_cast<double>(i) / (motion.frames - 1) : 0;
        result.push_back(motion.ease ? eased(share) : share);
    }
    return result;
}

/// Heights of a flight along a line: above all ground near it.
class FlightHeights {
  public:
    /// @param warning  is set if a part of the line has no ground
    FlightHeights(const GroundPath& path, const Reach& reach, double height_m,
                  const MotionGround& ground, std::string& warning) {
        const double whole_m = path.length_m() + reach.look_ahead_m;
        constexpr double kMost = 100'000, kPerLook = 64;
        step_m_ = std::max(whole_m / kMost, std::min(reach.look_ahead_m, whole_m) / kPerLook);
        std::size_t outside = 0;
        for (double at_m = 0; at_m < whole_m + 2 * step_m_; at_m += step_m_) {
            heights_m_.push_back(ground.height_m(path.at(at_m)) * ground.exaggeration);
            if (std::isnan(heights_m_.back()) && at_m <= path.length_m()) ++outside;
        }
        heights_m_ = without_gaps(std::move(heights_m_));
        if (std::isnan(heights_m_.front()))
            bad_input("expected a line over the DEM but all of it lies outside, or in voids");
        const double share = static_cast<double>(outside) * step_m_ / path.length_m();
        if (share > 0.01)
            warning = fmt::format(
                "flight: {:.0f} % of the line has no ground; the height is "
                "kept from the nearest that it has",
                std::min(100 * share, 100.0));
        for (double& at_m : heights_m_)
            at_m += height_m;
        const auto radius = static_cast<std::size_t>(std::ceil(reach.rise_m / step_m_));
        heights_m_ = smooth_above(heights_m_, radius, Ends::Held);
    }

    double at(double along_m) const {
        const double steps =
            std::clamp(along_m / step_m_, 0.0, static_cast<double>(heights_m_.size() - 1));
        const auto cell = std::min(static_cast<std::size_t>(steps), heights_m_.size() - 2);
        const double share = steps - static_cast<double>(cell);
        return heights_m_[cell] + share * (heights_m_[cell + 1] - heights_m_[cell]);
    }

  private:
    std::vector<double> heights_m_;
    double step_m_ = 0;
};

double mean_speed_m_s(const FlightMotion& motion) {
    const double length_m = GroundPath(motion.along, reach_of(motion, 0).look_ahead_m).length_m();
    return length_m * motion.fps / motion.frames;
}

std::vector<Pose> along_line(const FlightMotion& motion, const MotionGround& ground,
                             std::string& warning) {
    const Reach reach = reach_of(motion, mean_speed_m_s(motion));
    const GroundPath path(motion.along, reach.look_ahead_m);
    const FlightHeights heights(path, reach, motion.height_m, ground, warning);
    std::vector<geo::Geodetic> eyes, aims;
    for (const double share : shares(motion)) {
        const double at_m = share * path.length_m(), ahead_m = at_m + reach.look_ahead_m;
        eyes.push_back(path.at(at_m));
        eyes.back().height_m = heights.at(at_m);
        aims.push_back(path.at(ahead_m));
        aims.back().height_m = heights.at(ahead_m) - motion.height_m;
    }
    // Between the samples of the line there may be a rock.
    keep_above_ground(eyes, ground, std::min(motion.height_m, kClearance_m),
                      static_cast<std::size_t>(motion.fps), false);
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        poses.push_back({eyes[i]});
        point_along(ground.frame.to_local(aims[i]) - ground.frame.to_local(eyes[i]), ground.frame,
                    poses.back());
    }
    return poses;
}

/// x, y, z of the place below the eye in the DEM's frame, the eye's height, heading, pitch and
/// field of view.
using Knot = std::array<double, 7>;

Knot knot_of(const Camera& camera, const geo::LocalFrame& frame) {
    Pose pose{frame.to_geodetic(camera.eye_m)};
    point_along(camera.forward, frame, pose);
    const glm::dvec3 below = frame.to_local({pose.eye.lat_rad, pose.eye.lon_rad, 0});
    return {below.x,          below.y,        below.z,         pose.eye.height_m,
            pose.heading_rad, pose.pitch_rad, camera.fov_y_rad};
}

/// The knots of views, without those that are like the one before.
std::vector<Knot> knots_of(const std::vector<View>& views, const MotionGround& ground) {
    constexpr double kSame = 1e-3;  // m, and rad
    std::vector<Knot> knots;
    for (const View& view : views) {
        Knot knot = knot_of(ground.camera(view), ground.frame);
        if (!knots.empty()) {
            double& heading = knot[4];
            heading -= 2 * kPi * std::round((heading - knots.back()[4]) / (2 * kPi));
            const bool same = std::ranges::equal(
                knot, knots.back(), [](double a, double b) { return std::abs(a - b) < kSame; });
            if (same) continue;
        }
        knots.push_back(knot);
    }
    if (knots.size() < 2) bad_input("expected two different views or more but all are the same");
    return knots;
}

/// How long ways between views are: of turns as of ways of the flight's mean length a radian, so
/// that a view that only turns has time.
class Metric {
  public:
    explicit Metric(const std::vector<Knot>& knots) {
        double sum_m = 0;
        for (std::size_t i = 1; i < knots.size(); ++i)
            sum_m += moved_m(knots[i - 1], knots[i]);
        if (sum_m > 0) per_rad_m_ = sum_m / static_cast<double>(knots.size() - 1);
    }

    double length(const Knot& a, const Knot& b) const {
        const double turn_rad =
            std::hypot((b[4] - a[4]) * std::cos(0.5 * (a[5] + b[5])), b[5] - a[5]);
        return std::hypot(moved_m(a, b), per_rad_m_ * turn_rad);
    }

  private:
    static double moved_m(const Knot& a, const Knot& b) {
        return std::hypot(std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]), b[3] - a[3]);
    }
    double per_rad_m_ = 1;
};

/// Points of a curve through knots.
std::vector<Knot> curve_through(const std::vector<Knot>& knots, const Metric& metric) {
    std::vector<double> lengths;
    for (std::size_t i = 1; i < knots.size(); ++i)
        lengths.push_back(metric.length(knots[i - 1], knots[i]));
    const CentripetalSpline<std::tuple_size_v<Knot>> spline(knots, lengths);
    constexpr int kPieces = 256;
    std::vector<Knot> curve{knots.front()};
    for (std::size_t i = 0; i < spline.segments(); ++i)
        for (int piece = 1; piece <= kPieces; ++piece)
            curve.push_back(spline.at(i, static_cast<double>(piece) / kPieces));
    return curve;
}

/// Points of a curve at shares of its length.
std::vector<Knot> at_shares(const std::vector<Knot>& curve, const Metric& metric,
                            const std::vector<double>& shares_of) {
    std::vector<double> along{0};
    for (std::size_t i = 1; i < curve.size(); ++i)
        along.push_back(along.back() + metric.length(curve[i - 1], curve[i]));
    std::vector<Knot> result;
    std::size_t at = 0;
    for (const double share : shares_of) {
        const double wanted = share * along.back();
        while (at + 2 < curve.size() && along[at + 1] < wanted)
            ++at;
        const double length = along[at + 1] - along[at];
        const double part = length > 0 ? std::clamp((wanted - along[at]) / length, 0.0, 1.0) : 0;
        Knot knot;
        for (std::size_t c = 0; c < knot.size(); ++c)
            knot[c] = curve[at][c] + part * (curve[at + 1][c] - curve[at][c]);
        result.push_back(knot);
    }
    return result;
}

/// Smooths each member over frames: curves through points bend anew at each.
void smooth_over_time(std::vector<Knot>& knots, double fps) {
    constexpr double kSmooth_s = 0.75;
    const std::size_t radius =
        std::min(static_cast<std::size_t>(kSmooth_s * fps), knots.size() / 6);
    for (std::size_t c = 0; c < std::tuple_size_v<Knot>; ++c) {
        std::vector<double> values;
        for (const Knot& knot : knots)
            values.push_back(knot[c]);
        values = smoothed(values, radius, Ends::Mirrored);
        for (std::size_t i = 0; i < knots.size(); ++i)
            knots[i][c] = values[i];
    }
}

/// How far above the ground the eyes of views are at least, within sensible bounds [m].
double clearance_of(const std::vector<Knot>& knots, const MotionGround& ground) {
    constexpr double kMost_m = 20;
    double least_m = kMost_m;
    for (const Knot& knot : knots) {
        const geo::Geodetic place = ground.frame.to_geodetic({knot[0], knot[1], knot[2]});
        const double above_m = knot[3] - ground.height_m(place) * ground.exaggeration;
        if (above_m < least_m) least_m = above_m;  // not NaN
    }
    return std::max(least_m, kEyeHeight_m);
}

std::vector<Pose> through_views(const FlightMotion& motion, const MotionGround& ground) {
    const std::vector<Knot> given = knots_of(motion.views, ground);
    const Metric metric(given);
    std::vector<Knot> knots = at_shares(curve_through(given, metric), metric, shares(motion));
    smooth_over_time(knots, motion.fps);
    std::vector<geo::Geodetic> eyes;
    for (const Knot& knot : knots) {
        eyes.push_back(ground.frame.to_geodetic({knot[0], knot[1], knot[2]}));
        eyes.back().height_m = knot[3];
    }
    keep_above_ground(eyes, ground, clearance_of(given, ground),
                      static_cast<std::size_t>(2 * motion.fps), false);
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < knots.size(); ++i)
        poses.push_back({eyes[i], knots[i][4], knots[i][5], knots[i][6]});
    return poses;
}

/// Bounds how fast cameras turn.
void steady(std::vector<Pose>& poses, double fps) {
    const double most_rad = radians(kMostTurn_deg_s) / fps;
    std::vector<double> headings_rad, pitches_rad;
    for (const Pose& pose : poses) {
        headings_rad.push_back(pose.heading_rad);
        pitches_rad.push_back(pose.pitch_rad);
    }
    headings_rad = with_steps_up_to(unwrapped(std::move(headings_rad)), most_rad);
    pitches_rad = with_steps_up_to(pitches_rad, most_rad);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        poses[i].heading_rad = headings_rad[i];
        poses[i].pitch_rad = pitches_rad[i];
    }
}

}  // namespace

Reach reach_of(const FlightMotion& motion, double mean_speed_m_s) {
    constexpr double kHeights = 2.5;  // 22 degrees down
    constexpr double kSeconds = 2;
    const double chosen_m = std::max(kHeights * motion.height_m, kSeconds * mean_speed_m_s);
    const double ahead_m = motion.look_ahead_m > 0 ? motion.look_ahead_m : chosen_m;
    return {ahead_m, std::max(ahead_m, kSeconds * mean_speed_m_s)};
}

double frames_at_speed(const FlightMotion& motion, double speed_m_s) {
    const double mean_m_s = speed_m_s * (motion.ease ? kEasedMeanSpeed : 1);
    const GroundPath path(motion.along, reach_of(motion, mean_m_s).look_ahead_m);
    return std::max(1.0, std::round(path.length_m() / mean_m_s * motion.fps));
}

std::vector<View> flight_views(const FlightMotion& motion, const View& view,
                               const MotionGround& ground, std::string& warning) {
    std::vector<Pose> poses =
        motion.views.empty() ? along_line(motion, ground, warning) : through_views(motion, ground);
    steady(poses, motion.fps);
    std::vector<View> result;
    for (const Pose& pose : poses) {
        View at = view_from(pose.eye, ground);
        at.heading_deg = std::remainder(degrees(pose.heading_rad), 360.0);
        at.pitch_deg = degrees(pose.pitch_rad);
        at.take_lens_of(view);
        if (pose.fov_y_rad > 0) {
            at.fov_y_rad = pose.fov_y_rad;
            at.focal_length_mm = 0;
        }
        result.push_back(at);
    }
    return result;
}

}  // namespace relevo::scene

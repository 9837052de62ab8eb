#include "viewer/hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "base/units.h"

namespace relevo::viewer {
namespace {

constexpr float kLine_px = 8;   // distance at which a dividing line can be grabbed
constexpr float kClick_px = 4;  // greatest motion of a click
/// Decay of zooming and gliding [1/s].
constexpr double kZoomRate = 14, kGlideRate = 7;
constexpr float kPanANotch_px = 60;
/// An eye below this height walks where it is.
constexpr double kLow_m = 50;
/// Distance of a camera within the DEM, by that of one that shows all of it from above.
constexpr double kNear = 0.15;

}  // namespace

double Hand::aspect() const {
    return static_cast<double>(window_.size().x) / window_.size().y;
}

void Hand::act(double passed_s, bool comparing, bool new_input) {
    const glm::vec2 mouse = window_.mouse();
    const Pose& pose = state_.document.pose;
    const Pose before = pose;
    if (!ImGui::GetIO().WantCaptureMouse) {
        if (new_input) press(mouse, comparing);
        scroll(mouse);
    }
    drag(mouse, passed_s);
    glide(passed_s);
    fly_by_keys(passed_s);
    has_moved_ = pose.eye_m != before.eye_m || pose.heading_deg != before.heading_deg ||
                 pose.pitch_deg != before.pitch_deg;
    hover(mouse);
}

void Hand::rest() {
    dragging_.reset();
    clicked_.reset();
    stop_gliding();
    walking_ = keys_held_ = has_moved_ = false;
}

void Hand::stop_gliding() {
    zoom_left_ = 0;
    glide_deg_a_s_ = {};
}

bool Hand::glides() const {
    return std::abs(zoom_left_) > 1e-3 || length(glide_deg_a_s_) > 0.5;
}

/// Scrolls by the wheel's motion since the last call, fractional on touchpads. ImGui discards it
/// with each frame.
void Hand::scroll(glm::vec2 mouse) {
    ImGuiIO& io = ImGui::GetIO();
    glm::vec2 by(std::exchange(io.MouseWheelH, 0.0f), std::exchange(io.MouseWheel, 0.0f));
    if (by == glm::vec2(0)) return;
    if (!io.KeyShift) {
        zoom_at_ = hold(mouse);
        zoom_left_ -= std::log(zoom_of_scroll(by.y));
        return;
    }
    stop_gliding();
    // As in documents: scrolling down shows what is below.
    const glm::vec2 to = mouse + kPanANotch_px * by;
    state_.document.pose =
        pan(state_.document.pose, state_.land, hold(mouse), in_view(to), aspect());
}

void Hand::glide(double passed_s) {
    Pose& pose = state_.document.pose;
    if (std::abs(zoom_left_) > 1e-3) {
        const double part = zoom_left_ * (1 - std::exp(-kZoomRate * passed_s));
        zoom_left_ -= part;
        pose = zoom(pose, state_.land, zoom_at_, std::exp(-part));
    }
    if (!dragging_ && length(glide_deg_a_s_) > 0.5) {
        pose = orbit(pose, state_.land, held_, glide_deg_a_s_.x * passed_s,
                     glide_deg_a_s_.y * passed_s);
        glide_deg_a_s_ *= std::exp(-kGlideRate * passed_s);
    }
}

bool Hand::move(Command command, const std::function<Whole()>& whole) {
    Pose& pose = state_.document.pose;
    const glm::dvec3 middle = hold(0.5f * window_.size());
    stop_gliding();
    switch (command) {
        case Command::Whole:
            pose = whole().home;
            return true;
        case Command::NorthUp:
            pose = orbit(pose, state_.land, middle, pose.heading_deg, 0);
            pose.heading_deg = 0;
            return true;
        case Command::FromAbove: {
            // If most of the DEM is in view, all of it stays in view.
            const double away_m = distance(pose.eye_m, middle);
            const Whole all = whole();
            const bool is_low = away_m < kNear * distance(all.above.eye_m, middle);
            const bool sees_all = all.in_view > 0.5 && !is_low;
            pose = sees_all ? all.above : from_above(pose, state_.land, middle, away_m);
            return true;
        }
        case Command::Walk:
            return walk_or_fly();
        default:
            return false;
    }
}

/// The clicked point, unless the last walk began there; else below a low eye; else the ground in
/// the middle of the image.
std::optional<glm::dvec3> Hand::start_of_walk() {
    const std::optional<geo::Geodetic>& chosen = state_.chosen;
    const bool is_new = chosen && !(walked_from_ && walked_from_->lat_rad == chosen->lat_rad &&
                                    walked_from_->lon_rad == chosen->lon_rad);
    walked_from_ = chosen;
    if (is_new) return state_.land.frame->to_local(*chosen);
    if (height_above_ground() < kLow_m) return state_.document.pose.eye_m;
    return ground_at(0.5f * window_.size());
}

bool Hand::walk_or_fly() {
    if (walking_) {
        walking_ = false;
        return true;
    }
    const std::optional<glm::dvec3> start = start_of_walk();
    return start && stand_at(*start);
}

bool Hand::stand_at(const glm::dvec3& point_m) {
    const std::optional<Pose> standing = stand(state_.document.pose, state_.land, point_m);
    if (!standing) return false;
    stop_gliding();
    state_.document.pose = *standing;
    walking_ = true;
    return true;
}

glm::dvec2 Hand::in_view(glm::vec2 at_px) const {
    return viewer::in_view(at_px, window_.size());
}

/// Ground in the displayed frame.
std::optional<glm::dvec3> Hand::ground_at(glm::vec2 at_px) const {
    if (!picture_) return std::nullopt;
    const int x =
        static_cast<int>(at_px.x / window_.size().x * static_cast<float>(picture_->width_px));
    const int y = static_cast<int>((1 - at_px.y / window_.size().y) *
                                   static_cast<float>(picture_->height_px));
    if (x < 0 || y < 0 || x >= picture_->width_px || y >= picture_->height_px) return std::nullopt;
    const float depth_m = picture_->depth_m(x, y);
    if (std::isinf(depth_m)) return std::nullopt;
    const glm::dvec3 direction = ray(picture_->camera, in_view(at_px), aspect());
    return picture_->camera.eye_m + depth_m / dot(direction, picture_->camera.forward) * direction;
}

/// The point that the mouse grabs: the ground under it, else on a horizontal plane through the
/// ground at the centre, else a point ahead.
glm::dvec3 Hand::hold(glm::vec2 at_px) const {
    if (const auto ground = ground_at(at_px)) return *ground;
    if (const auto middle = ground_at(0.5f * window_.size())) {
        const glm::dvec3 direction = ray(picture_->camera, in_view(at_px), aspect());
        const glm::dvec3 up = state_.land.axes(*middle).up;
        const double falls = -dot(direction, up);
        const double above_m = dot(picture_->camera.eye_m - *middle, up);
        if (falls > 0.05 && above_m > 0)
            return picture_->camera.eye_m + above_m / falls * direction;
        return *middle;
    }
    const scene::Camera camera = camera_of(state_.document.pose, state_.land);
    return camera.eye_m + std::max(100.0, height_above_ground()) * 3 * camera.forward;
}

double Hand::height_above_ground() const {
    const glm::dvec3& eye_m = state_.document.pose.eye_m;
    const double ground_m = state_.land.ground_under(eye_m);
    const double height_m = state_.land.frame->to_geodetic(eye_m).height_m;
    return std::max(2.0, std::isnan(ground_m) ? height_m : height_m - ground_m);
}

void Hand::press(glm::vec2 mouse, bool comparing) {
    const ImGuiIO& io = ImGui::GetIO();
    for (const int button : {0, 1, 2}) {
        if (!ImGui::IsMouseClicked(button)) continue;
        pressed_px_ = last_px_ = mouse;
        held_ = hold(mouse);
        dragging_ = button == 1 || (button == 0 && io.KeyShift) ? Drag::Orbit
                    : button == 2                               ? Drag::Look
                                                                : Drag::Pan;
        if (button == 0 && picture_ && !ground_at(mouse) &&
            time_at(state_, *picture_, window_.size(), mouse))
            dragging_ = Drag::Sun;
        if (button == 0 && comparing &&
            std::abs(mouse.x - window_.line() * window_.size().x) < kLine_px)
            dragging_ = Drag::Line;
        stop_gliding();
    }
}

void Hand::drag(glm::vec2 mouse, double passed_s) {
    if (!dragging_) return;
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) {
        const bool click = distance(mouse, pressed_px_) < kClick_px;
        const bool right = *dragging_ == Drag::Orbit;
        if (click && (right || *dragging_ == Drag::Pan)) {
            clicked_ = Click{ground_at(mouse), right};
            if (clicked_->point_m && std::isnan(drawn_height_m(*clicked_->point_m)))
                clicked_->point_m.reset();
        }
        dragging_.reset();
        return;
    }
    // Ignores rounding while the mouse is still, so that drawing can end.
    const bool is_still = mouse == last_px_;
    const glm::dvec2 by = glm::dvec2(mouse - last_px_) / static_cast<double>(window_.size().y);
    last_px_ = mouse;
    Pose& pose = state_.document.pose;
    switch (*dragging_) {
        case Drag::Pan:
            if (!is_still && distance(mouse, pressed_px_) >= kClick_px)
                pose = pan(pose, state_.land, held_, in_view(mouse), aspect());
            break;
        case Drag::Orbit: {
            const glm::dvec2 turn{-by.x * 200, by.y * 120};
            if (!is_still) pose = orbit(pose, state_.land, held_, turn.x, turn.y);
            if (passed_s > 0) glide_deg_a_s_ = 0.5 * glide_deg_a_s_ + 0.5 * turn / passed_s;
            break;
        }
        case Drag::Look:
            if (is_still) break;
            pose =
                look_around(pose, -by.x * degrees(pose.fov_y_rad), by.y * degrees(pose.fov_y_rad));
            break;
        case Drag::Sun:
            drag_sun(mouse);
            break;
        case Drag::Line:
            window_.set_line(std::clamp(mouse.x / window_.size().x, 0.02f, 0.98f));
            break;
    }
}

void Hand::drag_sun(glm::vec2 mouse) {
    if (!picture_) return;
    const auto utc = time_at(state_, *picture_, window_.size(), mouse);
    if (!utc || *utc == state_.document.utc) return;
    state_.set_utc(*utc);
    state_.sun_moves = true;
}

void Hand::fly_by_keys(double passed_s) {
    const auto axis = [&](int plus, int minus) {
        return (window_.is_down(plus) ? 1.0 : 0.0) - (window_.is_down(minus) ? 1.0 : 0.0);
    };
    const glm::dvec3 by(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_W, GLFW_KEY_S),
                        axis(GLFW_KEY_E, GLFW_KEY_Q));
    const glm::dvec2 turn(axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT), axis(GLFW_KEY_UP, GLFW_KEY_DOWN));
    const double nearer = axis(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN);
    keys_held_ = by != glm::dvec3(0) || turn != glm::dvec2(0) || nearer != 0;
    if (!keys_held_) return;
    Pose& pose = state_.document.pose;
    const double fast = ImGui::GetIO().KeyShift ? 4 : 1;
    if (walking_)
        pose = walk(pose, state_.land, glm::dvec2(by) * (3 * fast * passed_s));
    else
        pose = fly(pose, state_.land, by * (height_above_ground() * fast * passed_s));
    if (turn != glm::dvec2(0))
        pose = orbit(pose, state_.land, hold(0.5f * window_.size()), turn.x * 45 * passed_s,
                     turn.y * 30 * passed_s);
    if (nearer != 0)
        pose = zoom(pose, state_.land, hold(0.5f * window_.size()), std::exp(-nearer * passed_s));
}

void Hand::hover(glm::vec2 mouse) {
    const auto point = ImGui::GetIO().WantCaptureMouse ? std::nullopt : ground_at(mouse);
    if (!point) {
        state_.cursor.reset();
        return;
    }
    Cursor cursor;
    cursor.point_m = *point;
    cursor.place = state_.land.frame->to_geodetic(*point);
    cursor.place.height_m = drawn_height_m(*point);
    if (!std::isnan(cursor.place.height_m)) slope_at(cursor);
    state_.cursor = cursor;
}

/// viewer::drawn_height_m() with a tolerance for coarse levels of detail.
double Hand::drawn_height_m(const glm::dvec3& point_m) const {
    const double px_m = 2 * std::tan(picture_->camera.fov_y_rad / 2) / window_.size().y *
                        distance(picture_->camera.eye_m, point_m);
    return viewer::drawn_height_m(
        point_m, state_.land,
        height_tolerance_m(picture_->sharp, state_.is_outside, px_m, state_.spacing_m));
}

/// From central differences over one post spacing.
void Hand::slope_at(Cursor& cursor) const {
    const double reach_m = state_.spacing_m;
    const geo::Axes axes = state_.land.axes(cursor.point_m);
    const glm::dvec3 here_m = cursor.point_m;
    const auto height = [&](const glm::dvec3& by_m) {
        return state_.land.height_m(state_.land.frame->to_geodetic(here_m + by_m));
    };
    const double east =
        (height(axes.east * reach_m) - height(-axes.east * reach_m)) / (2 * reach_m);
    const double north =
        (height(axes.north * reach_m) - height(-axes.north * reach_m)) / (2 * reach_m);
    cursor.slope_deg = degrees(std::atan(std::hypot(east, north)));
    cursor.aspect_deg = east == 0 && north == 0 ? std::nan("") : degrees(std::atan2(-east, -north));
    if (cursor.aspect_deg < 0) cursor.aspect_deg += 360;
}

}  // namespace relevo::viewer

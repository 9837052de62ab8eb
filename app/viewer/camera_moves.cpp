#include "viewer/camera_moves.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "base/units.h"
#include "sun/moon.h"
#include "viewer/translation.h"

namespace relevo::viewer {

void CameraMoves::move(Command command) {
    constexpr double kHour_s = 3600, kDay_s = 86400;
    parts_.history.end_step(parts_.state.document);
    const auto by = [&](double seconds) {
        parts_.state.set_utc(parts_.state.document.utc + seconds);
    };
    if (command == Command::Now)
        parts_.state.set_utc(sun::Instant::now());
    else if (command == Command::Earlier)
        by(-kHour_s / 2);
    else if (command == Command::Later)
        by(kHour_s / 2);
    else if (command == Command::DayEarlier)
        by(-kDay_s);
    else if (command == Command::DayLater)
        by(kDay_s);
    else if (command == Command::StandHere || command == Command::LookThere)
        move_to_point(command);
    else if (command == Command::LookToMoon)
        look_to_moon(/*is_up=*/false);
    else if (!parts_.hand.move(command, [this] { return whole_views(); })) {
        if (command == Command::Walk)
            parts_.messages.note(tr("no ground to walk on here; click a point, then press G"));
        return;
    }
    if (command == Command::Whole) note_home();
    if (command == Command::Walk || command == Command::StandHere)
        parts_.messages.note(
            parts_.hand.is_walking()
                ? tr("walking at eye height: W A S D, faster with Shift; G flies again")
                : tr("flying: W A S D, Q down and E up, faster with Shift"));
    parts_.pacing.moved();
    parts_.state.step = true;
}

void CameraMoves::move_to_point(Command command) {
    if (!parts_.state.chosen) return parts_.messages.note(tr("click a point on the ground first"));
    const glm::dvec3 point_m = drawn_m(*parts_.state.chosen);
    if (std::isnan(point_m.z)) return;
    if (command == Command::StandHere)
        parts_.hand.stand_at(point_m);
    else
        parts_.state.document.pose = facing(parts_.state.document.pose, parts_.state.land, point_m);
}

void CameraMoves::look_to_moon(bool is_up) {
    Pose& pose = parts_.state.document.pose;
    geo::Geodetic eye = view_of(pose, parts_.state.land).eye->place;
    // The heights that sun::moon_position() takes. 100 km turn the moon by 0.015 degrees at most.
    eye.height_m = std::clamp(eye.height_m, 0.0, 100e3);
    const sun::MoonPosition moon = sun::moon_position(parts_.state.document.utc, eye);
    const double elevation_rad = parts_.state.air.apparent_rad(moon.elevation_rad);
    if (elevation_rad < 0 && !is_up)
        return parts_.messages.note(
            tr("the moon is below the horizon; Sun, Next moonrise goes to a time when it rises"));
    // In the middle of what the panels leave free: so far to the right and up [tangents].
    const glm::vec2 window = parts_.window.size();
    const scene::Insets insets = parts_.state.layout.insets(window);
    const double tan_y = std::tan(pose.fov_y_rad / 2);
    const double x = tan_y * window.x / window.y * (insets.left - insets.right);
    const double y = tan_y * (insets.bottom - insets.top);
    const double sine = std::sin(elevation_rad) * std::sqrt(1 + x * x / (1 + y * y));
    const double pitch_rad = std::asin(std::min(sine, 1.0)) - std::atan(y);
    pose.pitch_deg = degrees(pitch_rad);
    pose.heading_deg =
        degrees(moon.azimuth_rad - std::atan2(x, std::cos(pitch_rad) - y * std::sin(pitch_rad)));
}

void CameraMoves::ask_over_point(sun::Body body, const std::optional<geo::Geodetic>& point) {
    const geo::Geodetic eye = view_of(parts_.state.document.pose, parts_.state.land).eye->place;
    if (parts_.opening.is_preview()) return;
    if (std::isnan(parts_.state.land.height_m(eye)))
        return parts_.messages.note(
            tr("the eye is outside the DEM: right click, Stand here, then ask"));
    const Opened& opened = *parts_.opening.opened();
    if (!sun_over_.ask({opened.dem, opened.scene, eye, point, parts_.state.document.utc,
                        parts_.state.document.zone, body}))
        parts_.messages.note(tr("still looking for the time that was asked for before"));
}

void CameraMoves::poll_sun_over() {
    parts_.messages.try_to([&] {
        const Opened* const opened = parts_.opening.opened().get();
        const std::optional<SunOverAnswer> answer = sun_over_.poll(opened ? opened->dem : nullptr);
        if (!answer) return;
        if (answer->utc) {
            parts_.state.set_utc(*answer->utc);
            parts_.state.step = true;
        }
        if (answer->looks_to_moon) {
            look_to_moon(/*is_up=*/true);
            parts_.pacing.moved();
        }
        parts_.messages.note(answer->words);
        parts_.pacing.need_frames(3);
    });
}

Whole CameraMoves::whole_views() const {
    scene::View above;
    above.orbit = {.azimuth_deg = 180, .elevation_deg = 90};
    above.fov_y_rad = parts_.state.document.pose.fov_y_rad;
    Whole whole{pose_in(parts_.opening.home_view()), pose_in(above)};
    // The vertical at the camera differs from that at the DEM's centre.
    whole.above = from_above(whole.above, parts_.state.land, whole.above.eye_m, 0);
    const std::vector<glm::dvec3>& ground = parts_.opening.opened()->outline.points;
    const auto visible = std::ranges::count_if(
        ground, [&](const glm::dvec3& point_m) { return is_in_view(point_m); });
    whole.in_view = static_cast<double>(visible) / std::max<std::size_t>(ground.size(), 1);
    return whole;
}

bool CameraMoves::is_in_view(const glm::dvec3& point_m) const {
    const glm::vec2 window = parts_.window.size();
    const auto at = in_picture(camera_of(parts_.state.document.pose, parts_.state.land), point_m,
                               static_cast<double>(window.x) / window.y);
    return at && std::abs(at->x) < 1 && std::abs(at->y) < 1;
}

void CameraMoves::go_to_view(std::size_t i) {
    if (i >= parts_.state.views.size()) {
        parts_.messages.note(tr_format("this DEM has no saved view {}; B saves one", i + 1));
        return;
    }
    const SavedView& view = parts_.state.views[i];
    parts_.history.end_step(parts_.state.document);
    parts_.hand.rest();
    parts_.state.document.pose = pose_of(view, parts_.state.land);
    parts_.state.set_utc(view.utc);
    parts_.pacing.moved();
    parts_.state.step = true;
}

void CameraMoves::go_to_place(const FoundPlace& found) {
    geo::Geodetic place = found.place;
    place.height_m = parts_.state.land.height_m(place);
    if (std::isnan(place.height_m))
        return parts_.messages.note(
            tr_format("the DEM has no ground at {}: {}", found.name, found.details));
    parts_.history.end_step(parts_.state.document);
    look_down_at(place);
    choose_point(drawn_m(place));
}

glm::dvec3 CameraMoves::drawn_m(geo::Geodetic place) const {
    place.height_m = parts_.state.land.ground_under(parts_.state.land.frame->to_local(place));
    return parts_.state.land.frame->to_local(place);
}

void CameraMoves::show(const FilePlace& place) {
    if (place.on_dem.empty()) return;
    constexpr std::size_t kMostTried = 1000;  // of a track's vertices
    for (std::size_t i = 0; i < place.on_dem.size(); i += 1 + place.on_dem.size() / kMostTried)
        if (is_in_view(drawn_m(place.on_dem[i]))) return;
    look_down_at(place.middle());
}

void CameraMoves::look_down_at(const geo::Geodetic& place) {
    const glm::dvec3 point_m = drawn_m(place);
    if (std::isnan(point_m.z)) return;  // a void
    parts_.hand.rest();
    // At this many post spacings single posts are visible.
    constexpr double kPosts = 150;
    Pose& pose = parts_.state.document.pose;
    pose = look_at(pose, parts_.state.land, point_m,
                   std::min(distance(pose.eye_m, point_m), kPosts * parts_.state.spacing_m));
    parts_.pacing.moved();
    parts_.state.step = true;
}

void CameraMoves::choose_point(const glm::dvec3& point_m) {
    if (parts_.point.choose(point_m)) parts_.state.measurement.start(point_m);
}

void CameraMoves::go_home() {
    parts_.state.document.pose = pose_in(parts_.opening.home_view());
    note_home();
}

void CameraMoves::note_home() {
    home_ = parts_.state.document.pose;
    home_size_ = parts_.window.size();
}

void CameraMoves::fit_home() {
    if (home_size_ == parts_.window.size()) return;
    home_size_ = parts_.window.size();
    if (!is_home()) return;
    go_home();
    parts_.pacing.moved();
}

Pose CameraMoves::pose_in(const scene::View& view) const {
    const double aspect = static_cast<double>(parts_.window.size().x) / parts_.window.size().y;
    return pose_of(parts_.opening.opened()->camera(
                       view, aspect, parts_.state.layout.insets(parts_.window.size())),
                   parts_.state.land);
}

}  // namespace relevo::viewer

#include "viewer/viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include "base/error.h"
#include "base/log.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/units.h"
#include "geo/format.h"
#include "geo/geodetic.h"
#include "image/image.h"
#include "session/session.h"
#include "sun/zone_of_place.h"
#include "viewer/file_dialog.h"
#include "viewer/file_watch.h"
#include "viewer/overlay.h"
#include "viewer/state.h"
#include "viewer/window.h"

namespace relevo::viewer {

namespace {

using Clock = std::chrono::steady_clock;

constexpr float kPanel_px = 360;
/// After the last input the hand counts as moving for so long.
constexpr double kRest_s = 0.15;
/// What comes after so long is another step of undo.
constexpr double kStep_s = 0.5;
/// Files are looked at again so often.
constexpr double kWatch_s = 1;
constexpr float kLine_px = 8;    // beside the line of a comparison that take hold of it
constexpr double kClick_px = 4;  // that a click may move by
/// The last turn of the wheel and the last pull of the hand die away so fast [1/s].
constexpr double kZoomRate = 14, kGlideRate = 7;

double seconds_since(Clock::time_point began) {
    return std::chrono::duration<double>(Clock::now() - began).count();
}

/// A name in the working folder that no file has: relevo-1.png.
std::string free_name(const std::string& ending) {
    for (int n = 1;; ++n) {
        const std::string name = fmt::format("relevo-{}.{}", n, ending);
        std::error_code ignored;
        if (!std::filesystem::exists(name, ignored)) return name;
    }
}

/// The window's whole life.
class Viewer {
  public:
    Viewer(const scene::Scene& scene, std::string device)
        : device_(std::move(device)), zone_(scene.moment.zone) {
        state_.document.scene = scene;
        Window::check_display();
        // The scene opens beside the window.
        scene_ = std::make_unique<SceneThread>(scene, device_, &Window::wake);
        window_ = std::make_unique<Window>("Relevo");
        state_.effects = EffectsModel::of(scene.effects);
        want_size();
    }

    void run() {
        while (!window_->should_close()) {
            const double most_s = waiting_s();
            const auto waits_from = Clock::now();
            window_->wait(most_s);
            // Panels take in a frame what has come before it, and show it in the next.
            const bool input = most_s >= kWatch_s && seconds_since(waits_from) < most_s;
            if (input) busy_frames_ = std::max(busy_frames_, 3);
            const double passed_s = seconds_since(frame_at_);
            frame_at_ = Clock::now();
            read_thread();
            if (is_open()) {
                keys();
                navigate(std::min(passed_s, 0.1));
                pass_time(std::min(passed_s, 0.5));
                want_view();  // before the panels are drawn, which takes its time too
            }
            open_files();
            watch_files();
            step_at_rest();
            if (most_s >= kWatch_s && busy_frames_ == 0) continue;
            window_->draw([&] { panels(); });
            state_.take_effects(/*is_step=*/true);
            if (is_open()) hand_over();
        }
    }

  private:
    bool is_open() const { return opened_ != nullptr; }

    void open() {
        // What works on the ground before ends first.
        if (state_.point_in_work.valid()) state_.point_in_work.wait();
        state_.point_in_work = {};
        state_.point.reset();
        state_.measured.clear();
        state_.profile.reset();
        state_.cursor.reset();
        opened_ = nullptr;
        picture_ = nullptr;
        wanted_.reset();
        dragging_.reset();
        stop_gliding();
        walking_ = keys_held_ = false;
        history_ = {};  // poses are of the other ground
        stop_comparing();
        scene_.reset();
        scene_ = std::make_unique<SceneThread>(state_.document.scene, device_, &Window::wake);
        want_size();
    }

    /// From now on the left of the line is drawn with the effects as they are now.
    void compare() {
        scene::Scene scene = whole_scene();
        before_ = std::make_unique<SceneThread>(scene, device_, &Window::wake);
        before_->want(wanted_now());
    }

    void stop_comparing() {
        before_.reset();
        picture_before_ = nullptr;
        window_->take_before(nullptr);
        state_.compare_is_wanted = false;
    }

    void want_size() {
        const glm::ivec2 size = window_->size_px();
        Wanted wanted;
        wanted.width_px = size.x;
        wanted.height_px = size.y;
        scene_->want(wanted);
    }

    /// How long nothing but input can change what is seen.
    double waiting_s() const {
        if (busy_frames_ > 0 || state_.playing || glides() || keys_held_) return 0.008;
        if (!rested_) return 0.05;
        return kWatch_s;
    }

    void stop_gliding() {
        zoom_left_ = 0;
        glide_deg_a_s_ = {};
    }

    bool glides() const { return std::abs(zoom_left_) > 1e-3 || length(glide_deg_a_s_) > 0.5; }

    void read_thread() {
        if (has_failed_) return;
        try {
            scene_->check();
        } catch (const std::exception& error) {
            if (!last_good_) throw;  // what the program was started for
            go_back(error.what());
            return;
        }
        if (!is_open())
            if (auto opened = scene_->opened()) start(std::move(opened));
        if (const auto newer = scene_->newer_than(picture_ ? picture_->number : 0)) {
            picture_ = newer;
            window_->take(*newer);
            busy_frames_ = std::max(busy_frames_, 1);
        }
        if (before_) watch_comparison();
        if (before_)
            if (const auto newer =
                    before_->newer_than(picture_before_ ? picture_before_->number : 0)) {
                picture_before_ = newer;
                window_->take_before(newer.get());
                busy_frames_ = std::max(busy_frames_, 1);
            }
        if (auto message = scene_->take_message()) {
            state_.message = std::move(*message);
            busy_frames_ = 2;
        }
        if (state_.point_in_work.valid() &&
            state_.point_in_work.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
            state_.point = state_.point_in_work.get();
            busy_frames_ = 2;
        }
    }

    void watch_comparison() {
        try {
            before_->check();
            if (auto message = before_->take_message()) state_.message = std::move(*message);
        } catch (const std::exception& error) {
            state_.message = fmt::format("no comparison: {}", error.what());
            stop_comparing();
        }
    }

    /// To what was open before, once: it may be gone as well.
    void go_back(std::string why) {
        state_.message = std::move(why);
        busy_frames_ = 3;
        has_failed_ = has_gone_back_;
        if (has_failed_) return;
        has_gone_back_ = true;
        state_.document.scene = *last_good_;
        open();
    }

    /// The scene has been opened: from here on it can be moved in.
    void start(std::shared_ptr<const Opened> opened) {
        opened_ = std::move(opened);
        const session::Session& session = *opened_->session;
        const scene::Scene& scene = opened_->scene;
        state_.land.frame = &session.ground().frame;
        state_.land.exaggeration = scene.exaggeration;
        state_.land.height_m = [&session](const geo::Geodetic& at) {
            return session.ground_height_m(at);
        };
        state_.stand_on(session.ground());
        Document& document = state_.document;
        document.zone = sun::choose_zone(zone_, state_.centre).zone;
        document.pose = home_ = pose_of(opened_->camera, state_.land);
        state_.set_utc(last_good_ ? document.utc : opened_->utc);
        history_.add(document);
        window_->set_title(fmt::format("{} - Relevo", scene.dems.front()));
        last_good_ = document.scene;
        has_gone_back_ = false;
        std::vector<std::filesystem::path> dems;
        std::error_code ignored;
        for (const std::string& dem : scene.dems)
            if (std::filesystem::is_regular_file(dem, ignored)) dems.emplace_back(dem);
        dem_files_.watch(std::move(dems));
        std::vector<std::filesystem::path> plugins{share_dir() / "plugins"};
        plugins.insert(plugins.end(), scene.effects.plugin_path.begin(),
                       scene.effects.plugin_path.end());
        effect_files_.watch(std::move(plugins));
        busy_frames_ = 3;
    }

    // ---- the hand

    /// Of the window, in the mouse's units.
    glm::vec2 size() const { return window_->size(); }
    double aspect() const { return static_cast<double>(size().x) / size().y; }

    /// From the window's pixels to -1 to 1.
    glm::dvec2 in_view(glm::vec2 at_px) const {
        return {2 * at_px.x / size().x - 1, 1 - 2 * at_px.y / size().y};
    }

    /// The ground of the picture that is shown.
    std::optional<glm::dvec3> ground_at(glm::vec2 at_px) const {
        if (!picture_) return std::nullopt;
        const int x = static_cast<int>(at_px.x / size().x * static_cast<float>(picture_->width_px));
        const int y =
            static_cast<int>((1 - at_px.y / size().y) * static_cast<float>(picture_->height_px));
        if (x < 0 || y < 0 || x >= picture_->width_px || y >= picture_->height_px)
            return std::nullopt;
        const float depth_m =
            picture_->depths_m[static_cast<std::size_t>(y * picture_->width_px + x)];
        if (std::isinf(depth_m)) return std::nullopt;
        const glm::dvec3 direction = ray(picture_->camera, in_view(at_px), aspect());
        return picture_->camera.eye_m +
               depth_m / dot(direction, picture_->camera.forward) * direction;
    }

    /// What the hand takes hold of: the ground there, else where that of the middle would be if it
    /// were level, else some way ahead.
    glm::dvec3 hold(glm::vec2 at_px) const {
        if (const auto ground = ground_at(at_px)) return *ground;
        if (const auto middle = ground_at(0.5f * size())) {
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

    double height_above_ground() const {
        const glm::dvec3& eye_m = state_.document.pose.eye_m;
        const double ground_m = state_.land.ground_under(eye_m);
        const double height_m = state_.land.frame->to_geodetic(eye_m).height_m;
        return std::max(2.0, std::isnan(ground_m) ? height_m : height_m - ground_m);
    }

    void moved() {
        moved_at_ = Clock::now();
        rested_ = false;
    }

    void navigate(double passed_s) {
        const ImGuiIO& io = ImGui::GetIO();
        const glm::vec2 mouse = window_->mouse();
        Pose& pose = state_.document.pose;
        const Pose before = pose;
        if (!io.WantCaptureMouse) {
            press(mouse);
            if (io.MouseWheel != 0) {
                zoom_at_ = hold(mouse);
                zoom_left_ += io.MouseWheel * 0.25;
            }
        }
        drag(mouse, passed_s);
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
        fly_by_keys(passed_s);
        if (pose.eye_m != before.eye_m || pose.heading_deg != before.heading_deg ||
            pose.pitch_deg != before.pitch_deg)
            moved();
        hover(mouse);
    }

    enum class Drag { Pan, Orbit, Look, Sun, Line };

    void press(glm::vec2 mouse) {
        const ImGuiIO& io = ImGui::GetIO();
        for (const int button : {0, 1, 2}) {
            if (!ImGui::IsMouseClicked(button)) continue;
            pressed_px_ = last_px_ = mouse;
            held_ = hold(mouse);
            dragging_ = button == 1 || (button == 0 && io.KeyShift) ? Drag::Orbit
                        : button == 2                               ? Drag::Look
                                                                    : Drag::Pan;
            if (button == 0 && picture_ && !ground_at(mouse) &&
                moment_at(state_, *picture_, size(), mouse))
                dragging_ = Drag::Sun;
            if (button == 0 && before_ && std::abs(mouse.x - window_->line() * size().x) < kLine_px)
                dragging_ = Drag::Line;
            stop_gliding();
        }
    }

    void drag(glm::vec2 mouse, double passed_s) {
        if (!dragging_) return;
        const ImGuiIO& io = ImGui::GetIO();
        if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) {
            const bool click = distance(mouse, pressed_px_) < kClick_px;
            if (click && *dragging_ == Drag::Pan) choose_point(mouse);
            dragging_.reset();
            return;
        }
        const glm::dvec2 by = glm::dvec2(mouse - last_px_) / static_cast<double>(size().y);
        last_px_ = mouse;
        Pose& pose = state_.document.pose;
        switch (*dragging_) {
            case Drag::Pan:
                if (distance(mouse, pressed_px_) >= kClick_px)
                    pose = pan(pose, state_.land, held_, in_view(mouse), aspect());
                break;
            case Drag::Orbit: {
                const glm::dvec2 turn{-by.x * 200, by.y * 120};
                pose = orbit(pose, state_.land, held_, turn.x, turn.y);
                if (passed_s > 0) glide_deg_a_s_ = 0.5 * glide_deg_a_s_ + 0.5 * turn / passed_s;
                break;
            }
            case Drag::Look:
                pose = look_around(pose, -by.x * degrees(pose.fov_y_rad),
                                   by.y * degrees(pose.fov_y_rad));
                break;
            case Drag::Sun:
                drag_sun(mouse);
                state_.sun_moves = true;
                break;
            case Drag::Line:
                window_->set_line(std::clamp(mouse.x / size().x, 0.02f, 0.98f));
                break;
        }
    }

    void drag_sun(glm::vec2 mouse) {
        if (!picture_) return;
        if (const auto utc = moment_at(state_, *picture_, size(), mouse)) state_.set_utc(*utc);
    }

    void fly_by_keys(double passed_s) {
        const auto axis = [&](int plus, int minus) {
            return (window_->is_down(plus) ? 1.0 : 0.0) - (window_->is_down(minus) ? 1.0 : 0.0);
        };
        const glm::dvec3 by(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_W, GLFW_KEY_S),
                            axis(GLFW_KEY_E, GLFW_KEY_Q));
        const glm::dvec2 turn(axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT),
                              axis(GLFW_KEY_UP, GLFW_KEY_DOWN));
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
            pose = orbit(pose, state_.land, hold(0.5f * size()), turn.x * 45 * passed_s,
                         turn.y * 30 * passed_s);
        if (nearer != 0)
            pose = zoom(pose, state_.land, hold(0.5f * size()), std::exp(-nearer * passed_s));
    }

    void hover(glm::vec2 mouse) {
        const auto point = ImGui::GetIO().WantCaptureMouse ? std::nullopt : ground_at(mouse);
        if (!point) {
            state_.cursor.reset();
            return;
        }
        Cursor cursor;
        cursor.point_m = *point;
        cursor.place = state_.land.frame->to_geodetic(*point);
        const double height_m = state_.land.height_m(cursor.place);
        cursor.place.height_m =
            std::isnan(height_m) ? cursor.place.height_m / state_.land.exaggeration : height_m;
        slope_at(cursor);
        state_.cursor = cursor;
    }

    /// By central differences over a post spacing each way.
    void slope_at(Cursor& cursor) const {
        const glm::dvec2 spacing_m = opened_->session->heightfield().grid.post_spacing_m();
        const double reach_m = std::sqrt(spacing_m.x * spacing_m.y);
        const geo::Axes axes = state_.land.axes(cursor.point_m);
        const glm::dvec3 here_m = state_.land.frame->to_local(cursor.place);
        const auto height = [&](const glm::dvec3& by_m) {
            return state_.land.height_m(state_.land.frame->to_geodetic(here_m + by_m));
        };
        const double east =
            (height(axes.east * reach_m) - height(-axes.east * reach_m)) / (2 * reach_m);
        const double north =
            (height(axes.north * reach_m) - height(-axes.north * reach_m)) / (2 * reach_m);
        cursor.slope_deg = degrees(std::atan(std::hypot(east, north)));
        cursor.aspect_deg =
            east == 0 && north == 0 ? std::nan("") : degrees(std::atan2(-east, -north));
        if (cursor.aspect_deg < 0) cursor.aspect_deg += 360;
    }

    void choose_point(glm::vec2 mouse) {
        const auto point = ground_at(mouse);
        if (!point || state_.point_in_work.valid()) return;
        geo::Geodetic place = state_.land.frame->to_geodetic(*point);
        place.height_m = state_.land.height_m(place);
        if (std::isnan(place.height_m)) return;
        state_.measured = {*point};
        state_.profile.reset();
        work_out_light(place);
    }

    void work_out_light(const geo::Geodetic& place) {
        const Document& document = state_.document;
        state_.point = PointLight{.place = place, .date = {}, .lit = {}, .error = {}};
        state_.point_in_work =
            light_at(place, document.zone.local(document.utc).wall.date, document.zone,
                     document.scene, opened_->session->heightfield());
    }

    // ---- keys

    void keys() {
        for (const KeyPress& press : window_->take_keys()) {
            busy_frames_ = 3;
            if (press.control)
                with_control(press);
            else
                plain(press);
        }
    }

    void with_control(const KeyPress& press) {
        if (press.key == GLFW_KEY_C) copy_command();
        if (press.key == GLFW_KEY_S) save_scene();
        if (press.key == GLFW_KEY_O) ask_for_dem();
        if (press.key == GLFW_KEY_Q) window_->close();
        if (press.key == GLFW_KEY_Z && history_.differs(state_.document))
            history_.add(state_.document);
        const bool redo = press.key == GLFW_KEY_Y || (press.key == GLFW_KEY_Z && press.shift);
        if (redo && history_.can_redo())
            go_to(history_.redo());
        else if (press.key == GLFW_KEY_Z && !press.shift && history_.can_undo())
            go_to(history_.undo());
    }

    void plain(const KeyPress& press) {
        switch (press.key) {
            case GLFW_KEY_H:
                sheet_ = !sheet_;
                break;
            case GLFW_KEY_ESCAPE:
                sheet_ = false;
                break;
            case GLFW_KEY_TAB:
                panels_ = !panels_;
                break;
            case GLFW_KEY_SPACE:
                state_.playing = !state_.playing;
                break;
            case GLFW_KEY_C:
                state_.compare_is_wanted = !state_.compare_is_wanted;
                break;
            case GLFW_KEY_M:
                measure();
                break;
            case GLFW_KEY_F5:
                read_again();
                break;
            case GLFW_KEY_F12:
                take_picture();
                break;
            default:
                move_by_key(press);
        }
    }

    void move_by_key(const KeyPress& press) {
        Pose& pose = state_.document.pose;
        constexpr double kHour_s = 3600, kDay_s = 86400;
        const double step_s = press.shift ? kDay_s : kHour_s / 2;
        const glm::dvec3 middle = hold(0.5f * size());
        // What the hand has done before is a step of its own.
        if (history_.differs(state_.document)) history_.add(state_.document);
        stop_gliding();
        if (press.key == GLFW_KEY_LEFT_BRACKET) {
            state_.set_utc(state_.document.utc - step_s);
        } else if (press.key == GLFW_KEY_RIGHT_BRACKET) {
            state_.set_utc(state_.document.utc + step_s);
        } else if (press.key == GLFW_KEY_HOME) {
            pose = home_;
        } else if (press.key == GLFW_KEY_N) {
            pose = orbit(pose, state_.land, middle, pose.heading_deg, 0);
            pose.heading_deg = 0;
        } else if (press.key == GLFW_KEY_T) {
            pose = from_above(pose, state_.land, middle, distance(pose.eye_m, middle));
        } else if (press.key == GLFW_KEY_G) {
            walking_ = !walking_;
            if (walking_) pose = walk(pose, state_.land, {0, 0});
        } else {
            return;
        }
        moved();
        state_.step = true;
    }

    void measure() {
        if (!state_.cursor) return;
        if (state_.measured.size() != 1) {
            state_.measured = {state_.cursor->point_m};
            state_.profile.reset();
            return;
        }
        const geo::Geodetic from = state_.land.frame->to_geodetic(state_.measured[0]);
        state_.measured.push_back(state_.cursor->point_m);
        state_.profile = Profile::between(from, state_.cursor->place, state_.land);
    }

    void go_to(const Document& document) {
        stop_gliding();
        const bool other_effects = scene::scene_text(with_effects(document), "") !=
                                   scene::scene_text(with_effects(state_.document), "");
        state_.document = document;
        state_.set_utc(document.utc);
        if (other_effects) {
            state_.set_effects(document.scene.effects);
            state_.take_effects(/*is_step=*/false);
        }
        moved();
    }

    /// Of a document only what its effects are.
    static scene::Scene with_effects(const Document& document) {
        scene::Scene scene;
        scene.effects = document.scene.effects;
        return scene;
    }

    // ---- taking it away

    scene::Scene whole_scene() const {
        scene::Scene scene = state_.document.whole(state_.land);
        const glm::ivec2 size = window_->size_px();
        scene.width_px = size.x;
        scene.height_px = size.y;
        for (std::string& dem : scene.dems) {
            std::error_code ignored;
            if (std::filesystem::exists(dem, ignored))
                dem = std::filesystem::absolute(dem).lexically_normal().string();
        }
        return scene;
    }

    void copy_command() {
        window_->copy(capture_command(whole_scene(), "picture.png"));
        state_.message = "the command that takes this picture is on the clipboard";
    }

    void save_scene() {
        say_or_fail([&] {
            const std::string name = free_name("json");
            write_text(name, scene::scene_text(whole_scene(), ""), /*overwrite=*/false, "view");
            return name + " has the scene; relevo view --scene opens it";
        });
    }

    /// Whether the picture is what was wanted last.
    bool is_answered() const {
        return picture_ && picture_->sharp && picture_->answers == scene_->wants() && wanted_ &&
               same(*wanted_, wanted_now());
    }

    void take_picture() {
        if (!is_answered()) {
            takes_when_sharp_ = true;
            return;
        }
        say_or_fail([&] {
            const std::string name = free_name("png");
            OutputFile file(name, /*overwrite=*/false, "view");
            image::write(
                file, image::from_device(picture_->width_px, picture_->height_px, picture_->rgba),
                {{"Software", "Relevo"},
                 {"Description", capture_command(whole_scene(), "picture.png")}});
            return name + " has the picture";
        });
    }

    template <typename Do>
    void say_or_fail(const Do& act) {
        try {
            state_.message = act();
            log::info(state_.message);
        } catch (const Error& error) {
            state_.message = error.what();
        }
    }

    void read_again() {
        state_.set_effects(state_.document.scene.effects);
        state_.take_effects(/*is_step=*/false);
        busy_frames_ = 3;
    }

    void open_files() {
        std::vector<std::string> files = window_->take_dropped_files();
        if (asked_files_ &&
            asked_files_->wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
            files = asked_files_->get();
            asked_files_.reset();
        }
        if (files.empty() || !last_good_) return;
        state_.document.scene.dems = std::move(files);
        state_.document.scene.view = {};
        state_.document.scene.dem = {};
        has_gone_back_ = has_failed_ = false;
        open();
    }

    void ask_for_dem() {
        if (!asked_files_) asked_files_ = ask_for_files();
        if (!asked_files_)
            state_.message =
                "this desktop has no file dialog (zenity, kdialog); drop a DEM on the window, or "
                "start relevo with its name";
    }

    /// Effects are read again when their files are written, and the DEM when its are.
    void watch_files() {
        if ((!is_open() && !has_failed_) || seconds_since(watched_at_) < kWatch_s) return;
        watched_at_ = Clock::now();
        if (is_open() && effect_files_.changed()) read_again();
        if (dem_files_.changed() && dem_files_.all_there()) {
            if (is_open()) state_.document.scene.view = view_of(state_.document.pose, state_.land);
            has_gone_back_ = has_failed_ = false;
            state_.message = "the DEM was written again, and read again";
            open();
        }
    }

    // ---- time

    void pass_time(double passed_s) {
        if (!state_.playing) return;
        state_.set_utc(state_.document.utc + passed_s * state_.hours_a_second * 3600);
        state_.sun_moves = true;
    }

    // ---- what is seen

    void panels() {
        if (!is_open()) {
            waiting_text();
            return;
        }
        if (picture_) {
            draw_sun_path(state_, *picture_, size());
            draw_measured(state_.measured, state_.profile, *picture_, size());
            draw_scale_and_north(*picture_, state_.land, ground_at(0.5f * size()), size());
        }
        if (panels_) side_panel();
        status_line();
        if (sheet_) key_sheet();
    }

    void waiting_text() const {
        ImGui::SetNextWindowPos({20, 20});
        ImGui::Begin("##opening", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize);
        if (has_failed_)
            ImGui::TextWrapped("%s", state_.message.c_str());
        else
            ImGui::Text("opening %s ...", state_.document.scene.dems.front().c_str());
        ImGui::End();
    }

    void side_panel() {
        const float scale = window_->scale();
        ImGui::SetNextWindowPos({10, 10}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSizeConstraints({kPanel_px * scale, 60},
                                            {kPanel_px * scale, size().y - 60});
        ImGui::Begin("Relevo", nullptr,
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize);
        constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
        if (ImGui::CollapsingHeader("Sun", kOpen)) sun_panel(state_);
        if (ImGui::CollapsingHeader("Point", kOpen)) point_panel(state_);
        if (state_.profile && ImGui::CollapsingHeader("Profile", kOpen))
            profile_panel(*state_.profile);
        if (ImGui::CollapsingHeader("Effects", kOpen)) effects_panel(state_);
        if (ImGui::CollapsingHeader("Take it away", kOpen)) {
            if (ImGui::Button("Picture (F12)")) take_picture();
            ImGui::SameLine();
            if (ImGui::Button("Copy command")) copy_command();
            ImGui::SameLine();
            if (ImGui::Button("Save scene")) save_scene();
        }
        if (!state_.message.empty()) {
            ImGui::Separator();
            ImGui::TextWrapped("%s", state_.message.c_str());
        }
        ImGui::End();
    }

    void status_line() {
        std::string text;
        if (state_.cursor) {
            const Cursor& at = *state_.cursor;
            text = fmt::format("{}   {}   {:.1f} m", geo::degrees_text(at.place),
                               geo::utm_text(at.place), at.place.height_m);
            if (!std::isnan(at.slope_deg)) text += fmt::format("   slope {:.1f}°", at.slope_deg);
            if (!std::isnan(at.slope_deg) && !std::isnan(at.aspect_deg))
                text += fmt::format(" to {:.0f}°", at.aspect_deg);
        } else {
            text = "H: keys";
        }
        ImDrawList& list = *ImGui::GetForegroundDrawList();
        const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
        const ImVec2 at{12, ImGui::GetIO().DisplaySize.y - extent.y - 10};
        list.AddRectFilled({at.x - 6, at.y - 4}, {at.x + extent.x + 6, at.y + extent.y + 4},
                           IM_COL32(0, 0, 0, 150), 4);
        list.AddText(at, IM_COL32(255, 255, 255, 235), text.c_str());
    }

    // ---- to the thread that draws

    void want_view() {
        if (state_.sun_moves) moved();
        rested_ = seconds_since(moved_at_) > kRest_s;
        const Wanted wanted = wanted_now();
        if (!(wanted_ && same(*wanted_, wanted))) {
            scene_->want(wanted);
            if (before_) before_->want(wanted);
        }
        wanted_ = wanted;
    }

    void hand_over() {
        want_view();
        if (state_.new_effects) scene_->want_effects(*state_.new_effects);
        for (const auto& [address, value] : state_.new_values)
            scene_->want_value(address, value);
        if (state_.step) {
            history_.add(state_.document);
            busy_frames_ = 2;
        }
        if (!state_.sun_moves && !state_.playing) follow_the_day();
        if (busy_frames_ > 0) --busy_frames_;
        if (state_.compare_is_wanted && !before_) compare();
        if (!state_.compare_is_wanted && before_) stop_comparing();
        sun_moved_ = state_.sun_moves;
        state_.step = state_.sun_moves = false;
        state_.new_effects.reset();
        state_.new_values.clear();
        if (takes_when_sharp_ && is_answered()) {
            takes_when_sharp_ = false;
            take_picture();
        }
    }

    /// What the hand has moved is a step of undo when it has come to rest.
    void step_at_rest() {
        if (is_open() && seconds_since(moved_at_) > kStep_s && !dragging_ && !glides() &&
            !keys_held_ && !state_.playing && history_.differs(state_.document))
            history_.add(state_.document);
    }

    /// The chosen point's light is that of the day that is shown.
    void follow_the_day() {
        if (!state_.point || state_.point_in_work.valid()) return;
        if (state_.point->date != state_.document.zone.local(state_.document.utc).wall.date)
            work_out_light(state_.point->place);
    }

    Wanted wanted_now() const {
        const glm::ivec2 size = window_->size_px();
        Wanted wanted;
        wanted.view = view_of(state_.document.pose, state_.land);
        wanted.utc = state_.document.utc;
        wanted.width_px = size.x;
        wanted.height_px = size.y;
        wanted.moving = !rested_;
        wanted.sun_moving = !rested_ && (state_.sun_moves || sun_moved_);
        return wanted;
    }

    static bool same(const Wanted& a, const Wanted& b) {
        return a.utc == b.utc && a.width_px == b.width_px && a.height_px == b.height_px &&
               a.moving == b.moving && a.sun_moving == b.sun_moving &&
               a.view->heading_deg == b.view->heading_deg &&
               a.view->pitch_deg == b.view->pitch_deg && a.view->fov_y_rad == b.view->fov_y_rad &&
               a.view->eye->place.lat_rad == b.view->eye->place.lat_rad &&
               a.view->eye->place.lon_rad == b.view->eye->place.lon_rad &&
               a.view->eye->place.height_m == b.view->eye->place.height_m;
    }

    std::unique_ptr<Window> window_;  // ends after the threads that wake it
    std::string device_;
    std::string zone_;  // as --tz takes it
    std::unique_ptr<SceneThread> scene_;
    std::shared_ptr<const Opened> opened_;  // scene_'s
    State state_;                           // its work refers to the session: ends before it
    History history_;
    Pose home_;
    std::shared_ptr<const Picture> picture_;
    std::unique_ptr<SceneThread> before_;  // of a comparison
    std::shared_ptr<const Picture> picture_before_;
    std::optional<Wanted> wanted_;
    std::optional<scene::Scene> last_good_;  // that was open
    bool has_gone_back_ = false, has_failed_ = false;
    std::optional<std::future<std::vector<std::string>>> asked_files_;
    FileWatch effect_files_, dem_files_;
    Clock::time_point watched_at_ = Clock::now();

    std::optional<Drag> dragging_;
    glm::vec2 pressed_px_{0}, last_px_{0};
    glm::dvec3 held_{0}, zoom_at_{0};
    double zoom_left_ = 0;  // natural logarithm of what is still to be zoomed
    glm::dvec2 glide_deg_a_s_{0};
    bool walking_ = false, keys_held_ = false;
    bool sun_moved_ = false;  // in the frame before

    Clock::time_point frame_at_ = Clock::now(), moved_at_ = Clock::now();
    bool rested_ = true, panels_ = true, sheet_ = false, takes_when_sharp_ = false;
    int busy_frames_ = 3;  // that panels still need to settle
};

}  // namespace

void run(const scene::Scene& scene, const std::string& device) {
    Viewer(scene, device).run();
}

}  // namespace relevo::viewer

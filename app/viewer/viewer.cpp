#include "viewer/viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/text.h"
#include "sun/zone_of_place.h"
#include "viewer/charts_panel.h"
#include "viewer/discard.h"
#include "viewer/file_dialog.h"
#include "viewer/file_watch.h"
#include "viewer/hand.h"
#include "viewer/overlay.h"
#include "viewer/state.h"
#include "viewer/take_away.h"
#include "viewer/window.h"

namespace relevo::viewer {
namespace {

using Clock = std::chrono::steady_clock;

/// After the last input the hand counts as moving for so long.
constexpr double kRest_s = 0.15;
/// What comes after so long is another step of undo.
constexpr double kStep_s = 0.5;
/// Files are looked at again so often.
constexpr double kWatch_s = 1;
/// What was done is told of for so long.
constexpr double kTold_s = 8;
/// At the end work in progress is waited for so long; reading a large DEM may take longer.
constexpr auto kLeave = std::chrono::milliseconds(600);

double seconds_since(Clock::time_point began) {
    return std::chrono::duration<double>(Clock::now() - began).count();
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
        hand_ = std::make_unique<Hand>(*window_, state_);
        point_work_ = std::make_unique<PointWork>(&Window::wake);
        state_.effects = EffectsModel::of(scene.effects);
        state_.settings = written_ = memory_.settings();
        state_.recent = memory_.recent();
        window_->set_style(state_.settings.light_style, state_.settings.text_px);
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
            keys();
            if (is_open()) {
                take_hand(std::min(passed_s, 0.1));
                pass_time(std::min(passed_s, 0.5));
                want_view();  // before the panels are drawn, which takes its time too
            }
            open_files();
            watch_files();
            step_at_rest();
            if (most_s >= kWatch_s && busy_frames_ == 0) continue;
            window_->draw([&] { panels(); });
            state_.take_effects(/*is_step=*/true);
            hand_over();
            restyle();
        }
        leave();
    }

  private:
    bool is_open() const { return opened_ != nullptr; }

    void open() {
        point_work_->forget();
        state_.chosen.reset();
        state_.point.reset();
        state_.measured.clear();
        state_.profile.reset();
        state_.cursor.reset();
        hand_->rest();
        hand_->see(nullptr);
        opened_ = nullptr;
        picture_ = nullptr;
        wanted_.reset();
        history_ = {};  // poses are of the other ground
        stop_comparing();
        discard_.take(std::move(scene_));
        scene_ = std::make_unique<SceneThread>(state_.document.scene, device_, &Window::wake);
        want_size();
        busy_frames_ = 3;
    }

    /// From now on the left of the line is drawn with the effects as they are now.
    void compare() {
        before_ = std::make_unique<SceneThread>(whole(), device_, &Window::wake, opened_->dem);
        before_->want(wanted_now());
    }

    /// Whether the picture is late, so that it is said.
    bool is_drawing() const {
        return is_open() && rested_ && !scene_->rests() && seconds_since(moved_at_) > 2 * kRest_s;
    }

    void stop_comparing() {
        discard_.take(std::move(before_));
        picture_before_ = nullptr;
        window_->take_before(nullptr);
        state_.compare_is_wanted = false;
    }

    /// Ends what works beside. Nobody waits for a DEM to be read that nobody will see.
    void leave() {
        window_->hide();
        remember_settings();
        discard_.take(std::move(before_));
        discard_.take(std::move(scene_));
        discard_.take(std::move(point_work_));
        // Nothing is being written by then, and the rest is the system's to take back.
        if (!discard_.ends_within(kLeave)) std::_Exit(EXIT_SUCCESS);
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
        if (busy_frames_ > 0 || state_.playing || hand_->is_moving()) return 0.008;
        if (!rested_) return 0.05;
        return is_drawing() ? 0.25 : kWatch_s;
    }

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
            hand_->see(picture_);
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
        read_point_work();
    }

    void read_point_work() {
        const std::shared_ptr<const PointLight> answer = point_work_->answer();
        state_.point_in_work = !point_work_->is_done();
        if (answer == state_.point) return;
        // Drawings of the day before stay until there are others.
        state_.point = answer;
        busy_frames_ = std::max(busy_frames_, 2);
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
        const scene::Scene& scene = opened_->scene;
        state_.land.frame = &opened_->ground.frame;
        state_.land.exaggeration = scene.exaggeration;
        state_.land.height_m = [dem = opened_->dem](const geo::Geodetic& at) {
            return dem->height_m(at);
        };
        const glm::dvec2 spacing_m = opened_->dem->field.grid.post_spacing_m();
        state_.spacing_m = std::sqrt(spacing_m.x * spacing_m.y);
        state_.stand_on(opened_->ground);
        Document& document = state_.document;
        document.zone = sun::choose_zone(zone_, state_.centre).zone;
        document.pose = home_ = pose_of(opened_->camera, state_.land);
        state_.set_utc(last_good_ ? document.utc : opened_->utc);
        history_.add(document);
        window_->set_title(fmt::format("{} - Relevo", scene.dems.front()));
        last_good_ = document.scene;
        if (!has_gone_back_) tried_ = scene.dems.front();
        has_gone_back_ = false;
        const std::vector<std::string> names = absolute_names(scene.dems);
        state_.views = memory_.views(names);
        remember([&] { memory_.add_recent(names); });
        state_.recent = memory_.recent();
        watch(scene);
        busy_frames_ = 3;
    }

    void watch(const scene::Scene& scene) {
        std::vector<std::filesystem::path> dems;
        std::error_code ignored;
        for (const std::string& dem : scene.dems)
            if (std::filesystem::is_regular_file(dem, ignored)) dems.emplace_back(dem);
        dem_files_.watch(std::move(dems));
        std::vector<std::filesystem::path> plugins{share_dir() / "plugins"};
        plugins.insert(plugins.end(), scene.effects.plugin_path.begin(),
                       scene.effects.plugin_path.end());
        effect_files_.watch(std::move(plugins));
    }

    // ---- the hand

    glm::vec2 size() const { return window_->size(); }

    void moved() {
        moved_at_ = Clock::now();
        rested_ = false;
    }

    void take_hand(double passed_s) {
        hand_->act(passed_s, before_ != nullptr);
        if (hand_->has_moved()) moved();
        if (const auto point = hand_->take_click()) choose_point(*point);
    }

    void choose_point(const glm::dvec3& point_m) {
        geo::Geodetic place = state_.land.frame->to_geodetic(point_m);
        place.height_m = state_.land.height_m(place);
        if (std::isnan(place.height_m)) return;
        state_.measured = {point_m};
        state_.profile.reset();
        state_.chosen = place;
        asked_point_.reset();
    }

    /// The chosen point's light is that of the day that is shown.
    void follow_the_day() {
        if (!state_.chosen) return;
        const bool same = asked_point_ && asked_point_->date == state_.day.date &&
                          asked_point_->chart_px == state_.chart_px &&
                          asked_point_->px_a_unit == unit();
        if (same) return;
        PointWanted wanted;
        wanted.dem = opened_->dem;
        wanted.dems = opened_->scene.dems;
        wanted.options = opened_->scene.dem;
        wanted.refraction = opened_->scene.refraction;
        wanted.place = *state_.chosen;
        wanted.date = state_.day.date;
        wanted.zone = state_.document.zone;
        wanted.chart_px = state_.chart_px;
        wanted.px_a_unit = unit();
        asked_point_ = wanted;
        point_work_->want(std::move(wanted));
    }

    // ---- keys and menus

    void keys() {
        for (const KeyPress& press : window_->take_keys()) {
            busy_frames_ = 3;
            if (const auto command = command_of(press))
                state_.commands.push_back(*command);
            else if (!press.control && press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9)
                state_.view_to_go_to = static_cast<std::size_t>(press.key - GLFW_KEY_1);
        }
        for (const Command command : std::exchange(state_.commands, {}))
            if (!of_program(command) && is_open()) of_scene(command);
        if (state_.view_to_go_to && is_open()) go_to_view(*state_.view_to_go_to);
        state_.view_to_go_to.reset();
        if (std::exchange(state_.views_changed, false)) remember_views();
    }

    /// What can be done while nothing is open. @returns whether it is such
    bool of_program(Command command) {
        switch (command) {
            case Command::Open:
                ask_for_dem();
                return true;
            case Command::NextFile:
                open_neighbour(1);
                return true;
            case Command::PreviousFile:
                open_neighbour(-1);
                return true;
            case Command::Quit:
                window_->close();
                return true;
            case Command::Panels:
                state_.settings.panels = !state_.settings.panels;
                return true;
            case Command::Charts:
                state_.settings.charts = !state_.settings.charts;
                return true;
            case Command::Keys:
                sheet_ = !sheet_;
                return true;
            case Command::CloseKeys:
                sheet_ = false;
                closes_menus_ = true;
                state_.message.clear();
                return true;
            default:
                return false;
        }
    }

    void of_scene(Command command) {
        switch (command) {
            case Command::ReadAgain:
                return read_again();
            case Command::TakePicture:
                return take_picture();
            case Command::CopyCommand:
                return copy_command();
            case Command::SaveScene:
                return say_or_fail([&] { done(save_scene(whole())); });
            case Command::SaveJob:
                return say_or_fail(
                    [&] { done(save_job(whole(), state_.day, state_.document.zone)); });
            case Command::SaveView:
                return keep_view();
            case Command::Measure:
                return measure();
            case Command::Compare:
                state_.compare_is_wanted = !state_.compare_is_wanted;
                return;
            case Command::Play:
                state_.playing = !state_.playing;
                return;
            case Command::Undo:
                end_step();
                if (history_.can_undo()) go_to(history_.undo());
                return;
            case Command::Redo:
                if (history_.can_redo()) go_to(history_.redo());
                return;
            default:
                move(command);
        }
    }

    /// What the hand has done before is a step of its own.
    void end_step() {
        if (history_.differs(state_.document)) history_.add(state_.document);
    }

    void move(Command command) {
        constexpr double kHour_s = 3600, kDay_s = 86400;
        end_step();
        const auto by = [&](double seconds) { state_.set_utc(state_.document.utc + seconds); };
        if (command == Command::Earlier)
            by(-kHour_s / 2);
        else if (command == Command::Later)
            by(kHour_s / 2);
        else if (command == Command::DayEarlier)
            by(-kDay_s);
        else if (command == Command::DayLater)
            by(kDay_s);
        else if (!hand_->move(command, home_))
            return;
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
        hand_->rest();
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

    // ---- views and settings that are kept

    void keep_view() {
        const SavedView view = saved_view(state_.document, state_.land,
                                          fmt::format("View {}", state_.views.size() + 1));
        state_.views.push_back(view);
        tell(state_.views.size() < 10
                 ? fmt::format("{} is kept; key {} goes back to it", view.name, state_.views.size())
                 : fmt::format("{} is kept, in the menu View", view.name));
        remember_views();
    }

    void go_to_view(std::size_t i) {
        if (i >= state_.views.size()) return;
        const SavedView& view = state_.views[i];
        end_step();
        hand_->rest();
        state_.document.pose = pose_of(view, state_.land);
        state_.set_utc(view.utc);
        moved();
        state_.step = true;
    }

    void remember_views() {
        if (opened_)
            say_or_fail(
                [&] { memory_.write_views(absolute_names(opened_->scene.dems), state_.views); });
    }

    /// Between frames, where fonts may be made anew.
    void restyle() {
        const Settings& now = state_.settings;
        if (now.light_style == styled_.light_style && now.text_px == styled_.text_px) return;
        styled_ = now;
        window_->set_style(now.light_style, now.text_px);
        busy_frames_ = 3;
    }

    void remember_settings() {
        if (state_.settings == written_) return;
        written_ = state_.settings;
        remember([&] { memory_.write(written_); });
    }

    /// A home that nothing can be written to is not what the window is for.
    template <typename Do>
    static void remember(const Do& act) {
        try {
            act();
        } catch (const Error& error) {
            log::warning(error.what());
        }
    }

    // ---- taking it away

    scene::Scene whole() const {
        return whole_scene(state_.document, state_.land, window_->size_px());
    }

    void copy_command() {
        window_->copy(capture_command(whole(), "picture.png"));
        tell("the command that takes this picture is on the clipboard");
    }

    /// Whether the picture is what was wanted last.
    bool is_answered() const {
        return picture_ && picture_->sharp && picture_->answers == scene_->wants() && wanted_ &&
               same(*wanted_, wanted_now());
    }

    void take_picture() {
        takes_when_sharp_ = !is_answered();
        if (!takes_when_sharp_) say_or_fail([&] { done(save_picture(*picture_, whole())); });
    }

    /// Tells of something that was done, for a while.
    void tell(std::string what) {
        state_.message = told_ = std::move(what);
        told_at_ = Clock::now();
    }

    /// Likewise of a file, also where the program was started.
    void done(std::string what) {
        log::info(what);
        tell(std::move(what));
    }

    void end_message() {
        if (told_.empty() || seconds_since(told_at_) < kTold_s) return;
        if (state_.message == told_) {
            state_.message.clear();
            busy_frames_ = 2;
        }
        told_.clear();
    }

    template <typename Do>
    void say_or_fail(const Do& act) {
        try {
            act();
        } catch (const Error& error) {
            state_.message = error.what();
        }
    }

    // ---- files

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
        if (!state_.files_to_open.empty()) files = std::exchange(state_.files_to_open, {});
        if (files.empty() || !last_good_) return;
        tried_ = files.front();
        scene::Scene& scene = state_.document.scene;
        scene.dems = std::move(files);
        scene.view = {};
        scene.dem = {.max_posts = scene.dem.max_posts};  // the rest is said of the other file
        has_gone_back_ = has_failed_ = false;
        state_.message.clear();
        open();
    }

    /// Beside the one that was tried last, so that one that is no DEM is not the end of the way.
    void open_neighbour(int by) {
        if (tried_.empty()) return;
        if (const std::string next = neighbour_in_folder(tried_, by); !next.empty())
            state_.files_to_open = {next};
        else
            state_.message = "there is no other DEM in its folder";
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
        if (seconds_since(watched_at_) < kWatch_s) return;
        watched_at_ = Clock::now();
        remember_settings();
        end_message();
        if (!is_open() && !has_failed_) return;
        if (is_open() && effect_files_.changed()) read_again();
        if (dem_files_.changed() && dem_files_.all_there()) {
            if (is_open()) state_.document.scene.view = view_of(state_.document.pose, state_.land);
            has_gone_back_ = has_failed_ = false;
            tell("the DEM was written again, and read again");
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

    /// Pixels for a unit of what is made for usual letters.
    double unit() const {
        constexpr double kUsual_px = 16;
        return window_->scale() * state_.settings.text_px / kUsual_px;
    }

    void panels() {
        // No focus on any of them: menus close.
        if (std::exchange(closes_menus_, false)) ImGui::SetWindowFocus(nullptr);
        if (!is_open()) {
            if (state_.settings.panels) menu_bar(state_);
            waiting_text(state_, has_failed_);
            return;
        }
        if (picture_) {
            draw_sun_path(state_, *picture_, size());
            draw_measured(state_.measured, state_.profile, *picture_, size());
            const float top = state_.settings.panels ? ImGui::GetFrameHeight() : 0;
            draw_scale_and_north(*picture_, state_.land, hand_->ground_at(0.5f * size()), size(),
                                 top);
            if (before_) draw_sides(window_->line() * size().x, top);
        }
        if (state_.settings.panels) {
            menu_bar(state_);
            side_panel(state_, size(), unit());
            charts_.draw(state_, size(), unit());
        }
        status_line(state_, is_drawing());
        message_box(state_, size(), unit());
        if (sheet_) key_sheet();
    }

    // ---- to the threads that work

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
        if (busy_frames_ > 0) --busy_frames_;
        if (is_open()) hand_over_scene();
        sun_moved_ = state_.sun_moves;
        state_.step = state_.sun_moves = false;
        state_.new_effects.reset();
        state_.new_values.clear();
    }

    void hand_over_scene() {
        want_view();
        if (state_.new_effects) scene_->want_effects(*state_.new_effects);
        for (const auto& [address, value] : state_.new_values)
            scene_->want_value(address, value);
        if (state_.step) {
            history_.add(state_.document);
            busy_frames_ = 2;
        }
        follow_the_day();
        if (state_.compare_is_wanted && !before_) compare();
        if (!state_.compare_is_wanted && before_) stop_comparing();
        if (takes_when_sharp_ && is_answered()) take_picture();
    }

    /// What the hand has moved is a step of undo when it has come to rest.
    void step_at_rest() {
        if (is_open() && seconds_since(moved_at_) > kStep_s && !hand_->is_busy() && !state_.playing)
            end_step();
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
    Discard discard_;
    std::string device_;
    std::string zone_;  // as --tz takes it
    Memory memory_ = Memory::of_user();
    Settings written_, styled_;
    std::unique_ptr<SceneThread> scene_;
    std::shared_ptr<const Opened> opened_;  // scene_'s
    State state_;
    std::unique_ptr<Hand> hand_;  // refers to both
    ChartsPanel charts_;
    std::unique_ptr<PointWork> point_work_;
    std::optional<PointWanted> asked_point_;  // of state_.chosen
    History history_;
    Pose home_;
    std::shared_ptr<const Picture> picture_;
    std::unique_ptr<SceneThread> before_;  // of a comparison
    std::shared_ptr<const Picture> picture_before_;
    std::optional<Wanted> wanted_;
    std::optional<scene::Scene> last_good_;  // that was open
    std::string tried_;                      // the DEM that was to be opened last
    bool has_gone_back_ = false, has_failed_ = false;
    std::optional<std::future<std::vector<std::string>>> asked_files_;
    FileWatch effect_files_, dem_files_;
    Clock::time_point watched_at_ = Clock::now();
    bool sun_moved_ = false;  // in the frame before
    std::string told_;
    Clock::time_point told_at_;

    Clock::time_point frame_at_ = Clock::now(), moved_at_ = Clock::now();
    bool rested_ = true, sheet_ = false, takes_when_sharp_ = false;
    bool closes_menus_ = false;
    int busy_frames_ = 3;  // that panels still need to settle
};

}  // namespace

void run(const scene::Scene& scene, const std::string& device) {
    Viewer(scene, device).run();
}

}  // namespace relevo::viewer

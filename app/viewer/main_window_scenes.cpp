#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/paths.h"
#include "base/text.h"
#include "sun/zone_of_place.h"
#include "viewer/file_dialog.h"
#include "viewer/main_window.h"

namespace relevo::viewer {
namespace {

/// When the clocks of another zone show what those of one show now.
sun::Instant same_hour(sun::Instant utc, const sun::Zone& from, const sun::Zone& to) {
    return from.name() == to.name() ? utc : to.resolve(from.local(utc).wall).utc;
}

}  // namespace

void MainWindow::open() {
    point_work_->forget();
    overlay_work_->forget();
    asked_overlay_.reset();
    state_.overlay.reset();
    saves_when_whole_ = false;
    state_.chosen.reset();
    state_.point.reset();
    state_.measurement = {};
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

void MainWindow::compare() {
    before_ = std::make_unique<SceneThread>(whole(), device_, &Window::wake, opened_->dem);
    before_->want(wanted_now());
    before_->want_drape(state_.overlay ? state_.overlay->overlay.drape : nullptr);
}

void MainWindow::stop_comparing() {
    discard_.take(std::move(before_));
    picture_before_ = nullptr;
    window_->take_before(nullptr);
    state_.compare_is_wanted = false;
}

void MainWindow::want_size() {
    const glm::ivec2 size = window_->size_px();
    Wanted wanted;
    wanted.width_px = size.x;
    wanted.height_px = size.y;
    wanted.insets = insets();
    scene_->want(wanted);
}

Pose MainWindow::pose_in(const scene::View& view) const {
    const double aspect = static_cast<double>(size().x) / size().y;
    return pose_of(opened_->camera(view, aspect, insets()), state_.land);
}

Whole MainWindow::whole_views() const {
    scene::View above;
    above.orbit = {.azimuth_deg = 180, .elevation_deg = 90};
    above.fov_y_rad = state_.document.pose.fov_y_rad;
    Whole whole{pose_in(home_view_), pose_in(above)};
    // Upright at its own place, where down is not quite what it is in the DEM's middle.
    whole.above = from_above(whole.above, state_.land, whole.above.eye_m, 0);
    return whole;
}

scene::Insets MainWindow::insets() const {
    if (!state_.settings.panels) return {};
    const auto text_px = static_cast<float>(unit() * kUsualText_px);
    scene::Insets insets = side_panel_insets(state_, size(), unit());
    insets.top = 1.5 * text_px / size().y;     // the menu
    insets.bottom = 2.0 * text_px / size().y;  // the line of the cursor
    // In a window about as low as these there is no room beside them.
    if (insets.top + insets.bottom > 0.5) insets.top = insets.bottom = 0;
    return insets;
}

void MainWindow::read_thread() {
    if (has_failed_) return;
    try {
        scene_->check();
    } catch (const std::exception& error) {
        if (stands_in()) last_good_ = good_before_;  // of this one a part alone was
        if (!last_good_) throw;                      // what the program was started for
        go_back(error.what());
        return;
    }
    if (auto opened = scene_->opened(); opened && opened != opened_)
        is_open() ? take_all_posts(std::move(opened)) : start(std::move(opened));
    if (const auto newer = scene_->newer_than(picture_ ? picture_->number : 0)) {
        picture_ = newer;
        follow_drawn_ground();
        hand_->see(picture_);
        window_->take(*newer);
        has_new_picture_ = true;
        busy_frames_ = std::max(busy_frames_, 1);
    }
    if (before_) watch_comparison();
    if (before_)
        if (const auto newer = before_->newer_than(picture_before_ ? picture_before_->number : 0)) {
            picture_before_ = newer;
            window_->take_before(newer.get());
            has_new_picture_ = true;
            busy_frames_ = std::max(busy_frames_, 1);
        }
    if (auto message = scene_->take_message()) {
        state_.message = std::move(*message);
        busy_frames_ = 2;
    }
    read_point_work();
    if (is_open()) watch_saving();
}

/// Where drawn ground would have hidden the eye, the picture was drawn from higher up.
void MainWindow::follow_drawn_ground() {
    if (!is_open()) return;
    state_.land.aim_m = picture_->aim_m;
    constexpr double kSame_m = 0.005;
    Pose& pose = state_.document.pose;
    const bool is_of_now =
        picture_->answers == scene_->wants() && wanted_ && same(*wanted_, wanted_now());
    if (is_of_now && distance(pose.eye_m, picture_->camera.eye_m) > kSame_m)
        pose.eye_m = picture_->camera.eye_m;
}

void MainWindow::watch_comparison() {
    try {
        before_->check();
        if (auto message = before_->take_message()) state_.message = std::move(*message);
    } catch (const std::exception& error) {
        state_.message = fmt::format("no comparison: {}", error.what());
        stop_comparing();
    }
}

void MainWindow::go_back(std::string why) {
    state_.message = std::move(why);
    busy_frames_ = 3;
    has_failed_ = has_gone_back_;
    if (has_failed_) return;
    has_gone_back_ = true;
    // The DEM that was read again is seen from where it was, when it is whole again.
    const scene::Scene tried = std::exchange(state_.document.scene, *last_good_);
    reads_again_ = reads_again_ && tried.dems == last_good_->dems;
    if (reads_again_) state_.document.scene.view = tried.view;
    open();
}

void MainWindow::give_up_opening() {
    const std::string name = printable(state_.document.scene.dems.front());
    go_back("opening " + name + " was cancelled");
}

void MainWindow::start(std::shared_ptr<const Opened> opened) {
    opened_ = std::move(opened);
    const scene::Scene& scene = opened_->scene;
    stand_on_ground();
    Document& document = state_.document;
    if (opened_->legend) {  // till its file has been read here, too
        auto shown = std::make_shared<OverlayShown>();
        shown->overlay.legend = *opened_->legend;
        state_.overlay = std::move(shown);
    }
    const sun::Zone zone_before = document.zone;
    document.zone = sun::choose_zone(zone_, state_.centre).zone;
    if (!std::exchange(reads_again_, false)) home_view_ = scene.view;
    document.pose = pose_in(scene.view);
    state_.set_utc(last_good_ ? same_hour(document.utc, zone_before, document.zone) : opened_->utc);
    history_.add(document);
    window_->set_title(fmt::format("{} - Relevo", scene.dems.front()));
    good_before_ = has_gone_back_ ? std::nullopt : last_good_;
    last_good_ = document.scene;
    if (!has_gone_back_) tried_ = scene.dems.front();
    has_gone_back_ = false;
    const std::vector<std::string> names = absolute_names(scene.dems);
    state_.views = memory_.views(names);
    remember([&] { memory_.add_recent({names, scene.dem, scene.holes}); });
    state_.recent = memory_.recent();
    watch(scene);
}

void MainWindow::stand_on_ground() {
    state_.land.frame = &opened_->ground.frame;
    state_.land.exaggeration = opened_->scene.exaggeration;
    state_.land.height_m = [dem = opened_->dem](const geo::Geodetic& at) {
        return dem->height_m(at);
    };
    state_.land.aim_m = opened_->aim_m;
    const session::LoadedDem& dem = *opened_->dem;
    const dem::Grid& grid = stands_in() ? dem.source->grid() : dem.field.grid;
    const glm::dvec2 spacing_m = grid.post_spacing_m();
    state_.spacing_m = std::sqrt(spacing_m.x * spacing_m.y);
    state_.stand_on(opened_->ground);
    state_.stands_in = stands_in();
    state_.ground_words = dem.ground_words(opened_->scene.holes);
    say_or_fail([&] {
        state_.effects = EffectsModel::of(state_.document.scene.effects, state_.ground_words);
    });
    busy_frames_ = 3;
}

void MainWindow::take_all_posts(std::shared_ptr<const Opened> opened) {
    const std::shared_ptr<const Opened> before = std::exchange(opened_, std::move(opened));
    Document& document = state_.document;
    const bool is_as_opened = !history_.can_undo() && !history_.differs(document);
    stand_on_ground();
    if (is_as_opened) {
        document.pose = pose_in(opened_->scene.view);
        if (document.utc == before->utc) document.utc = opened_->utc;
        history_ = {};
        history_.add(document);
    }
    state_.set_utc(document.utc);
    asked_point_.reset();
    if (before_) before_->want_dem(opened_->dem);
}

bool MainWindow::stands_in() const {
    return is_open() && opened_->dem->stands_in;
}

void MainWindow::watch(const scene::Scene& scene) {
    std::vector<std::filesystem::path> dems;
    std::error_code ignored;
    for (const std::string& dem : scene.dems)
        if (std::filesystem::is_regular_file(dem, ignored)) dems.emplace_back(dem);
    dem_files_.watch(std::move(dems));
    std::vector<std::filesystem::path> plugins{share_dir() / "plugins"};
    plugins.insert(plugins.end(), scene.effects.plugin_path.begin(),
                   scene.effects.plugin_path.end());
    // Images in a plugin's folder are none of these: saving one reads nothing again.
    effect_files_.watch(plugins, {".json", ".glsl", ".so"});
}

void MainWindow::read_again() {
    state_.set_effects(state_.document.scene.effects);
    state_.take_effects(/*is_step=*/false);
    busy_frames_ = 3;
}

void MainWindow::open_files() {
    std::vector<std::string> files = window_->take_dropped_files();
    if (asked_files_ &&
        asked_files_->wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        files = asked_files_->get();
        asked_files_.reset();
    }
    if (const std::optional<std::string> chosen = open_panel_.take()) files = {*chosen};
    if (!state_.files_to_open.empty()) files = std::exchange(state_.files_to_open, {});
    const std::optional<RecentDem> recent = std::exchange(state_.recent_to_open, std::nullopt);
    if (recent) files = recent->files;
    if (files.empty() || !last_good_) return;
    tried_ = files.front();
    reads_again_ = false;
    scene::Scene& scene = state_.document.scene;
    scene.dems = std::move(files);
    scene.view = {};
    scene.overlay.reset();  // it is of the other ground
    state_.document.overlay = {};
    scene.dem = {.max_posts = scene.dem.max_posts};  // the rest is said of the other file
    if (recent) {
        const std::int64_t max_posts = scene.dem.max_posts;  // is this window's
        scene.dem = recent->options;
        scene.dem.max_posts = max_posts;
        scene.holes = recent->holes;
    }
    has_gone_back_ = has_failed_ = false;
    state_.message.clear();
    open();
}

void MainWindow::open_neighbour(int by) {
    if (tried_.empty()) return;
    if (const std::string next = neighbour_in_folder(tried_, by); !next.empty())
        state_.files_to_open = {next};
    else
        state_.message = "no other DEM in this folder";
}

void MainWindow::ask_for_dem() {
    if (!asked_files_) asked_files_ = ask_for_files();
    if (!asked_files_) open_panel_.open(tried_);
}

void MainWindow::watch_files() {
    if (seconds_since(watched_at_) < kWatch_s) return;
    watched_at_ = Clock::now();
    remember_settings();
    end_message();
    if (!is_open() && !has_failed_) return;
    if (is_open() && effect_files_.changed()) read_again();
    if (dem_files_.changed() && dem_files_.all_there()) {
        if (is_open()) state_.document.scene.view = view_of(state_.document.pose, state_.land);
        has_gone_back_ = has_failed_ = false;
        reads_again_ = true;
        tell("the DEM changed and was reloaded");
        open();
    }
}

}  // namespace relevo::viewer

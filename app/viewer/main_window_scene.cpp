#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "sun/zone_of_place.h"
#include "viewer/crs_suggestions.h"
#include "viewer/main_window.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

/// The instant at which clocks of the zone `to` show what clocks of `from` show at `utc`.
sun::Instant same_local_time(sun::Instant utc, const sun::Zone& from, const sun::Zone& to) {
    return from.name() == to.name() ? utc : to.resolve(from.local(utc).wall).utc;
}

}  // namespace

void MainWindow::reload_effects() {
    film_->end_preview();
    ++effects_read_;
    state_.set_effects(state_.document.scene.effects);
    state_.take_effects(/*is_step=*/false);
    pacing_.need_frames(3);
}

void MainWindow::reload_dem() {
    film_->end_preview();
    scene::Scene scene = state_.document.scene;
    scene.view = view_of(state_.document.pose, state_.land);
    const OverlayChoice& overlay = state_.document.overlay;
    if (overlay.kind != OverlayKind::File || !overlay.visible) scene.overlay.reset();
    opening_->reload(std::move(scene), first_wanted());
    pacing_.need_frames(3);
}

Wanted MainWindow::first_wanted() const {
    Wanted wanted;
    wanted.width_px = window_->size_px().x;
    wanted.height_px = window_->size_px().y;
    wanted.insets = panel_insets();
    wanted.effects_read = effects_read_;
    return wanted;
}

void MainWindow::clear_scene() {
    state_.document.scene = opening_->scene();
    scene::Scene& scene = state_.document.scene;
    state_.chooses_exaggeration = std::exchange(scene.chooses_exaggeration, false);
    scene.exaggeration = opening_->opened()->scene.exaggeration;
    scene.exposure_ev = opening_->opened()->scene.exposure_ev;
    saver_->sheet().take_scene(state_.document.scene);
    point_->clear();
    overlay_->clear();
    film_->forget();
    state_.measurement = {};
    state_.cursor.reset();
    hand_->rest();
    hand_->see(nullptr);
    picture_ = nullptr;
    wanted_.reset();
    history_ = {};  // its poses are relative to the last DEM
    stop_comparison();
    pacing_.need_frames(3);
}

void MainWindow::want_view() {
    if (state_.sun_moves) pacing_.moved();
    pacing_.update_rest();
    const Wanted wanted = wanted_now();
    if (wanted_ == wanted) return;
    if (wanted_ && wanted_->scene->exaggeration != wanted.scene->exaggeration) stop_comparison();
    opening_->thread().want(wanted);
    if (comparison_->thread()) comparison_->want(wanted);
    wanted_ = wanted;
}

Wanted MainWindow::wanted_now() const {
    Wanted wanted = first_wanted();
    wanted.scene = state_.document.scene;
    wanted.scene->view = view_of(state_.document.pose, state_.land);
    wanted.utc = state_.document.utc;
    wanted.overlay = overlay_->laid();
    wanted.keeps_seconds = film_->shows_frame();
    if (!film_->shows_frame())  // which is exact
        wanted.keep_above_m = hand_->is_walking() ? kWalk_m : kClearance_m;
    wanted.moving = !pacing_.is_at_rest();
    wanted.sun_moving = wanted.moving && (state_.sun_moves || sun_moved_);
    return wanted;
}

void MainWindow::poll_threads() {
    poll_opening();
    if (is_open()) poll_images();
    if (is_open() && picture_) poll_place();
    if (auto message = opening_->thread().take_message()) {
        messages_.show(std::move(*message));
        pacing_.need_frames(2);
    }
    if (point_->poll()) pacing_.need_frames(2);
    if (film_->poll()) pacing_.need_frames(2);
    moves_->poll_sun_over();
    if (is_open() && overlay_->poll_export()) pacing_.need_frames(3);
}

void MainWindow::poll_opening() {
    // State::land refers to this one until it refers to the next.
    const std::shared_ptr<const Opened> before = opening_->opened();
    const Opening::Event event = opening_->poll();
    if (event != Opening::Event::None) film_->end_preview();
    switch (event) {
        case Opening::Event::None:
            return;
        case Opening::Event::Opened:
            return start_scene(/*is_first=*/!before, std::nullopt);
        case Opening::Event::Reloaded:
            return restart_scene(*before);
        case Opening::Event::Changed:
            return before->dem == opening_->opened()->dem ? take_shape() : complete_scene(*before);
        case Opening::Event::Broken:
            return opening_->go_back(first_wanted());
        case Opening::Event::Failed:
            pacing_.need_frames(3);
            opener_->ask_after_failure();
            return;
    }
}

void MainWindow::poll_images() {
    if (const auto newer = opening_->thread().newer_than(picture_ ? picture_->number : 0)) {
        picture_ = newer;
        state_.layer_legends = newer->legends;
        if (!first_picture_at_) first_picture_at_ = Clock::now();
        raise_eye();
        hand_->see(picture_);
        window_->take(*newer);
        pacing_.new_image();
    }
    const bool compares = comparison_->thread() != nullptr;
    if (comparison_->poll()) pacing_.new_image();
    if (compares && !comparison_->thread()) state_.compare_is_wanted = false;
}

void MainWindow::poll_place() {
    using namespace std::chrono_literals;
    if (std::exchange(names_place_, false))
        place_ = std::async(std::launch::async, [centre = state_.centre] {
            std::string place = near_text(centre);
            Window::wake();
            return place;
        });
    if (!place_.valid() || place_.wait_for(0s) != std::future_status::ready) return;
    if (const std::string place = place_.get(); !place.empty())
        window_->set_title(
            fmt::format("{} - Relevo", opening_->opened()->scene.dems.front() + ", " + place));
}

void MainWindow::stop_comparison() {
    comparison_->stop();
    state_.compare_is_wanted = false;
}

void MainWindow::start_scene(bool is_first, const std::optional<scene::View>& view) {
    clear_scene();
    const Opened& opened = *opening_->opened();
    const scene::Scene& scene = opened.scene;
    use_dem();
    Document& document = state_.document;
    if (!view) {
        document.overlay = {};
        if (scene.overlay) document.overlay = choice_of(*scene.overlay);
        document.scene.backdrop = scene.backdrop;
    }
    if (opened.legend) {  // until overlay_ has read the file
        auto shown = std::make_shared<OverlayShown>();
        shown->overlay.legend = *opened.legend;
        state_.overlay = std::move(shown);
    }
    const sun::Zone zone_before = document.zone;
    document.zone = sun::choose_zone(zone_, state_.centre).zone;
    document.pose = moves_->pose_in(view.value_or(scene.view));
    view ? moves_->forget_home() : moves_->note_home();
    const bool has_time = is_first || !opening_->scene().time.at.empty();
    state_.set_utc(view ? document.utc : has_time ? opened.utc : time_from(zone_before));
    first_utc_ = document.utc;
    if (state_.chooses_exaggeration && scene.exaggeration != 1)
        messages_.note(
            tr_format("heights × {:g}; Camera, Heights sets another", scene.exaggeration));
    history_.add(document);
    window_->set_title(fmt::format("{} - Relevo", scene.dems.front()));
    place_ = {};
    names_place_ = true;
    const std::vector<std::string> names = absolute_names(scene.dems);
    state_.views = memory_.views(names);
    try_or_log([&] { memory_.add_recent({names, scene.dem, scene.holes}); });
    state_.recent = memory_.recent();
}

void MainWindow::restart_scene(const Opened& before) {
    const geo::Geodetic centre = before.ground.frame.origin();
    History history = std::move(history_);
    const scene::Scene kept = state_.document.scene;  // with what was changed while it was read
    start_scene(/*is_first=*/false, view_of(state_.document.pose, state_.land));
    state_.document.scene = kept;
    state_.set_effects(kept.effects);
    state_.take_effects(/*is_step=*/false);
    const geo::Geodetic now = opening_->opened()->ground.frame.origin();
    if (now.lat_rad == centre.lat_rad && now.lon_rad == centre.lon_rad)
        history_ = std::move(history);
    messages_.note(tr("the DEM changed and was reloaded"));
}

sun::Instant MainWindow::time_from(const sun::Zone& zone_before) {
    const Document& document = state_.document;
    const sun::Instant same = same_local_time(document.utc, zone_before, document.zone);
    if (state_.time_is_pinned || sun_at(same, state_.centre, state_.air).elevation_deg > 0)
        return same;
    const sun::Date date = document.zone.local(same).wall.date;
    const SunDay day = SunDay::of(date, document.zone, state_.centre, state_.air);
    const sun::Instant lit = time_with_sun(day, same).value_or(opening_->opened()->utc);
    const auto clock = [&](sun::Instant utc) {
        const int minute = DayMinute::of(utc, document.zone).minute;
        return fmt::format("{:02}:{:02}", minute / 60, minute % 60);
    };
    messages_.note(tr_format("it is night here at {}; shown at {}", clock(same), clock(lit)));
    return lit;
}

void MainWindow::complete_scene(const Opened& before) {
    const Opened& opened = *opening_->opened();
    Document& document = state_.document;
    const bool is_unchanged = !history_.can_undo() && !history_.differs(document);
    const bool is_home = moves_->is_home();
    use_dem();
    if (is_home) {
        moves_->go_home();
        history_.amend(document);
    }
    if (is_unchanged) {
        if (document.utc == before.utc) document.utc = opened.utc;
        history_ = {};
        history_.add(document);
    }
    state_.set_utc(document.utc);
    point_->invalidate();
    if (SceneThread* const compared = comparison_->thread()) compared->want_dem(opened.dem);
}

void MainWindow::show_true_heights() {
    double& times = state_.document.scene.exaggeration;
    if (!state_.chooses_exaggeration || state_.document.utc == first_utc_) return;
    state_.chooses_exaggeration = false;
    if (std::exchange(times, 1) == 1) return;
    messages_.note(
        tr("heights are drawn 1:1 now, so that shadows are true; Camera, Heights sets another"));
}

void MainWindow::take_shape() {
    const double before = state_.land.exaggeration;
    use_dem();
    Document& document = state_.document;
    if (moves_->is_home())  // also of heights that are drawn lower or higher
        moves_->go_home();
    else
        document.pose = exaggerated(document.pose, state_.land, before, state_.land.exaggeration);
    state_.set_utc(document.utc);
    history_.amend(document);
    state_.measurement = {};  // its ends lie on the ground as it was drawn
    pacing_.moved();
}

void MainWindow::use_dem() {
    messages_.try_to([&] { state_.use_dem_of(*opening_->opened()); });
    pacing_.need_frames(3);
}

void MainWindow::raise_eye() {
    if (!is_open()) return;
    state_.land.aim_m = picture_->aim_m;
    constexpr double kSame_m = 0.005;
    Pose& pose = state_.document.pose;
    if (!film_->shows_frame() && is_image_of_now() &&
        distance(pose.eye_m, picture_->camera.eye_m) > kSame_m)
        pose.eye_m = picture_->camera.eye_m;
}

bool MainWindow::is_image_of_now() const {
    return picture_ && picture_->answers == opening_->thread().wants() && wanted_ == wanted_now();
}

bool MainWindow::is_image_complete() const {
    return is_image_of_now() && picture_->sharp && overlay_->is_complete();
}

}  // namespace relevo::viewer

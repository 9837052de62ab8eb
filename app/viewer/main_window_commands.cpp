#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/main_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "base/paths.h"
#include "base/units.h"
#include "sun/moon.h"
#include "sun/zone_of_place.h"
#include "viewer/export.h"
#include "viewer/translation.h"

namespace relevo::viewer {
void MainWindow::process_mouse(double passed_s) {
    hand_->act(passed_s, comparison_->thread() != nullptr, std::exchange(has_new_input_, false));
    if (hand_->has_moved()) pacing_.moved();
    std::optional<Click> clicked = hand_->take_click();
    if (clicked && !clicked->point_m) {
        if (clicked->asks_for_menu)
            messages_.note(tr("no height here: sky, a void or the side of a block"));
        clicked.reset();
    }
    if (hand_->is_busy() && window_->panels_have_keys()) window_->take_keys_back();
    Measurement& line = state_.measurement;
    if (clicked && !line.follows_cursor) {
        choose_point(*clicked->point_m);
        opens_point_menu_ = clicked->asks_for_menu;
    } else if (clicked && clicked->asks_for_menu) {
        line.end();
    } else if (clicked) {
        line.set_corner(*clicked->point_m, state_.land, state_.spacing_m);
    }
    if (line.follows_cursor && state_.cursor)
        line.follow(state_.cursor->point_m, state_.land, state_.spacing_m);
}

void MainWindow::choose_point(const glm::dvec3& point_m) {
    if (point_->choose(point_m)) state_.measurement.start(point_m);
}

void MainWindow::process_keys() {
    for (const KeyPress& press : window_->take_keys()) {
        pacing_.need_frames(3);
        if (const auto command = command_of(press))
            state_.commands.push_back(*command);
        else if (!press.control && press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9)
            state_.view_to_go_to = static_cast<std::size_t>(press.key - GLFW_KEY_1);
    }
    if (const std::optional<Command> command = export_sheet_.take_command()) {
        export_sheet_.close();
        if (*command != Command::Film || !film_->is_open()) state_.commands.push_back(*command);
    }
    for (const Command command : std::exchange(state_.commands, {}))
        if (!run_program_command(command) && is_open()) run_scene_command(command);
    if (state_.view_to_go_to && is_open()) film_->end_preview();
    if (state_.view_to_go_to && is_open()) go_to_view(*state_.view_to_go_to);
    state_.view_to_go_to.reset();
    if (const auto place = find_sheet_.take(); place && is_open()) {
        film_->end_preview();
        go_to_place(*place);
    }
    const std::string zone = std::exchange(state_.zone_to_show, {});
    if (!zone.empty() && is_open()) {
        film_->end_preview();
        messages_.try_to([&] { show_zone(zone); });
    }
    if (std::exchange(state_.views_changed, false)) remember_views();
}

bool MainWindow::run_program_command(Command command) {
    switch (command) {
        case Command::Open: {
            const std::string& file = opening_->requested_file();
            // The folder of the bundled DEM has no files of the user's.
            open_dialog_.open(file.starts_with(share_dir().string()) ? "" : file);
            return true;
        }
        case Command::HowToRead:
            if (is_open()) {
                const scene::Scene& scene = state_.document.scene;
                refused_.reset();
                import_sheet_.open({scene.dems, scene.dem, scene.holes}, "");
            }
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
        case Command::PanelKeys:
        case Command::MenuKeys:
            state_.settings.panels = true;
            if (command == Command::PanelKeys && window_->panels_have_keys())
                window_->take_keys_back();
            else
                gives_keys_ = command;
            state_.opens_menu = command == Command::MenuKeys;
            return true;
        case Command::Charts:
            state_.settings.charts = !state_.settings.charts;
            return true;
        case Command::Find:
            find_sheet_.open();
            return true;
        case Command::Keys:
        case Command::FirstSteps:
        case Command::About:
            sheet_ = sheet_ == command ? std::nullopt : std::optional(command);
            return true;
        case Command::Close:
            close_dialogs();
            return true;
        default:
            return false;
    }
}

void MainWindow::run_scene_command(Command command) {
    end_film_preview(command);
    switch (command) {
        case Command::Film:
            if (!film_->is_open()) {
                state_.playing = false;
                state_.settings.panels = true;
            }
            return film_->toggle();
        case Command::ReadAgain:
            return reload_effects();
        case Command::TakePicture:
            return take_picture();
        case Command::ExportPicture:
            return export_sheet_.open();
        case Command::CopyCommand:
            return copy_command();
        case Command::SaveScene:
            return messages_.try_to(
                [&] { messages_.report(with_overlay_note(save_scene(whole_scene()))); });
        case Command::SaveJob:
            return messages_.try_to([&] {
                messages_.report(
                    with_overlay_note(save_job(whole_scene(), state_.day, state_.document.zone)));
            });
        case Command::SunOverPoint:
            return ask_sun_over_point();
        case Command::SaveView:
            return save_view();
        case Command::Measure:
            return measure();
        case Command::EndMeasuring:
            return state_.measurement.end();
        case Command::DropCorner:
            return state_.measurement.drop_corner(state_.land, state_.spacing_m);
        case Command::SaveProfile:
            return save_profile();
        case Command::Compare:
            state_.compare_is_wanted = !state_.compare_is_wanted;
            return;
        case Command::Overlay:
            return toggle_overlay();
        case Command::SaveOverlay:
            return overlay_->start_export();
        case Command::GiveUpSaving:
            return overlay_->cancel_export();
        case Command::Play:
            if (film_->is_open()) return film_->play_or_pause();
            state_.playing = !state_.playing;
            return;
        case Command::Undo:
        case Command::Redo:
            return go_through_history(command);
        default:
            move(command);
    }
}

void MainWindow::go_through_history(Command command) {
    if (command == Command::Undo) {
        history_.end_step(state_.document);
        return history_.can_undo() ? restore(history_.undo())
                                   : messages_.note(tr("nothing to undo"));
    }
    history_.can_redo() ? restore(history_.redo()) : messages_.note(tr("nothing to redo"));
}

void MainWindow::close_dialogs() {
    if (opening_->can_cancel()) return opening_->cancel();
    sheet_.reset();
    state_.measurement.end();
    open_dialog_.close();
    import_sheet_.close();
    find_sheet_.close();
    export_sheet_.close();
    film_->close();
    closes_menus_ = true;
    state_.message.clear();
}

void MainWindow::open_neighbour(int step) {
    const std::string& file = opening_->requested_file();
    if (file.empty()) return;
    if (const std::string next = neighbour_in_folder(file, step); !next.empty())
        state_.files_to_open = {next};
    else
        messages_.show(tr("no other DEM in this folder"));
}

void MainWindow::toggle_overlay() {
    OverlayChoice& overlay = state_.document.overlay;
    overlay.kind = overlay.shows_day() ? OverlayKind::None : OverlayKind::Hours;
    overlay.period = OverlayPeriod::Day;
    overlay.visible = true;
    state_.step = true;
}

void MainWindow::move(Command command) {
    constexpr double kHour_s = 3600, kDay_s = 86400;
    history_.end_step(state_.document);
    const auto by = [&](double seconds) { state_.set_utc(state_.document.utc + seconds); };
    if (command == Command::Now)
        state_.set_utc(sun::Instant::now());
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
        look_to_moon();
    else if (!hand_->move(command, [this] { return whole_views(); })) {
        if (command == Command::Walk)
            messages_.note(tr("no ground to walk on here; click a point, then press G"));
        return;
    }
    if (command == Command::Whole) note_home();
    if (command == Command::Walk || command == Command::StandHere)
        messages_.note(hand_->is_walking()
                           ? tr("walking at eye height: W A S D, faster with Shift; G flies again")
                           : tr("flying: W A S D, Q down and E up, faster with Shift"));
    pacing_.moved();
    state_.step = true;
}

void MainWindow::move_to_point(Command command) {
    if (!state_.chosen) return messages_.note(tr("click a point on the ground first"));
    geo::Geodetic drawn = *state_.chosen;
    drawn.height_m = state_.land.ground_under(state_.land.frame->to_local(drawn));
    if (std::isnan(drawn.height_m)) return;
    const glm::dvec3 point_m = state_.land.frame->to_local(drawn);
    if (command == Command::StandHere)
        hand_->stand_at(point_m);
    else
        state_.document.pose = facing(state_.document.pose, state_.land, point_m);
}

void MainWindow::look_to_moon() {
    Pose& pose = state_.document.pose;
    const geo::Geodetic eye = view_of(pose, state_.land).eye->place;
    const sun::MoonPosition moon = sun::moon_position(state_.document.utc, eye);
    const double elevation_rad = state_.air.apparent_rad(moon.elevation_rad);
    if (elevation_rad < 0)
        return messages_.note(
            tr("the moon is below the horizon; the line above the day says when it is up"));
    pose.heading_deg = degrees(moon.azimuth_rad);
    pose.pitch_deg = degrees(elevation_rad);
}

void MainWindow::ask_sun_over_point() {
    const geo::Geodetic eye = view_of(state_.document.pose, state_.land).eye->place;
    if (!state_.chosen || opening_->is_preview()) return;
    if (std::isnan(state_.land.height_m(eye)))
        return messages_.note(tr("the eye is outside the DEM: right click, Stand here, then ask"));
    const Opened& opened = *opening_->opened();
    sun_over_.ask(
        {opened.dem, opened.scene, eye, *state_.chosen, state_.document.utc, state_.document.zone});
}

void MainWindow::poll_sun_over() {
    messages_.try_to([&] {
        const std::optional<SunOverAnswer> answer = sun_over_.poll();
        if (!answer) return;
        if (answer->utc) {
            state_.set_utc(*answer->utc);
            state_.step = true;
        }
        messages_.note(answer->words);
        pacing_.need_frames(3);
    });
}

void MainWindow::measure() {
    Measurement& line = state_.measurement;
    if (line.follows_cursor) return line.end();
    // A line that is done is replaced by one from the chosen point.
    if (line.corners_m.size() > 1) line.start(line.corners_m.front());
    if (line.corners_m.empty() && state_.cursor) line.start(state_.cursor->point_m);
    line.measure();
}

void MainWindow::save_profile() {
    if (!state_.measurement.profile) return;
    messages_.try_to([&] {
        const std::string text = csv_text(*state_.measurement.profile);
        const std::string name = write_under_free_name("csv", [&](OutputFile& file) {
            file.write(text);
            file.finish();
        });
        messages_.report(tr_format("{}: profile saved in {}", name, folder_of(name)));
    });
}

void MainWindow::restore(const Document& document) {
    hand_->rest();
    state_.restore(document);
    pacing_.moved();
}

Whole MainWindow::whole_views() const {
    scene::View above;
    above.orbit = {.azimuth_deg = 180, .elevation_deg = 90};
    above.fov_y_rad = state_.document.pose.fov_y_rad;
    Whole whole{pose_in(opening_->home_view()), pose_in(above)};
    // The vertical at the camera differs from that at the DEM's centre.
    whole.above = from_above(whole.above, state_.land, whole.above.eye_m, 0);
    const scene::Camera camera = camera_of(state_.document.pose, state_.land);
    const double aspect = size().x / size().y;
    const std::vector<glm::dvec3>& ground = opening_->opened()->outline.points;
    const auto visible = std::ranges::count_if(ground, [&](const glm::dvec3& point_m) {
        const auto at = in_picture(camera, point_m, aspect);
        return at && std::abs(at->x) < 1 && std::abs(at->y) < 1;
    });
    whole.in_view = static_cast<double>(visible) / std::max<std::size_t>(ground.size(), 1);
    return whole;
}

void MainWindow::save_view() {
    const SavedView view =
        saved_view(state_.document, state_.land, tr_format("View {}", state_.views.size() + 1));
    state_.views.push_back(view);
    messages_.note(state_.views.size() < 10
                       ? tr_format("saved as {}; key {} goes to it", view.name, state_.views.size())
                       : tr_format("saved as {}, in the menu View", view.name));
    remember_views();
}

void MainWindow::remember_views() {
    if (is_open())
        messages_.try_to([&] {
            memory_.write_views(absolute_names(opening_->opened()->scene.dems), state_.views);
        });
}

void MainWindow::go_to_view(std::size_t i) {
    if (i >= state_.views.size()) {
        messages_.note(tr_format("this DEM has no saved view {}; B saves one", i + 1));
        return;
    }
    const SavedView& view = state_.views[i];
    history_.end_step(state_.document);
    hand_->rest();
    state_.document.pose = pose_of(view, state_.land);
    state_.set_utc(view.utc);
    pacing_.moved();
    state_.step = true;
}

void MainWindow::show_zone(const std::string& name) {
    state_.document.zone = sun::choose_zone(name, state_.centre).zone;
    zone_ = name;
    state_.day = {};
    state_.set_utc(state_.document.utc);
    state_.step = true;
}

void MainWindow::go_to_place(geo::Geodetic place) {
    place.height_m = state_.land.height_m(place);
    if (std::isnan(place.height_m))
        return messages_.note(tr_format("the DEM has no ground at {}",
                                        coordinates_text(place, Coordinates::Degrees)));
    history_.end_step(state_.document);
    hand_->rest();
    geo::Geodetic drawn = place;
    drawn.height_m = state_.land.ground_under(state_.land.frame->to_local(place));
    const glm::dvec3 point_m = state_.land.frame->to_local(drawn);
    // At this many post spacings single posts are visible.
    constexpr double kPosts = 150;
    Pose& pose = state_.document.pose;
    pose = look_at(pose, state_.land, point_m,
                   std::min(distance(pose.eye_m, point_m), kPosts * state_.spacing_m));
    choose_point(point_m);
    pacing_.moved();
    state_.step = true;
}

scene::Scene MainWindow::whole_scene() const {
    scene::Scene scene = viewer::whole_scene(state_.document, state_.land, window_->size_px());
    overlay_->add_to(scene);
    return scene;
}

std::string MainWindow::with_overlay_note(const std::string& text) const {
    const std::string note = overlay_->missing_note();
    return note.empty() ? text : text + ", " + note;
}

void MainWindow::copy_command() {
    window_->copy(capture_command(whole_scene(), free_picture_name()));
    messages_.note(with_overlay_note(tr("the command for this picture is on the clipboard")));
}

void MainWindow::take_picture() {
    takes_picture_ = !is_image_complete();
    if (takes_picture_) return;
    pacing_.need_frames(2);  // for the message
    messages_.try_to([&] {
        std::string note = overlay_->missing_note();
        if (!note.empty()) note = tr_format("; its scene is {}", note);
        messages_.report(save_picture(*picture_, whole_scene(), *opening_->opened(),
                                      overlay_->coloured(*picture_)) +
                         note);
    });
}

scene::Scene MainWindow::scene_for(Document document, bool is_centred, double aspect) const {
    if (is_centred)
        document.pose = centred(document.pose, state_.land, panel_insets(),
                                static_cast<double>(size().x) / size().y, aspect);
    scene::Scene scene = viewer::whole_scene(document, state_.land, window_->size_px());
    overlay_->add_to(scene);
    return scene;
}

scene::Scene MainWindow::scene_to_export() const {
    return scene_for(state_.document, export_sheet_.is_centred(), export_sheet_.aspect());
}

void MainWindow::start_picture_export() {
    std::optional<PictureOrder> order = export_sheet_.take();
    if (!order || picture_export_) return;
    if (opening_->is_preview())
        return messages_.show(tr("the picture can be exported when all posts are read"));
    if (const std::string note = overlay_->missing_note(); !note.empty())
        messages_.note(tr_format("the picture is {}", note));
    picture_export_ = std::make_unique<PictureExport>(std::move(*order), device_name_,
                                                      opening_->opened()->dem, &Window::wake);
}

void MainWindow::poll_picture_export() {
    if (is_open()) start_picture_export();
    if (!picture_export_ || !picture_export_->is_done()) return;
    messages_.try_to([&] { messages_.report(picture_export_->result()); });
    picture_export_.reset();
    pacing_.need_frames(2);
}

}  // namespace relevo::viewer

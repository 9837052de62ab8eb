#include <algorithm>
#include <cmath>
#include <utility>

#include "viewer/main_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

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
        moves_->choose_point(*clicked->point_m);
        opens_point_menu_ = clicked->asks_for_menu;
    } else if (clicked && clicked->asks_for_menu) {
        line.end();
    } else if (clicked) {
        line.set_corner(*clicked->point_m, state_.land, state_.spacing_m);
    }
    if (line.follows_cursor && state_.cursor)
        line.follow(state_.cursor->point_m, state_.land, state_.spacing_m);
}

void MainWindow::process_keys() {
    for (const KeyPress& press : window_->take_keys()) {
        pacing_.need_frames(3);
        if (const auto command = command_of(press))
            state_.commands.push_back(*command);
        else if (!press.control && press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9)
            state_.view_to_go_to = static_cast<std::size_t>(press.key - GLFW_KEY_1);
    }
    if (const std::optional<Command> command = saver_->sheet().take_command()) {
        saver_->sheet().close();
        if (*command != Command::Film || !film_->is_open()) state_.commands.push_back(*command);
    }
    for (const Command command : std::exchange(state_.commands, {}))
        if (!run_program_command(command) && is_open()) run_scene_command(command);
    if (state_.view_to_go_to && is_open()) film_->end_preview();
    if (state_.view_to_go_to && is_open()) moves_->go_to_view(*state_.view_to_go_to);
    state_.view_to_go_to.reset();
    if (const auto place = find_sheet_.take(); place && is_open()) {
        film_->end_preview();
        moves_->go_to_place(*place);
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
        case Command::Open:
            opener_->ask_which();
            return true;
        case Command::HowToRead:
            opener_->ask_how();
            return true;
        case Command::NextFile:
            opener_->open_neighbour(1);
            return true;
        case Command::PreviousFile:
            opener_->open_neighbour(-1);
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
            return saver_->take_picture();
        case Command::ExportPicture:
            return saver_->sheet().open();
        case Command::CopyCommand:
            return saver_->copy_command();
        case Command::SaveScene:
            return saver_->save_scene();
        case Command::SaveJob:
            return saver_->save_job();
        case Command::SunOverPoint:
        case Command::MoonOverPoint:
            if (!state_.chosen) return;
            return moves_->ask_over_point(
                command == Command::SunOverPoint ? sun::Body::Sun : sun::Body::Moon, state_.chosen);
        case Command::NextMoonrise:
            return moves_->ask_over_point(sun::Body::Moon, std::nullopt);
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
            moves_->move(command);
    }
}

void MainWindow::go_through_history(Command command) {
    const bool is_undo = command == Command::Undo;
    if (is_undo) history_.end_step(state_.document);
    const std::string name = is_undo ? history_.undo_name(nullptr) : history_.redo_name();
    if (name.empty())
        return messages_.note(is_undo ? tr("nothing to undo") : tr("nothing to redo"));
    restore(is_undo ? history_.undo() : history_.redo());
    messages_.note(is_undo ? tr_format("undone: {}", name) : tr_format("redone: {}", name),
                   Messages::kShortNote);
}

void MainWindow::close_dialogs() {
    if (opening_->can_cancel()) return opening_->cancel();
    sheet_.reset();
    state_.measurement.end();
    opener_->close();
    find_sheet_.close();
    saver_->sheet().close();
    film_->close();
    closes_menus_ = true;
    state_.message.clear();
}

void MainWindow::toggle_overlay() {
    OverlayChoice& overlay = state_.document.overlay;
    overlay.kind = overlay.shows_day() ? OverlayKind::None : OverlayKind::Hours;
    overlay.period = OverlayPeriod::Day;
    overlay.visible = true;
    state_.step = true;
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

void MainWindow::show_zone(const std::string& name) {
    state_.document.zone = sun::choose_zone(name, state_.centre).zone;
    zone_ = name;
    state_.day = {};
    state_.set_utc(state_.document.utc);
    state_.step = true;
}

}  // namespace relevo::viewer

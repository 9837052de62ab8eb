#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "viewer/camera_moves.h"
#include "viewer/charts_panel.h"
#include "viewer/comparison.h"
#include "viewer/discard.h"
#include "viewer/file_opener.h"
#include "viewer/file_place.h"
#include "viewer/film_controller.h"
#include "viewer/find_sheet.h"
#include "viewer/frame_pacing.h"
#include "viewer/hand.h"
#include "viewer/history.h"
#include "viewer/mark_overlay.h"
#include "viewer/messages.h"
#include "viewer/opening.h"
#include "viewer/overlay_controller.h"
#include "viewer/overlay_panel.h"
#include "viewer/point_query.h"
#include "viewer/scene_saver.h"
#include "viewer/state.h"
#include "viewer/window.h"
#include "viewer/window_style.h"

namespace relevo::viewer {

/// Joins the parts of the viewer: runs the event loop and carries out keys and commands.
class MainWindow {
  public:
    /// @param device  as session::Options
    MainWindow(const scene::Scene& scene, const std::string& device);
    /// Returns when the window is closed. @throws gl::DeviceLost
    void run();
    /// As it is now, for another window to begin with.
    scene::Scene scene() const;
    /// Since when it has shown pictures; 0 before the first one.
    Clock::duration shown_for() const;

  private:
    // ---- event loop and frames: main_window.cpp

    bool is_open() const { return opening_->opened() != nullptr; }
    /// Whether the first picture is still to come.
    bool shows_card() const;
    /// Whether the image is overdue, so that the status line reports it.
    bool is_drawing() const;
    /// For the status line; empty: none.
    std::string work_in_progress() const;
    void leave();
    /// Whether a frame would repeat the last one while an image of the moving scene is due.
    bool repeats_frame() const;
    void draw_window();
    glm::vec2 size() const { return window_->size(); }
    /// Pixels per unit of a layout for the default text size.
    double unit() const;
    Layout layout() const;
    scene::Insets panel_insets() const;
    /// The middle of what the panels leave free of the window.
    glm::vec2 free_middle() const;
    void draw_panels();
    void draw_over_image();
    /// Reports changes since the last frame to the other parts.
    void hand_over();
    void hand_over_scene();
    void find_files_outside(const Opened& opened);
    void check_files();
    void remember_settings();

    // ---- the open scene and its images: main_window_scene.cpp

    void reload_effects();
    void reload_dem();
    /// What the thread of a scene begins with.
    Wanted first_wanted() const;
    /// Clears what belongs to the scene before the one that is open now.
    void clear_scene();
    void want_view();
    Wanted wanted_now() const;
    void poll_threads();
    void poll_opening();
    void poll_images();
    /// Names the place in the window's title: after the first picture, as reading names takes time.
    void poll_place();
    void stop_comparison();
    /// @param is_first  of the window
    /// @param view      of a DEM that was read again; none: the scene's
    void start_scene(bool is_first, const std::optional<scene::View>& view);
    /// After the DEM was read again. Keeps view, time and steps of undo.
    void restart_scene(const Opened& before);
    /// The time at which a scene without one is shown: that of the clocks before, or, unless the
    /// time is pinned, the next to it that has sun. Says so if it is another.
    sun::Instant time_from(const sun::Zone& zone_before);
    /// @param before  the scene with a coarse DEM
    void complete_scene(const Opened& before);
    /// After the exaggeration has changed.
    void take_shape();
    /// Ends the choice of the vertical scale once the time is another one than that it was opened
    /// at.
    void show_true_heights();
    void use_dem();
    /// Moves the eye to where the image was drawn from: the thread raises it above drawn ground.
    void raise_eye();
    /// Whether the displayed image is of the view, time and size that are wanted now.
    bool is_image_of_now() const;
    /// Whether it is also sharp and has the overlay.
    bool is_image_complete() const;

    // ---- keys and commands: main_window_commands.cpp

    void process_mouse(double passed_s);
    void process_keys();
    /// Commands that need no open scene. @returns whether `command` is one
    bool run_program_command(Command command);
    void run_scene_command(Command command);
    void close_dialogs();
    void measure();
    void save_profile();
    void toggle_overlay();
    /// Undo or Redo.
    void go_through_history(Command command);
    void restore(const Document& document);
    void save_view();
    void remember_views();
    /// Shows times in another zone. @throws Error (BadInput) for an unknown one
    void show_zone(const std::string& name);

    // ---- films: main_window_film.cpp

    std::unique_ptr<FilmController> make_film();
    /// Whether the window is closed: after a question if a film is being drawn.
    bool ends();
    /// Shows the frame of the film that is due, or ends its preview if the user moves the camera.
    void process_film(double passed_s);
    /// Restores the scene before a command that changes it.
    void end_film_preview(Command before);
    void draw_film();

    std::unique_ptr<Window> window_;  // ends after the threads that wake it
    Discard discard_;
    std::string device_name_;
    SceneDevice device_;
    std::string zone_;  // of --tz
    Memory memory_ = Memory::of_user();
    State state_;
    Settings written_;  // as in memory_
    Messages messages_{state_.message};
    FramePacing pacing_;
    History history_;
    FindSheet find_sheet_;
    ChartsPanel charts_;
    LegendPicture legend_;
    MarkOverlay marks_, marks_before_;
    LayerFiles layer_files_;  // as outside_ looks for them
    std::unique_ptr<OutsideWork> outside_ = std::make_unique<OutsideWork>(&Window::wake);
    std::unique_ptr<Opening> opening_;
    std::unique_ptr<Hand> hand_;
    std::unique_ptr<Comparison> comparison_;
    std::unique_ptr<PointQuery> point_;
    std::unique_ptr<OverlayController> overlay_;
    std::unique_ptr<CameraMoves> moves_;
    std::unique_ptr<SceneSaver> saver_;
    std::unique_ptr<FilmController> film_;
    std::unique_ptr<FileOpener> opener_;
    std::unique_ptr<WindowStyle> style_;
    std::shared_ptr<const Picture> picture_;
    std::optional<Wanted> wanted_;
    int effects_read_ = 0;      // as in Wanted
    sun::Instant first_utc_{};  ///< at which the scene began
    const Clock::time_point began_at_ = Clock::now();
    Clock::time_point checked_at_ = Clock::now();  // files
    std::optional<Clock::time_point> first_picture_at_;
    std::future<std::string> place_;  // of the DEM, in words
    bool names_place_ = false;        // once there is a picture
    bool sun_moved_ = false;          // in the frame before
    bool has_new_input_ = false;      // ImGui has processed input since process_mouse()
    std::optional<Command> sheet_;    // of help, that is shown
    bool closes_menus_ = false;
    bool opens_point_menu_ = false, quits_ = false;
    std::optional<Command> gives_keys_;  // PanelKeys or MenuKeys: when they are drawn
};

}  // namespace relevo::viewer

#pragma once

#include <memory>
#include <optional>
#include <string>

#include "session/trust.h"
#include "viewer/charts_panel.h"
#include "viewer/comparison.h"
#include "viewer/discard.h"
#include "viewer/export_sheet.h"
#include "viewer/file_kind.h"
#include "viewer/film_controller.h"
#include "viewer/find_sheet.h"
#include "viewer/frame_pacing.h"
#include "viewer/hand.h"
#include "viewer/history.h"
#include "viewer/import_sheet.h"
#include "viewer/mark_overlay.h"
#include "viewer/messages.h"
#include "viewer/open_dialog.h"
#include "viewer/opening.h"
#include "viewer/overlay_controller.h"
#include "viewer/overlay_panel.h"
#include "viewer/point_query.h"
#include "viewer/state.h"
#include "viewer/sun_over.h"
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
    /// The pose of a view that leaves room for the panels.
    Pose pose_in(const scene::View& view) const;
    /// After the window was resized: the whole DEM stays in view if the camera shows that.
    void fit_home();
    /// Notes that the camera shows the whole DEM in this window.
    void note_home();

    // ---- files: main_window_files.cpp; they throw Error (BadInput) for files that are wrong

    void open_requested_files();
    void open_files(const std::vector<std::string>& files);
    void open_dem(const RecentDem& dem);
    /// Opens what the sheet gives, as part of the scene that could not be opened.
    void open_imported(const RecentDem& dem);
    void open_scene(scene::Scene scene);
    void open_file(FileKind kind, const std::string& path);
    /// Opens a scene that a file names, without plugin folders and names on the net in it.
    void open_named_scene(scene::Scene scene, const std::string& path, session::NamedBy by);
    /// Switches on an effect that shows the places or lines of a file.
    void show_features(FileKind kind, const std::string& path);
    void lay_over(const std::string& path);
    /// Stands where a photograph was taken, at its time, with its lens.
    void stand_where_taken(const std::string& path);
    /// After a DEM could not be opened: shows the sheet if options could help.
    void ask_how_to_read();

    // ---- keys and commands: main_window_commands.cpp

    void process_mouse(double passed_s);
    void choose_point(const glm::dvec3& point_m);
    void process_keys();
    /// Commands that need no open scene. @returns whether `command` is one
    bool run_program_command(Command command);
    void run_scene_command(Command command);
    void close_dialogs();
    void open_neighbour(int step);
    void measure();
    void save_profile();
    void toggle_overlay();
    /// Undo or Redo.
    void go_through_history(Command command);
    void restore(const Document& document);
    void move(Command command);
    /// Stands on the chosen point, or looks at it.
    void move_to_point(Command command);
    void look_to_moon();
    void ask_sun_over_point();
    void poll_sun_over();
    /// The whole DEM, from its side and from above.
    Whole whole_views() const;
    void save_view();
    void remember_views();
    void go_to_view(std::size_t i);
    void go_to_place(geo::Geodetic place);
    /// Shows times in another zone. @throws Error (BadInput) for an unknown one
    void show_zone(const std::string& name);
    /// The scene for export.
    scene::Scene whole_scene() const;
    /// A message of what was saved, with a note if the overlay is not part of it.
    std::string with_overlay_note(const std::string& text) const;
    void copy_command();
    /// Saves the image as soon as it is complete.
    void take_picture();
    /// The scene of a document for a picture.
    /// @param is_centred  on what the panels leave free
    scene::Scene scene_for(Document document, bool is_centred, double aspect) const;
    /// The scene of a picture of the sheet.
    scene::Scene scene_to_export() const;
    void start_picture_export();
    void poll_picture_export();

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
    std::string zone_;      // of --tz
    const bool is_cached_;  // not --no-cache
    Memory memory_ = Memory::of_user();
    State state_;
    Settings written_;  // as in memory_
    Messages messages_{state_.message};
    FramePacing pacing_;
    History history_;
    OpenDialog open_dialog_;
    ImportSheet import_sheet_;
    FindSheet find_sheet_;
    ExportSheet export_sheet_;
    std::unique_ptr<PictureExport> picture_export_;
    std::optional<scene::Scene> refused_;  // for whose DEM the sheet was opened
    ChartsPanel charts_;
    LegendPicture legend_;
    MarkOverlay marks_, marks_before_;
    std::unique_ptr<Opening> opening_;
    std::unique_ptr<Hand> hand_;
    std::unique_ptr<Comparison> comparison_;
    std::unique_ptr<PointQuery> point_;
    SunOver sun_over_;
    std::unique_ptr<OverlayController> overlay_;
    std::unique_ptr<FilmController> film_;
    std::unique_ptr<WindowStyle> style_;
    std::shared_ptr<const Picture> picture_;
    std::optional<Wanted> wanted_;
    int effects_read_ = 0;      // as in Wanted
    sun::Instant first_utc_{};  ///< at which the scene began
    std::optional<Pose> home_;  // of the whole DEM,
    glm::vec2 home_size_{0};    // in a window of this size
    const Clock::time_point began_at_ = Clock::now();
    Clock::time_point checked_at_ = Clock::now();  // files
    std::optional<Clock::time_point> first_picture_at_;
    bool sun_moved_ = false;        // in the frame before
    bool has_new_input_ = false;    // ImGui has processed input since process_mouse()
    std::optional<Command> sheet_;  // of help, that is shown
    bool closes_menus_ = false, takes_picture_ = false;
    bool opens_point_menu_ = false, quits_ = false;
    std::optional<Command> gives_keys_;  // PanelKeys or MenuKeys: when they are drawn
};

}  // namespace relevo::viewer

#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "viewer/charts_panel.h"
#include "viewer/discard.h"
#include "viewer/file_watch.h"
#include "viewer/folder_watch.h"
#include "viewer/hand.h"
#include "viewer/history.h"
#include "viewer/open_panel.h"
#include "viewer/overlay_panel.h"
#include "viewer/state.h"
#include "viewer/sun_overlay.h"
#include "viewer/window.h"

namespace relevo::viewer {

using Clock = std::chrono::steady_clock;

/// After the last input the hand counts as moving for so long.
inline constexpr double kRest_s = 0.15;
/// Files are looked at again so often.
inline constexpr double kWatch_s = 1;

inline double seconds_since(Clock::time_point began) {
    return std::chrono::duration<double>(Clock::now() - began).count();
}

/// The window's whole life: what hand, panels, files and threads have to do with each other.
class MainWindow {
  public:
    MainWindow(const scene::Scene& scene, std::string device);
    void run();

  private:
    // ---- frames: main_window.cpp

    bool is_open() const { return opened_ != nullptr; }
    /// Whether the picture is late, so that it is said.
    bool is_drawing() const;
    /// Ends what works beside. Nobody waits for a DEM to be read that nobody will see.
    void leave();
    /// Whether drawing the window would show what is in it already, as far as anyone minds.
    bool shows_the_same() const;
    void draw_window();
    /// How long nothing but input can change what is seen.
    double waiting_s() const;
    void read_point_work();
    glm::vec2 size() const { return window_->size(); }
    void moved();
    /// The chosen point's light is that of the day that is shown.
    void follow_the_day();
    void pass_time(double passed_s);
    /// Pixels for a unit of what is made for usual letters.
    double unit() const;
    void panels();
    void want_view();
    void hand_over();
    void hand_over_scene();
    Wanted wanted_now() const;
    void follow_drawn_ground();
    static bool same(const Wanted& a, const Wanted& b);

    // ---- opening and comparing: main_window_scenes.cpp

    void open();
    /// From now on the left of the line is drawn with the effects as they are now.
    void compare();
    void stop_comparing();
    void want_size();
    /// Beside the panels as they are.
    Pose pose_in(const scene::View& view) const;
    Whole whole_views() const;
    scene::Insets insets() const;
    void read_thread();
    void watch_comparison();
    /// To what was open before, once: it may be gone as well.
    void go_back(std::string why);
    /// What is being read is left to itself, and its result to nobody.
    void give_up_opening();
    /// The scene has been opened: from here on it can be moved in.
    void start(std::shared_ptr<const Opened> opened);
    /// What is told of the ground is told of the DEM that is open.
    void stand_on_ground();
    /// Of the DEM that is open all posts are there, and those that stood in are not shown any more.
    void take_all_posts(std::shared_ptr<const Opened> opened);
    /// Whether no figure may come of the heights in memory yet.
    bool stands_in() const;
    void watch(const scene::Scene& scene);
    void read_again();
    void open_files();
    /// Beside the one that was tried last, so that one that is no DEM is not the end of the way.
    void open_neighbour(int by);
    void ask_for_dem();
    /// Effects are read again when their files are written, and the DEM when its are.
    void watch_files();

    // ---- what keys, menus and the hand ask for: main_window_commands.cpp

    void take_hand(double passed_s);
    void choose_point(const glm::dvec3& point_m);
    void keys();
    /// What can be done while nothing is open. @returns whether it is such
    bool of_program(Command command);
    void of_scene(Command command);
    void move(Command command);
    void measure();
    /// Restores a state of the history.
    void go_to(const Document& document);
    void keep_view();
    void go_to_view(std::size_t i);
    void go_to_place(const std::string& text);
    /// What the hand has moved is a step of undo when it has come to rest.
    void step_at_rest();

    // ---- what is kept, told and taken away: main_window_kept.cpp

    void remember_views();
    /// Whether panels have letters to show that no font has been loaded with.
    bool wants_new_letters();
    /// Between frames, where fonts may be made anew.
    void restyle();
    void remember_settings();
    /// A home that nothing can be written to is not what the window is for.
    template <typename Do>
    static void remember(const Do& act) {
        try {
            act();
        } catch (const Error& error) {
            log::warning(error.what());
        }
    }
    scene::Scene whole() const;
    void copy_command();
    /// Whether the picture is what was wanted last.
    bool is_answered() const;
    void take_picture();
    /// Tells of something that was done, for a while.
    void tell(std::string what);
    /// Likewise of a file, also where the program was started.
    void done(std::string what);
    void end_message();
    template <typename Do>
    void say_or_fail(const Do& act) {
        try {
            act();
        } catch (const Error& error) {
            state_.message = error.what();
            log::warning(error.what());
        }
    }

    // ---- figures of the sun on the ground: main_window_overlay.cpp

    /// A raster that was written, and what is in it.
    struct SavedOverlay {
        OverlayWanted of;
        std::string file;        ///< absolute
        std::string shown_name;  ///< as it is told of
    };
    /// None: nothing is to lie there, or not yet.
    std::optional<OverlayWanted> overlay_wanted() const;
    /// Whether figures of the sun are to lie there when all posts have been read.
    bool overlay_waits() const;
    /// What lies on the ground is of the day, the moment or the file that is shown.
    void follow_overlay();
    void lay_overlay();
    /// Whether what lies there is what was asked for, to the last post.
    bool overlay_rests() const;
    /// The file of the figures that are shown; null: there is none yet.
    const SavedOverlay* saved_overlay() const;
    /// Writes them, when they are there.
    void save_overlay();
    void watch_saving();
    void give_up_saving();
    /// Into a scene what lies on the ground, as far as a file has it.
    void put_overlay(scene::Scene& scene) const;
    /// What is to be said of a scene that lacks it; else empty.
    std::string overlay_note() const;
    /// What colours of the shown picture mean.
    std::vector<chart::Legend> legends() const;

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
    std::unique_ptr<OverlayWork> overlay_work_;
    std::optional<OverlayWanted> asked_overlay_;
    std::unique_ptr<OverlaySave> overlay_save_;
    std::vector<SavedOverlay> saved_overlays_;
    const EffectsModel* lettered_ = nullptr;  // whose names have their letters
    LegendPicture legend_;
    bool saves_when_whole_ = false;
    History history_;
    scene::View home_view_;     // of the DEM when it was opened first
    bool reads_again_ = false;  // the same DEM, which was written meanwhile
    std::shared_ptr<const Picture> picture_;
    std::unique_ptr<SceneThread> before_;  // of a comparison
    std::shared_ptr<const Picture> picture_before_;
    std::optional<Wanted> wanted_;
    std::optional<scene::Scene> last_good_;    // that was open
    std::optional<scene::Scene> good_before_;  // likewise, before that
    std::string tried_;                        // the DEM that was to be opened last
    bool has_gone_back_ = false, has_failed_ = false;
    std::optional<std::future<std::vector<std::string>>> asked_files_;
    OpenPanel open_panel_;  // where the desktop has no dialog
    FolderWatch effect_files_;
    FileWatch dem_files_;
    Clock::time_point watched_at_ = Clock::now();
    bool sun_moved_ = false;  // in the frame before
    std::string told_;
    Clock::time_point told_at_;
    Clock::time_point frame_at_ = Clock::now(), moved_at_ = Clock::now(), drawn_at_;
    bool has_new_picture_ = false;
    int drawn_buttons_ = 0;      // of the mouse
    bool input_is_new_ = false;  // clicks and turns of the wheel, since they were taken
    bool rested_ = true, sheet_ = false, takes_when_sharp_ = false;
    bool closes_menus_ = false;
    int busy_frames_ = 3;  // that panels still need to settle
};

}  // namespace relevo::viewer

#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "base/folder_watch.h"
#include "viewer/discard.h"
#include "viewer/file_watch.h"
#include "viewer/messages.h"
#include "viewer/scene_thread.h"

namespace relevo::viewer {

/// The open scene, and the next one while it opens. The open scene stays, with its image, until the
/// next one is open; if that fails nothing has changed.
class Opening {
  public:
    enum class Event {
        None,
        Opened,    ///< opened() is another scene
        Reloaded,  ///< the same DEM was read again; opened() is another
        Changed,   ///< opened() is the same scene with all posts, or another exaggeration
        Failed,    ///< the next scene could not be opened: take_failure()
        Broken,    ///< the posts of the open scene cannot be read completely
    };

    /// A scene that could not be opened.
    struct Failure {
        scene::Scene scene;
        std::string reason;
    };

    /// Starts to open a scene. @param messages, discard  outlive this
    Opening(scene::Scene scene, const SceneDevice& device, Messages& messages, Discard& discard);

    /// Opens another scene. One that is being opened is given up.
    /// @param first  what its thread begins with: size and insets of the window
    void open(scene::Scene scene, const Wanted& first);
    /// Opens a scene of the same DEM after its files changed. home_view() stays.
    void reload(scene::Scene scene, const Wanted& first);
    /// Opens the last scene of which all posts were read again, after Event::Broken.
    void go_back(const Wanted& first);
    /// Gives up the next scene. Requires can_cancel().
    void cancel();
    bool can_cancel() const { return opened_ && next_; }
    bool is_opening() const { return next_.has_value() && !is_refused(); }
    Event poll();
    std::optional<Failure> take_failure() { return std::exchange(failure_, std::nullopt); }
    /// Whether the first scene could not be opened, and no other has been requested since.
    bool is_refused() const { return first_error_ != nullptr; }
    /// Throws why the first scene could not be opened. Requires is_refused().
    [[noreturn]] void throw_refusal() const { std::rethrow_exception(first_error_); }

    /// The thread of the open scene, or of the first one while it opens or if it was refused.
    SceneThread& thread() const { return opened_ ? *open_.thread : *next_->thread; }
    /// Null: the first scene is still being opened.
    const std::shared_ptr<const Opened>& opened() const { return opened_; }
    /// Whether opened() has a coarse DEM until all posts are read.
    bool is_preview() const { return opened_ && opened_->dem->is_preview; }
    /// The open scene as requested, not as opened.
    const scene::Scene& scene() const { return opened_ ? open_.scene : next_->scene; }
    /// The scene that is being opened. Requires is_opening().
    const scene::Scene& next_scene() const { return next_->scene; }
    /// The scene's view when its DEM was opened first, chosen from all posts if they are read.
    const scene::View& home_view() const { return home_view_; }
    /// The first file of the DEM that the user asked for last.
    const std::string& requested_file() const { return requested_file_; }

    /// Whether files of effects have changed since the last call that returned true.
    bool effects_changed() { return effect_files_.changed(); }
    /// Whether files of the DEM have changed and all exist.
    bool dem_changed() { return dem_files_.changed() && dem_files_.all_there(); }

  private:
    struct Attempt {
        scene::Scene scene;
        std::unique_ptr<SceneThread> thread;
        bool is_reload = false;
    };

    void begin(scene::Scene scene, bool is_reload);
    void fail(std::string reason);
    Event poll_next();
    Event poll_open();
    Event accept(std::shared_ptr<const Opened> opened);
    void watch_files();

    SceneDevice device_;
    Messages& messages_;
    Discard& discard_;
    Attempt open_;  // without a thread until the first scene is open
    std::optional<Attempt> next_;
    std::shared_ptr<const Opened> opened_;  // of open_
    bool is_broken_ = false;                // its posts cannot be read completely
    bool went_back_ = false;                // open_ or next_ is complete_, after a failure
    std::optional<Failure> failure_;
    std::exception_ptr first_error_;        // while the first scene is refused; next_ is its
    std::optional<scene::Scene> complete_;  // the last one whose posts were all read
    scene::View home_view_;
    std::string requested_file_;
    FileWatch dem_files_;
    FolderWatch effect_files_;
};

}  // namespace relevo::viewer

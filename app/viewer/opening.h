#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/folder_watch.h"
#include "viewer/discard.h"
#include "viewer/file_watch.h"
#include "viewer/messages.h"
#include "viewer/scene_thread.h"

namespace relevo::viewer {

/// Opens one scene at a time on a thread of its own. If a scene cannot be opened, it opens the last
/// one that could.
class Opening {
  public:
    enum class Event {
        None,
        Opened,     ///< opened() is available
        Completed,  ///< all posts of the DEM have replaced coarse ones; opened() is another
        WentBack,   ///< the scene cannot be opened; scene() is the last good one, being opened
        Failed,     ///< the last good scene cannot be opened either
    };

    /// Starts to open a scene. @param messages, discard  outlive this
    Opening(scene::Scene scene, const SceneDevice& device, Messages& messages, Discard& discard);

    /// Opens another scene.
    void open(scene::Scene scene);
    /// Opens a scene of the same DEM after its files changed. home_view() stays.
    void reload(scene::Scene scene);
    /// Opens the last good scene instead. Requires can_cancel().
    void cancel();
    bool can_cancel() const { return !opened_ && attempt_ == Attempt::Requested && last_good_; }
    /// @throws std::exception if the first scene cannot be opened
    Event poll();

    SceneThread& thread() const { return *thread_; }
    /// Null: the scene is still being opened.
    const std::shared_ptr<const Opened>& opened() const { return opened_; }
    /// Whether opened() has a coarse DEM until all posts are read.
    bool is_preview() const { return opened_ && opened_->dem->is_preview; }
    bool has_failed() const { return attempt_ == Attempt::Failed; }
    bool has_last_good() const { return last_good_.has_value(); }
    /// As requested, not as opened.
    const scene::Scene& scene() const { return scene_; }
    /// The scene's view when its DEM was opened first.
    const scene::View& home_view() const { return home_view_; }
    /// The first file of the DEM that the user asked for last; empty: none was opened yet.
    const std::string& requested_file() const { return requested_file_; }

    /// Whether files of effects have changed since the last call that returned true.
    bool effects_changed() { return effect_files_.changed(); }
    /// Whether files of the DEM have changed and all exist.
    bool dem_changed() { return dem_files_.changed() && dem_files_.all_there(); }

  private:
    enum class Attempt { Requested, Fallback, Failed };

    void begin(scene::Scene scene);
    Event go_back(std::string reason);
    void accept(std::shared_ptr<const Opened> opened);
    void watch_files();

    SceneDevice device_;
    Messages& messages_;
    Discard& discard_;
    scene::Scene scene_;
    std::unique_ptr<SceneThread> thread_;
    std::shared_ptr<const Opened> opened_;
    Attempt attempt_ = Attempt::Requested;
    bool is_reload_ = false;
    std::optional<scene::Scene> last_good_, last_good_before_;
    scene::View home_view_;
    std::string requested_file_;
    FileWatch dem_files_;
    FolderWatch effect_files_;
};

}  // namespace relevo::viewer

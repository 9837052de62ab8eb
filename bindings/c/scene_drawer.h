#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "dem.h"
#include "image/image.h"
#include "scene/job.h"
#include "session/scene_inputs.h"
#include "session/scene_times.h"
#include "session/shot_session.h"

namespace relevo::c {

/// Pixels with what they show.
struct DrawnData {
    std::vector<image::Channel> channels;
    geo::Geodetic origin;  ///< of positions
};

/// The scene behind a session's handle. All of it on one thread.
class SceneDrawer {
  public:
    /// @param dem     the scene's; null: opened from the scene
    /// @param folder  from which file names of changes count
    /// @throws Error as session::Session's constructor
    SceneDrawer(scene::Scene scene, std::shared_ptr<Dem> dem, std::string device,
                std::filesystem::path folder);

    /// @throws Error; the scene is then as it was
    void change(const char* text);
    void resize(int columns, int rows);

    /// The scene with what was chosen for it.
    const scene::Scene& settled() const { return shot_.scene; }
    /// Size of picture(). @throws Error as it
    glm::ivec2 picture_px();
    /// As it is drawn, kept until the scene changes. @throws Error as session::Session
    const image::Image8& picture();
    /// @throws Error (BadInput) for what has no data: pictures with margins, of two eyes, all
    /// around
    void check_has_data() const;
    /// @throws Error as picture() and check_has_data()
    DrawnData data();

  private:
    void take(scene::Scene scene);

    std::shared_ptr<Dem> dem_;
    std::filesystem::path folder_;
    session::SceneTimes times_;
    session::SceneInputs inputs_;
    FilesInUse files_;
    session::ShotSession colours_, data_;
    scene::Scene given_;  ///< what the caller has said
    scene::Shot shot_;    ///< with what was chosen
    /// Whether colours_ shows it: a change that failed may have left parts of another scene.
    bool is_shown_ = false;
    std::optional<image::Image8> drawn_;
};

}  // namespace relevo::c

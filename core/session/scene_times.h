#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/job.h"
#include "session/session.h"

namespace relevo::session {

/// Key of the DEM that a scene shows and of how it is read. Equal keys mean the same DEM.
/// @param scene  with absolute paths
std::string dem_key(const scene::Scene& scene);

/// Determines the times and views of many scenes from their DEMs. Opens each DEM once and logs each
/// assumption once.
class SceneTimes {
  public:
    SceneTimes();
    ~SceneTimes();
    SceneTimes(const SceneTimes&) = delete;
    SceneTimes& operator=(const SceneTimes&) = delete;

    /// Sets a function that is called before the heights of a scene's DEM are read. The scene has
    /// absolute paths.
    void before_reading(std::function<void(const scene::Scene&)> call);

    /// Uses a DEM that has been read, all its posts, for the scenes that show it as `scene` does.
    void use(const scene::Scene& scene, std::shared_ptr<const LoadedDem> dem);

    /// As scene::with_absolute_paths(), with results cached per list of DEMs.
    scene::Scene with_absolute_paths(scene::Scene scene);

    /// Time of a scene; by default an hour whose sun shows relief. @throws Error as words.h's
    /// parse()
    sun::ParsedTime of(const scene::Scene& scene);

    /// The scene's DEM, opened if necessary. @throws Error as dem::Source::open()
    std::shared_ptr<const dem::Source> source(const scene::Scene& scene);

    /// The scene's DEM with its heights, read if necessary. Frees the heights of other DEMs, so
    /// that a job of many DEMs needs the memory of one.
    std::shared_ptr<const LoadedDem> loaded(const scene::Scene& scene);

    /// The scene's view with the default angles of a session where none are given.
    scene::View settled_view(const scene::Scene& scene);

    /// scene::fit_map(): sets the size of a scene whose picture is a map.
    /// @throws Error (BadInput) as that, and as dem::Source::open()
    void fit_map(scene::Scene& scene);

    /// The scene's ground, for cameras that move over it. Keeps the DEM alive; must not outlive
    /// this.
    scene::MotionGround motion_ground(const scene::Scene& scene);

    /// Frees all DEMs but the scene's.
    void keep_only(const scene::Scene& scene);

  private:
    struct Dem;
    struct Shown;
    Dem& dem_of(const scene::Scene& scene);
    std::string key_of(const scene::Scene& scene);
    Shown& shown_of(const scene::Scene& scene);
    sun::Instant default_time(const scene::Scene& scene);
    std::string zone_of_middle(const std::string& words, Dem& dem);

    std::function<void(const scene::Scene&)> before_reading_;
    // By the paths as given.
    std::map<std::vector<std::string>, std::vector<std::string>> absolute_;
    std::map<std::string, std::unique_ptr<Dem>> dems_;
    std::string logged_;
};

}  // namespace relevo::session

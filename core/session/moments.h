#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/job.h"
#include "session/session.h"

namespace relevo::session {

/// Which DEM a scene shows and how it is read; equal texts are one DEM.
/// @param scene  with absolute paths
std::string dem_key(const scene::Scene& scene);

/// Finds the moments of many scenes, by the DEMs that they show: each is opened once. What is
/// assumed is said once.
class Moments {
  public:
    Moments();
    ~Moments();
    Moments(const Moments&) = delete;
    Moments& operator=(const Moments&) = delete;

    /// Is called before the heights of a scene's DEM are read, with absolute paths.
    void before_reading(std::function<void(const scene::Scene&)> call);

    /// As scene::with_absolute_paths(), which asks the file system once for each list of DEMs: jobs
    /// have many pictures of the same ones.
    scene::Scene with_absolute_paths(scene::Scene scene);

    /// A scene's moment; without words the hour that shows relief. @throws Error as words.h's
    /// parse()
    sun::ParsedTime of(const scene::Scene& scene);

    /// The scene's DEM with its heights, which are read where they have not been. Those of the DEM
    /// before are let go of: a job of many DEMs takes the memory of one.
    std::shared_ptr<const LoadedDem> loaded(const scene::Scene& scene);

    /// The scene's view with the angles that a session chooses where it leaves some open.
    scene::View settled_view(const scene::Scene& scene);

    /// Lets go of all DEMs but the scene's.
    void keep_only(const scene::Scene& scene);

  private:
    struct Dem;
    struct Shown;
    Dem& dem_of(const scene::Scene& scene);
    std::string key_of(const scene::Scene& scene);
    Shown& shown_of(const scene::Scene& scene);
    sun::Instant usual_moment(const scene::Scene& scene);
    std::string zone_of_middle(const std::string& words, Dem& dem);

    std::function<void(const scene::Scene&)> before_reading_;
    std::map<std::vector<std::string>, std::vector<std::string>> absolute_;  // names of DEMs
    std::map<std::string, std::unique_ptr<Dem>> dems_;
    std::string told_;
};

}  // namespace relevo::session

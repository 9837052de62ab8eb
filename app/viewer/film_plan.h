#pragma once

#include <functional>
#include <memory>
#include <string>

#include "scene/job.h"
#include "session/scene_times.h"
#include "session/session.h"
#include "viewer/film_choice.h"
#include "viewer/latest_work.h"

namespace relevo::viewer {

struct FilmWanted {
    FilmWish wish;
    std::shared_ptr<const session::LoadedDem> dem;  ///< of the wish's scene, all its posts
};

/// The frames of a film, as `relevo run` draws them.
struct FilmPlan {
    FilmWanted of;
    scene::Scene scene;   ///< of the job
    scene::FilmJob film;  ///< the job in words
    scene::Job job;       ///< as it was read from the text of `film`
    scene::Shots frames;
    std::string note;   ///< what it shows instead of what was asked for; empty: nothing
    std::string error;  ///< why there are no frames; empty: there are
};

/// Plans a film. The frames are those of the job's file.
/// @param times  of earlier plans or new
FilmPlan plan_film(const FilmWanted& wanted, session::SceneTimes& times);

/// Plans the latest film in the background.
class FilmWork : public LatestWork<FilmWanted, FilmPlan> {
  public:
    explicit FilmWork(std::function<void()> on_change);
    ~FilmWork() override { end(); }

  private:
    void work_out(const FilmWanted* wanted) override;

    // Used on the thread only.
    std::unique_ptr<session::SceneTimes> times_;
    std::shared_ptr<const session::LoadedDem> dem_;  // that times_ has
    std::string dem_key_;
};

}  // namespace relevo::viewer

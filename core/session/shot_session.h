#pragma once

#include <exception>
#include <memory>
#include <string>

#include "base/files_in_use.h"
#include "scene/job.h"
#include "session/picture_maker.h"
#include "session/scene_times.h"
#include "session/session.h"

namespace relevo::session {

/// The message of a failure of one picture.
std::string reason_of(const std::exception_ptr& thrown);

/// The scene with a default camera: an impossible camera must fail its picture, not the session.
scene::Scene of_any_view(scene::Scene scene);

/// The session that draws shots one after the other. Shots of one DEM that need the same of the
/// renderer share it.
class ShotSession {
  public:
    /// @param options  with a format, without a DEM
    ShotSession(Options options, SceneTimes& times, FilesInUse& files)
        : options_(std::move(options)), times_(times), files_(files) {}

    /// Opens a session for the shot's DEM unless it is already open.
    /// @throws Error as Session's constructor
    Session& of(const scene::Shot& shot);
    bool was_opened() const { return opened_; }  ///< at least once

  private:
    Options options_;
    SceneTimes& times_;
    FilesInUse& files_;
    std::unique_ptr<Session> session_;
    std::string dem_;
    RendererNeeds needs_;
    bool opened_ = false;
};

}  // namespace relevo::session

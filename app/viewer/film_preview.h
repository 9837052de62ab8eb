#pragma once

#include <optional>
#include <string>

#include "scene/job.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// Shows frames of a film in the document, which is afterwards what it was before.
class FilmPreview {
  public:
    /// @param state  outlives this
    explicit FilmPreview(State& state) : state_(state) {}

    bool is_on() const { return before_.has_value(); }
    /// Keeps the document as it is now for end().
    void begin() { before_ = state_.document; }
    /// Makes the document the scene of a frame. Requires is_on().
    /// @param pose   of its view
    void show(const scene::Shot& frame, const Pose& pose);
    /// Restores the document.
    void end();
    /// The document is another scene's by now: nothing is left to restore.
    void forget() { before_.reset(); }

  private:
    State& state_;
    std::optional<Document> before_;
};

}  // namespace relevo::viewer

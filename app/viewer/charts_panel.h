#pragma once

#include <memory>

#include "gl/texture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// Panel of the chosen point's horizon and year, at the lower edge.
class ChartsPanel {
  public:
    /// Draws the charts, and stores the size they need in the state.
    /// @param size_px     of the window
    /// @param px_a_unit   scale of the charts, whose letters are about 12 units high
    void draw(State& state, glm::vec2 size_px, double px_a_unit);

  private:
    template <typename Chart>
    struct Shown {
        std::shared_ptr<const Chart> chart;
        gl::Texture texture;
        void take(std::shared_ptr<const Chart> newer);
    };

    /// Sets the panel's initial position: the last one, moved clear of the point.
    void place(const State& state, glm::vec2 size_px, float unit);
    /// At the lower edge, next to the side panel, with a height that the user can change.
    void dock(State& state, glm::vec2 size_px, float unit);
    void tabs(State& state);
    void horizon(State& state);
    void year(State& state);

    bool is_open_ = false;
    glm::vec2 at_px_{0}, extent_px_{0};  // last position and size; 0: not opened yet
    float docked_px_ = 0;                // last height when docked; 0: not docked yet
    Shown<HorizonPicture> horizon_;
    Shown<YearPicture> year_;
};

}  // namespace relevo::viewer

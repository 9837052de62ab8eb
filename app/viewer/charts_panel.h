#pragma once

#include <memory>

#include "gl/texture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// The chosen point's horizon and year, in a panel of their own, at the lower edge.
class ChartsPanel {
  public:
    /// Shows what there is, and says in the state how large it is to be.
    /// @param size_px     of the window
    /// @param px_a_unit   of the drawings, whose letters are about 12 units high
    void draw(State& state, glm::vec2 size_px, double px_a_unit);

  private:
    template <typename Chart>
    struct Shown {
        std::shared_ptr<const Chart> chart;
        gl::Texture texture;
        void take(std::shared_ptr<const Chart> newer);
    };

    /// Puts the panel where it opens: where it was, but beside the point.
    void place(const State& state, glm::vec2 size_px, float unit);
    void horizon(State& state);
    void year(State& state);

    bool is_open_ = false;
    glm::vec2 at_px_{0}, extent_px_{0};  // where it was last; 0: nowhere yet
    Shown<HorizonPicture> horizon_;
    Shown<YearPicture> year_;
};

}  // namespace relevo::viewer

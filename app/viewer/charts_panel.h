#pragma once

#include <memory>
#include <string>

#include "gl/texture.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// "08:13 to 16:01": the periods of direct sun, a line each, or "no direct sun".
std::string lit_label(const light::LightDay& day, const sun::Zone& zone);

/// Panel of the chosen point's horizon and year, at the lower edge, with a height that the user can
/// change.
class ChartsPanel {
  public:
    /// Draws the charts, and stores the size they need in the state.
    /// @param px_a_unit  scale of the charts, whose letters are about 12 units high
    void draw(State& state, double px_a_unit);

  private:
    template <typename Chart>
    struct Shown {
        std::shared_ptr<const Chart> chart;
        gl::Texture texture;
        void take(std::shared_ptr<const Chart> newer);
    };

    void tabs(State& state);
    void horizon(State& state);
    void year(State& state);

    Shown<HorizonPicture> horizon_;
    Shown<YearPicture> year_;
};

}  // namespace relevo::viewer

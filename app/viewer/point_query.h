#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "viewer/point_light.h"
#include "viewer/state.h"

namespace relevo::viewer {

/// Keeps State::point the sunlight of the displayed date at the point that the user chose.
class PointQuery {
  public:
    /// @param state  outlives this
    explicit PointQuery(State& state);

    /// Chooses a point of the ground. @returns false: the DEM has no height there
    bool choose(const glm::dvec3& point_m);
    /// Clears the point before another DEM is opened.
    void clear();
    /// Has the next update() request the sunlight again.
    void invalidate() { requested_.reset(); }
    /// Requests the sunlight if date, point or the size of its charts changed.
    /// @param px_a_unit  as side_panel()
    void update(const Opened& opened, double px_a_unit);
    /// Takes a new answer. @returns whether there was one
    bool poll();

  private:
    State& state_;
    PointWork work_;
    std::optional<PointWanted> requested_;  // for State::chosen
};

}  // namespace relevo::viewer

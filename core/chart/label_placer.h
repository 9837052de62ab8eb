#pragma once

#include <string>

#include "chart/drawing.h"
#include "chart/free_room.h"

namespace relevo::chart {

/// Puts words beside points where no other words are. Inside of the layer only.
class LabelPlacer {
  public:
    enum class Side { Above, Below };

    /// @param within  where labels may stand
    LabelPlacer(Drawing& drawing, const Rect& within) : drawing_(drawing), room_(within) {}

    /// No words over this spot.
    void keep_clear(const glm::dvec2& center, double radius);

    void keep_clear(const Rect& area) { room_.take(area); }

    /// Writes words as near as there is room, with a halo; leaves them out where there is none.
    /// @param gap     between the point and the words
    /// @param leader  a thin line from the point to words that are not right beside it
    /// @returns whether they were written
    bool add(const glm::dvec2& at, const std::string& words, Lettering lettering, double gap,
             Side side = Side::Above, bool leader = false);

  private:
    Drawing& drawing_;
    FreeRoom room_;
};

}  // namespace relevo::chart

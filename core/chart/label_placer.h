#pragma once

#include <string>
#include <vector>

#include "chart/drawing.h"

namespace relevo::chart {

/// Puts words beside points where no other words are. Inside of the layer only.
class LabelPlacer {
  public:
    enum class Side { Above, Below };

    /// @param within  where labels may stand
    LabelPlacer(Drawing& drawing, const Rect& within) : drawing_(drawing), within_(within) {}

    /// No words over this spot.
    void keep_clear(const glm::dvec2& center, double radius);

    void keep_clear(const Rect& area) { taken_.push_back(area); }

    /// Writes words as near as there is room, with a halo; leaves them out where there is none.
    /// @param gap     between the point and the words
    /// @param leader  a thin line from the point to words that are not right beside it
    /// @returns whether they were written
    bool add(const glm::dvec2& at, const std::string& words, Lettering lettering, double gap,
             Side side = Side::Above, bool leader = false);

  private:
    bool is_free(const Rect& box) const;

    Drawing& drawing_;
    Rect within_;
    std::vector<Rect> taken_;
};

}  // namespace relevo::chart

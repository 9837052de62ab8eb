#pragma once

#include <string>
#include <vector>

#include "chart/drawing.h"
#include "chart/ramp.h"

namespace relevo::chart {

/// What colours of a map mean.
struct Legend {
    std::string title;  ///< "Sun hours, 21 December 2026"
    std::string unit;   ///< "h"; empty or "1": none
    Ramp ramp;
    bool ring = false;   ///< of directions, 0 to 360 degrees clockwise from north
    bool clock = false;  ///< values are minutes since midnight, written as times of day
    struct Class {
        std::string name;  ///< "in the shade"
        Color color;

        bool operator==(const Class&) const = default;
    };
    std::vector<Class> classes{};  ///< instead of the ramp's values
    /// Edges of classes, one more than the ramp has stops; each class has the colour of its stop.
    /// The classes are drawn with equal heights and the values of their edges. Empty: a continuous
    /// ramp.
    std::vector<double> edges{};

    std::string layer{};  ///< that has these colours: id of an effect; empty: the overlay

    bool operator==(const Legend&) const = default;
};

/// A value of a legend as text, without its unit: "7.5", "07:30".
/// @param step  from one value to the next
std::string value_text(const Legend& legend, double value, double step);

/// A panel that stands alone on any picture: the title, the ramp and its values, of which round
/// ones are written.
Drawing legend(const Legend& legend);

/// Round values from one to another, at most so many: 0, 2, 4, ... 14.
std::vector<double> round_values(double from, double to, int most);

}  // namespace relevo::chart

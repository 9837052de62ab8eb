#include "chart/label_placer.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "chart/diagram_parts.h"

namespace relevo::chart {

void LabelPlacer::keep_clear(const glm::dvec2& center, double radius) {
    room_.take({center.x - radius, center.y - radius, 2 * radius, 2 * radius});
}

bool LabelPlacer::add(const glm::dvec2& at, const std::string& words, Lettering lettering,
                      double gap, Side side, bool leader) {
    // Words with a leader may be far up and need no other words' room.
    const int last_step = leader ? 9 : 4;
    constexpr double kAsides[] = {0, -0.6, 0.6, -0.3, 0.3};
    const double width = text_width(words, lettering.size, lettering.bold);
    const double ascent = 0.74 * lettering.size, height = 0.92 * lettering.size;
    const double up = side == Side::Above ? -1 : 1;
    for (int step = 0; step <= last_step; ++step)
        for (const double aside : std::span(kAsides).first(leader ? 5 : 3)) {
            const double middle = at.x + aside * width;
            const double base = side == Side::Above ? at.y - gap - step * (height + 2)
                                                    : at.y + gap + ascent + step * (height + 2);
            const Rect box{middle - width / 2 - 2, base - ascent - 1, width + 4, height + 2};
            if (!room_.is_free(box)) continue;
            const glm::dvec2 from(at.x, at.y + up * 2);
            const glm::dvec2 to(std::clamp(at.x, box.x + 4, box.x + box.width - 4),
                                side == Side::Above ? base + 3 : base - ascent - 2);
            const Rect way{std::min(from.x, to.x) - 1, std::min(from.y, to.y),
                           std::abs(to.x - from.x) + 2, std::abs(to.y - from.y)};
            const bool led = leader || step > 0;
            if (led && step > 0 && !room_.is_free(way)) continue;
            room_.take(box);
            if (led) {
                room_.take(way);
                drawing_.line(from, to, {.stroke = kSoft, .width = 0.7});
            }
            lettering.anchor = Anchor::Middle;
            if (!lettering.halo) lettering.halo = Color{kPaper.rgb, 0.85};
            drawing_.text({middle, base}, words, lettering);
            return true;
        }
    return false;
}

}  // namespace relevo::chart

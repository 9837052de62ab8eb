#include "session/non_finite.h"

#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::session {
namespace {

/// Result with an effect and its dependents off.
struct Trial {
    std::string id;
    int pixels = 0;
    std::size_t effects = 0;  ///< number of effects still on
};

int non_finite_of(const FaultyPicture& picture, const ActiveEffects& effects) {
    render::Renderer renderer(picture.context, effects.inputs(), picture.options);
    renderer.render_frame(picture.terrain, picture.ground, picture.frame);
    int count = 0;
    if (picture.options.radiance)
        renderer.read_radiance(&count);
    else
        renderer.read_output(&count);
    return count;
}

}  // namespace

std::string non_finite_text(int pixels, glm::ivec2 size_px) {
    return fmt::format("{} of {} pixels are NaN or infinite", pixels,
                       std::int64_t{size_px.x} * size_px.y);
}

void report_non_finite(const FaultyPicture& picture) {
    // The fewest such pixels remain without the effect at fault. On a tie, the trial with more
    // effects on wins: others are off only as dependents.
    Trial best{"", picture.pixels, 0};
    for (const effect::Effect* effect : picture.effects.loaded.selection.effects) {
        const auto rest = ActiveEffects::of(without(picture.asked, {effect->id()}, picture.effects),
                                            /*report=*/false);
        const Trial trial{effect->id(), non_finite_of(picture, *rest),
                          rest->loaded.selection.effects.size()};
        if (trial.pixels < best.pixels ||
            (trial.pixels == best.pixels && !best.id.empty() && trial.effects > best.effects))
            best = trial;
    }
    const std::string what =
        non_finite_text(picture.pixels, {picture.options.width_px, picture.options.height_px});
    if (best.id.empty())
        failed(fmt::format(
            "capture: {}, with each effect off in turn; try --only with fewer effects", what));
    failed(fmt::format(
        "capture: {}: {}, {} without this effect; fix it (division by 0, root or logarithm of a "
        "negative number, normalize of a zero vector) or use --disable {}",
        best.id, what, best.pixels == 0 ? "none" : std::to_string(best.pixels), best.id));
}

}  // namespace relevo::session

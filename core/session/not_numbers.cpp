#include "session/not_numbers.h"

#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::session {
namespace {

/// The same picture with an effect off, and with it all that requires it.
struct Trial {
    std::string id;
    int pixels = 0;
    std::size_t effects = 0;  ///< that stay on
};

int not_numbers_of(const FaultyPicture& picture, const ActiveEffects& effects) {
    render::Renderer renderer(picture.context, effects.inputs(), picture.options);
    renderer.render_frame(picture.terrain, picture.ground, picture.frame);
    int count = 0;
    if (picture.options.radiance)
        renderer.read_radiance(&count);
    else
        renderer.read_picture(&count);
    return count;
}

}  // namespace

std::string not_numbers_text(int pixels, glm::ivec2 size_px) {
    return fmt::format(
        "expected light that is a number in every pixel but got {} of {} pixels that have none or "
        "an infinite one",
        pixels, std::int64_t{size_px.x} * size_px.y);
}

void refuse_not_numbers(const FaultyPicture& picture) {
    // Without its maker there are fewest; of several such effects, what others build upon takes
    // more of them along than the maker itself.
    Trial best{"", picture.pixels, 0};
    for (const effect::Effect* effect : picture.effects.loaded.selection.effects) {
        const auto rest = ActiveEffects::of(without(picture.asked, {effect->id()}, picture.effects),
                                            /*aloud=*/false);
        const Trial trial{effect->id(), not_numbers_of(picture, *rest),
                          rest->loaded.selection.effects.size()};
        if (trial.pixels < best.pixels ||
            (trial.pixels == best.pixels && !best.id.empty() && trial.effects > best.effects))
            best = trial;
    }
    const std::string what =
        not_numbers_text(picture.pixels, {picture.options.width_px, picture.options.height_px});
    if (best.id.empty())
        failed(
            fmt::format("capture: {}, whichever effect is off; --only with fewer effects may draw "
                        "it",
                        what));
    failed(fmt::format(
        "capture: {}: {}, and {} without this effect; mend it (a division by 0, a root or "
        "logarithm "
        "of less than 0, normalize of nothing), or go on with --disable {}",
        best.id, what, best.pixels == 0 ? "none" : std::to_string(best.pixels), best.id));
}

}  // namespace relevo::session

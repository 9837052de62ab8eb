#include "session/unseen_effects.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "render/core_passes.h"

namespace relevo::session {
namespace {

/// Hooks of walls and the backdrop. Those of the sky are of any stage.
constexpr std::array<std::string_view, 2> kOfOutside = {"side", "backdrop"};

bool names(const effect::Switches& switches, const std::string& id) {
    return contains(switches.enable, id) || (switches.only && contains(*switches.only, id));
}

}  // namespace

bool is_seen(const effect::Effect& effect, bool outside) {
    const effect::Manifest& manifest = effect.manifest;
    if (!manifest.marks.empty() || !manifest.instances.empty() || !manifest.module.empty())
        return true;
    const auto is_elsewhere = [&](const shader::Hook& hook) {
        return outside ? hook.stage == shader::HookStage::Any : contains(kOfOutside, hook.name);
    };
    bool any = false;
    for (const shader::Snippet& snippet : effect.snippets)
        for (const shader::HookFunction& function : snippet.hooks) {
            any = true;
            if (!is_elsewhere(*function.hook) &&
                shader::changes_arguments(snippet, function, render::kOutsideWord, outside))
                return true;
        }
    return !any;
}

bool have_block(const std::vector<const effect::Effect*>& effects) {
    return std::ranges::any_of(effects, [](const effect::Effect* effect) {
        return std::ranges::any_of(kOfOutside, [&](auto hook) { return effect->answers(hook); });
    });
}

std::vector<std::string> unseen_effects(const ActiveEffects& effects, const scene::Effects& asked,
                                        bool outside) {
    const std::vector<const effect::Effect*>& on = effects.loaded.selection.effects;
    const bool has_block = have_block(on);
    std::vector<std::string> ids;
    for (const effect::Effect* effect : on) {
        const bool is_asked =
            names(asked.switches, effect->id()) ||
            std::ranges::any_of(effects.presets, [&](const effect::Preset& preset) {
                return !preset.file.empty() && names(preset.switches, effect->id());
            });
        if (is_asked && !is_seen(*effect, outside && has_block)) ids.push_back(effect->id());
    }
    return ids;
}

std::string unseen_text(const std::vector<std::string>& ids, bool outside) {
    if (ids.empty()) return {};
    return fmt::format("{}: not seen from {}", fmt::join(ids, ", "),
                       outside
                           ? "outside the DEM; --eye stands in it, --disable block draws its air"
                           : "within the DEM; --view is from outside");
}

}  // namespace relevo::session

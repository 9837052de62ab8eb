#include "golden/shipped.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/paths.h"
#include "render/renderer.h"

namespace relevo::test {
namespace {

/// Textures of several effects with the same texels are one.
std::map<std::string, std::string> same_textures(const effect::Selection& selection) {
    std::map<std::string, std::string> same;
    std::vector<const effect::TextureSpec*> known;
    for (const effect::Effect* effect : selection.effects) {
        for (const effect::TextureSpec& spec : effect->manifest.textures) {
            const auto first = std::ranges::find_if(
                known, [&](const auto* other) { return other->same_texels(spec); });
            if (first == known.end())
                known.push_back(&spec);
            else
                same.emplace(spec.resource, (*first)->resource);
        }
    }
    return same;
}

}  // namespace

shader::ParamStore Shipped::values() const {
    std::vector<shader::Param> params = registry.params();
    for (const shader::Param& param : render::core_params())
        params.push_back(param);
    shader::ParamStore store;
    store.declare(params, registry.texts());
    return store;
}

std::map<std::string, effect::Switches> Shipped::selections() const {
    std::map<std::string, effect::Switches> result{{"core", {.only = Ids{}}}};
    for (const effect::Effect& effect : registry.effects()) {
        result.emplace(effect.id() + " alone", effect::Switches{.only = Ids{effect.id()}});
        for (const Ids& ids : everything()) {
            result.emplace(fmt::format("{}", fmt::join(ids, ",")), effect::Switches{.only = ids});
            if (!contains(ids, effect.id())) continue;
            effect::Switches but{.only = ids, .disable = {effect.id()}};
            std::erase(*but.only, effect.id());
            result.emplace(fmt::format("all but {}", effect.id()), but);
        }
    }
    return result;
}

bool Shipped::too_many_textures(const Ids& ids, const std::string& id) {
    const Ids others{"drape", "ridges", "softlight",
                     "swiss", "tracks", "vsm"};  // beside the five textures of clouds
    return (id == "clouds" &&
            std::ranges::any_of(others, [&](const auto& other) { return contains(ids, other); })) ||
           (contains(others, id) && contains(ids, std::string("clouds")));
}

std::set<Ids> Shipped::everything() const {
    std::set<Ids> result;
    for (const effect::Effect& first : registry.effects()) {
        Ids ids{first.id()};
        std::vector<std::string> taken = first.manifest.exclusive;
        for (const effect::Effect& effect : registry.effects()) {
            const std::vector<std::string>& words = effect.manifest.exclusive;
            if (contains(ids, effect.id()) || too_many_textures(ids, effect.id()) ||
                std::ranges::any_of(words, [&](const auto& w) { return contains(taken, w); }))
                continue;
            ids.push_back(effect.id());
            taken.insert(taken.end(), words.begin(), words.end());
        }
        std::ranges::sort(ids);
        result.insert(ids);
    }
    return result;
}

render::StitchedFrames stitched(const effect::Selection& selection,
                                const shader::ParamStore& values,
                                const render::ProgramOptions& options, bool constants) {
    static const shader::FolderTexts core{share_dir() / "shaders"};
    shader::StitchInput input = selection.stitch_input();
    input.values = &values;
    input.constants = constants;
    input.max_texture_units = 32;
    input.same_textures = same_textures(selection);
    return render::stitch_frames(core, input, options);
}

}  // namespace relevo::test

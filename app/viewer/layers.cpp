#include "viewer/layers.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/contains.h"
#include "base/text.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

bool has_hook(const effect::Effect& effect, std::string_view hook) {
    return std::ranges::any_of(effect.snippets, [&](const shader::Snippet& snippet) {
        return snippet.find(hook) != nullptr;
    });
}

bool lies_on_ground(const effect::Effect& effect) {
    const effect::Manifest& manifest = effect.manifest;
    if (!manifest.default_where.empty()) return false;  // a feature of the DEM, such as its voids
    return !manifest.rasters.empty() || !manifest.lines.empty() || !manifest.marks.empty() ||
           has_hook(effect, "display");
}

/// The first parameter for which `is` holds; empty: none.
template <typename Is>
std::string address_of(const effect::Effect& effect, const Is& is) {
    for (const shader::Param& param : effect.params())
        if (!param.is_host && is(param)) return param.address;
    return {};
}

bool is_light(const shader::Param& param) {
    if (param.words.empty())
        return param.type == shader::ParamType::Bool && param.address.ends_with(".lit");
    return param.words.size() == 2 && contains(param.words, std::string("lit")) &&
           contains(param.words, std::string("flat"));
}

/// The text that names the file of what an effect draws.
std::string file_of(const effect::Manifest& manifest) {
    if (!manifest.rasters.empty()) return manifest.rasters.front().file;
    if (!manifest.lines.empty()) return manifest.lines.front().file;
    for (const effect::MarksSpec& marks : manifest.marks)
        if (!marks.from.empty()) return marks.from;
    return {};
}

std::string end_of_path(const std::string& path) {
    return printable(std::filesystem::path(path).filename().string());
}

Layer layer_of(const EffectsModel& effects, const effect::Effect& effect) {
    Layer layer;
    layer.id = effect.id();
    layer.name = effect.manifest.name;
    layer.is_on = effects.selection.has(effect.id());
    layer.opacity = address_of(effect, [](const shader::Param& param) {
        return param.type == shader::ParamType::Float && param.address.ends_with(".opacity");
    });
    layer.light = address_of(effect, is_light);
    layer.file = file_of(effect.manifest);
    if (!layer.file.empty()) layer.source = end_of_path(effects.values.text(layer.file));
    if (!has_hook(effect, "display") && !has_hook(effect, "material"))
        layer.group = Layer::Group::Marks;
    else if (!has_hook(effect, "display") || (!layer.light.empty() && is_lit(effects, layer.light)))
        layer.group = Layer::Group::Lit;
    return layer;
}

Layer overlay_layer(const Document& document) {
    const OverlayChoice& choice = document.overlay;
    Layer layer{.group = choice.lit ? Layer::Group::Lit : Layer::Group::Flat};
    layer.id = effect::kOverlay;
    layer.name = tr("Overlay");
    if (choice.kind == OverlayKind::File && document.scene.overlay)
        layer.source = end_of_path(document.scene.overlay->file);
    layer.is_on = choice.visible;
    return layer;
}

/// Puts the overlay among effects, as the shaders do.
/// @param layers  from bottom to top
void add_overlay(Layer overlay, const effect::Selection& selection, std::vector<Layer>& layers) {
    const auto is_over = [&](const Layer& layer) {
        if (layer.group != overlay.group) return layer.group > overlay.group;
        const bool is_flat = overlay.group == Layer::Group::Flat;
        if (!is_flat && selection.lit_overlay_is_over_all) return false;
        if (!selection.over_overlay) return is_flat;
        return contains(*selection.over_overlay, layer.id);
    };
    layers.insert(std::ranges::find_if(layers, is_over), std::move(overlay));
}

/// Whether the list shows an effect that is off.
bool is_remembered(const Layer& layer, const scene::Effects& effects) {
    return !layer.source.empty() || contains(effects.switches.disable, layer.id);
}

}  // namespace

std::vector<Layer> layers_of(const EffectsModel& effects, const Document& document) {
    std::vector<Layer> on, off;
    for (const effect::Effect* effect : effects.selection.effects)
        if (lies_on_ground(*effect)) on.push_back(layer_of(effects, *effect));
    std::ranges::stable_sort(on, {}, &Layer::group);
    for (const effect::Effect& effect : effects.registry.effects()) {
        if (!lies_on_ground(effect) || effects.selection.has(effect.id())) continue;
        Layer layer = layer_of(effects, effect);
        if (is_remembered(layer, document.scene.effects)) off.push_back(std::move(layer));
    }
    if (document.overlay.kind != OverlayKind::None) {
        Layer overlay = overlay_layer(document);
        if (overlay.is_on)
            add_overlay(std::move(overlay), effects.selection, on);
        else
            off.push_back(std::move(overlay));
    }
    std::ranges::reverse(on);
    on.insert(on.end(), off.begin(), off.end());
    return on;
}

std::vector<std::pair<FileKind, std::string>> files_of_layers(const EffectsModel& effects,
                                                              const Document& document) {
    std::vector<std::pair<FileKind, std::string>> files;
    for (const Layer& layer : layers_of(effects, document)) {
        if (layer.is_overlay() || layer.source.empty()) continue;
        const effect::Manifest& manifest = effects.registry.effect(layer.id, "layers").manifest;
        files.emplace_back(!manifest.rasters.empty() ? FileKind::Overlay
                           : !manifest.lines.empty() ? FileKind::Lines
                                                     : FileKind::Places,
                           effects.values.text(layer.file));
    }
    return files;
}

std::vector<std::string> further_layers(const EffectsModel& effects,
                                        const std::vector<Layer>& layers) {
    std::vector<std::string> ids;
    for (const effect::Effect& effect : effects.registry.effects())
        if (lies_on_ground(effect) &&
            std::ranges::find(layers, effect.id(), &Layer::id) == layers.end())
            ids.push_back(effect.id());
    return ids;
}

bool can_move(const std::vector<Layer>& layers, std::size_t layer, int by) {
    const std::size_t other = layer + static_cast<std::size_t>(by);  // of the first, -1 is none
    return other < layers.size() && layers[layer].group != Layer::Group::Marks &&
           layers[layer].group == layers[other].group && layers[layer].is_on && layers[other].is_on;
}

effect::Switches moved(effect::Switches switches, std::vector<Layer> layers, std::size_t layer,
                       int by) {
    std::swap(layers[layer], layers[layer + static_cast<std::size_t>(by)]);
    std::vector<std::string> now;  // from bottom to top
    for (auto each = layers.rbegin(); each != layers.rend(); ++each)
        if (each->is_on && each->group != Layer::Group::Marks) now.push_back(each->id);
    // Takes the places that they have in the order already; what else is in it keeps its own.
    std::size_t taken = 0;
    for (std::string& id : switches.order)
        if (contains(now, id)) id = now[taken++];
    switches.order.insert(switches.order.end(), now.begin() + static_cast<std::ptrdiff_t>(taken),
                          now.end());
    return switches;
}

scene::Effects without_layer(scene::Effects effects, const std::string& id, bool is_default) {
    effects = without_values(switched(std::move(effects), id, false), id);
    // A preset may switch it on.
    if (!is_default && effects.presets.empty()) std::erase(effects.switches.disable, id);
    std::erase(effects.switches.order, id);
    return effects;
}

std::string light_value(const EffectsModel& effects, const std::string& light, bool lit) {
    if (effects.values.param(light).words.empty()) return lit ? "true" : "false";
    return lit ? "lit" : "flat";
}

bool is_lit(const EffectsModel& effects, const std::string& light) {
    const shader::Param& param = effects.values.param(light);
    const double value = effects.values.value(light)[0];
    return param.words.empty() ? value != 0 : param.words[static_cast<std::size_t>(value)] == "lit";
}

}  // namespace relevo::viewer

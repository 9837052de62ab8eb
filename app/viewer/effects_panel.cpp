#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "base/contains.h"
#include "base/srgb.h"
#include "base/text.h"
#include "shader/params.h"
#include "viewer/state.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

using shader::Param;
using shader::ParamRole;
using shader::ParamType;
using shader::ParamValue;

bool mentions(const std::string& text, const std::string& word) {
    return lower(text).find(lower(word)) != std::string::npos;
}

/// Logarithmic if the range spans several powers of ten.
bool is_wide(const shader::ParamRange& range) {
    return range.min >= 0 && range.max >= 100;
}

/// A colour in linear light is edited as sRGB, so that the swatch has the colour that is drawn.
bool colour_widget(const Param& param, std::array<float, 4>& v) {
    constexpr ImGuiColorEditFlags kFlags =
        ImGuiColorEditFlags_Uint8 | ImGuiColorEditFlags_DisplayHex;
    const bool is_linear = param.role == ParamRole::Colour;
    std::array<float, 4> shown = v;
    for (std::size_t i = 0; i < 3 && is_linear; ++i)
        shown[i] = static_cast<float>(srgb_of_linear(v[i]));
    const bool changed = shader::component_count(param.type) == 3
                             ? ImGui::ColorEdit3("##value", shown.data(), kFlags)
                             : ImGui::ColorEdit4("##value", shown.data(), kFlags);
    if (!changed) return false;
    for (std::size_t i = 0; i < 3 && is_linear; ++i)
        shown[i] = static_cast<float>(linear_of_srgb(shown[i]));
    v = shown;
    return true;
}

/// The wheel's motion over the slider before this, if the hand moved there: a panel that scrolls
/// below a cursor changes no value.
float wheel_over_slider() {
    const ImGuiID moved_to = ImHashStr("wheel"), here = ImGui::GetItemID();
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const auto last = static_cast<ImGuiID>(storage.GetInt(moved_to));
    if (!ImGui::IsItemHovered()) {
        if (last == here) storage.SetInt(moved_to, 0);
        return 0;
    }
    const ImGuiIO& io = ImGui::GetIO();
    if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)
        storage.SetInt(moved_to, static_cast<int>(here));
    else if (last != here)
        return 0;
    ImGui::SetItemUsingMouseWheel();
    return io.MouseWheel;
}

/// A hundredth of the range a notch, or of a wide one a twentieth of the value; whole numbers by
/// one at least.
void scroll(const Param& param, ParamValue& value, double notches) {
    const shader::ParamRange& range = *param.range;
    const double width = range.max - range.min;
    double by = is_wide(range) ? std::max(value[0], width / 1e4) / 20 : width / 100;
    if (param.type == ParamType::Int) by = std::max(1.0, std::round(by));
    value[0] = std::clamp(value[0] + notches * by, range.min, range.max);
}

/// @returns true if the value was changed
bool widget(const Param& param, ParamValue& value) {
    const std::string unit = param.unit.empty() ? "" : " " + param.unit;
    const int components = shader::component_count(param.type);
    // No exponent for numbers that are short without one.
    const double size = std::abs(value[0]);
    const bool is_long = components == 1 && size >= 1000 && size < 1e7;
    const std::string format = (is_long ? "%.0f" : "%.3g") + unit;
    std::array<float, 4> v{};
    std::transform(value.begin(), value.end(), v.begin(),
                   [](double x) { return static_cast<float>(x); });
    bool changed = false;
    if (param.type == ParamType::Bool) {
        bool on = value[0] != 0;
        changed = ImGui::Checkbox("##value", &on);
        v[0] = on ? 1.0f : 0.0f;
    } else if (!param.words.empty()) {
        int word = static_cast<int>(value[0]);
        const auto name = [](void* words, int i, const char** text) {
            *text =
                (*static_cast<const std::vector<std::string>*>(words))[static_cast<std::size_t>(i)]
                    .c_str();
            return true;
        };
        changed = ImGui::Combo("##value", &word, name,
                               const_cast<std::vector<std::string>*>(&param.words),
                               static_cast<int>(param.words.size()));
        v[0] = static_cast<float>(word);
    } else if (param.type == ParamType::Int) {
        int number = static_cast<int>(value[0]);
        changed = param.range
                      ? ImGui::SliderInt("##value", &number, static_cast<int>(param.range->min),
                                         static_cast<int>(param.range->max), ("%d" + unit).c_str())
                      : ImGui::InputInt("##value", &number);
        v[0] = static_cast<float>(number);
    } else if (param.role == ParamRole::Colour || param.role == ParamRole::ColourSrgb) {
        changed = colour_widget(param, v);
    } else if (param.range) {
        const auto least = static_cast<float>(param.range->min);
        const auto most = static_cast<float>(param.range->max);
        const ImGuiSliderFlags flags =
            ImGuiSliderFlags_AlwaysClamp |
            (is_wide(*param.range) ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
        changed = ImGui::SliderScalarN("##value", ImGuiDataType_Float, v.data(), components, &least,
                                       &most, format.c_str(), flags);
    } else {
        changed = ImGui::DragScalarN("##value", ImGuiDataType_Float, v.data(), components, 0.01f,
                                     nullptr, nullptr, format.c_str());
    }
    if (changed)
        for (int i = 0; i < components; ++i)
            value[static_cast<std::size_t>(i)] = v[static_cast<std::size_t>(i)];
    return changed;
}

/// The name of a row, left of its widget, or above if it is long.
void row_label(const std::string& label) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label.c_str());
    const float left = ImGui::GetContentRegionMax().x * 0.42f;
    const float right = ImGui::GetCursorPosX() + ImGui::CalcTextSize(label.c_str()).x;
    if (right + ImGui::GetStyle().ItemSpacing.x <= left)
        ImGui::SameLine(left);
    else
        ImGui::SetCursorPosX(left);
    ImGui::SetNextItemWidth(-2.2f * ImGui::GetFontSize());
}

/// A button that resets a row. @param is_default  there is nothing to reset
bool reset_button(bool is_default) {
    ImGui::SameLine();
    ImGui::BeginDisabled(is_default);
    const bool pressed = ImGui::SmallButton("x");
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("Reset to the default"));
    return pressed;
}

void param_row(State& state, const Param& param) {
    ImGui::PushID(param.address.c_str());
    ParamValue value = state.effects->values.value(param.address);
    row_label(param.label.empty() ? param.address : param.label);
    const bool resets = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s\n%s%s%s", param.address.c_str(), param.description.c_str(),
                          param.is_static ? "\n" : "",
                          param.is_static ? tr("Each value compiles another shader.") : "");
    if (widget(param, value) && shader::is_valid(param, value))
        state.set_value(param, shader::format_value(param, value));
    const bool is_slider = param.range && param.words.empty() && param.type != ParamType::Bool &&
                           shader::component_count(param.type) == 1 && !param.is_static;
    const float notches = is_slider ? wheel_over_slider() : 0;
    if (notches != 0) {
        scroll(param, value, notches);
        state.set_value(param, shader::format_value(param, value));
    }
    state.step = state.step || notches != 0 || ImGui::IsItemDeactivatedAfterEdit();
    const bool is_default = !has_values(state.document.scene.effects, param.address);
    if (reset_button(is_default) || (resets && !is_default))
        state.set_effects(without_values(state.document.scene.effects, param.address));
    ImGui::PopID();
}

/// A text or a file, which is taken when Enter is pressed.
void text_row(State& state, const shader::TextParam& text) {
    ImGui::PushID(text.address.c_str());
    row_label(text.label);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s\n%s", text.address.c_str(), text.description.c_str());
    std::string value = state.effects->values.text(text.address);
    if (ImGui::InputTextWithHint(
            "##value", text.is_file ? tr("path, then Enter") : tr("then Enter"), &value,
            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll)) {
        if (text.is_file && !value.empty()) value = std::filesystem::absolute(value).string();
        state.set_effects(with_value(state.document.scene.effects, text.address, value));
    }
    if (reset_button(!has_values(state.document.scene.effects, text.address)))
        state.set_effects(without_values(state.document.scene.effects, text.address));
    ImGui::PopID();
}

/// Why an effect is off without being switched off; empty if it does not lack anything.
std::string lack_of(const State& state, const effect::Effect& effect) {
    const std::string off = effect.id() + " is off: ";
    for (const std::string& notice : state.effects->selection.notices)
        if (notice.starts_with(off)) return fmt::format("({})", notice.substr(off.size()));
    const effect::Switches& asked = state.document.scene.effects.switches;
    const bool is_off = contains(asked.disable, effect.id());
    if (!effect.manifest.enabled_by_default || !state.ground_words || asked.only || is_off)
        return {};
    for (const std::string& word : effect.manifest.default_where)
        if (!contains(*state.ground_words, word)) {
            std::string words = word;
            std::ranges::replace(words, '_', ' ');
            return tr_format("(the DEM has no {})", words);
        }
    return {};
}

/// Rows of an effect's values: those that matter first, or the others.
/// @param draws  else they are only counted
int value_rows(State& state, const effect::Effect& effect, bool first, bool draws) {
    constexpr int kFirst = 3;  // of an effect that does not say which
    const std::vector<std::string>& named = effect.manifest.first;
    int all = 0, rows = 0;
    const auto is_wanted = [&](const std::string& address) {
        const bool leads = named.empty() ? all < kFirst : contains(named, address);
        ++all;
        if (leads != first) return false;
        ++rows;
        return draws;
    };
    for (const shader::TextParam& text : effect.manifest.texts)
        if (is_wanted(text.address)) text_row(state, text);
    for (const Param& param : effect.params())
        if (!param.is_host && is_wanted(param.address)) param_row(state, param);
    return rows;
}

}  // namespace

void effect_values(State& state, const effect::Effect& effect) {
    value_rows(state, effect, /*first=*/true, /*draws=*/true);
    if (value_rows(state, effect, /*first=*/false, /*draws=*/false) > 0) {
        if (!state.search.empty()) ImGui::SetNextItemOpen(true);
        if (ImGui::TreeNode(tr_label("More"))) {
            value_rows(state, effect, /*first=*/false, /*draws=*/true);
            ImGui::TreePop();
        }
    }
    ImGui::BeginDisabled(!has_values(state.document.scene.effects, effect.id()));
    if (!effect.params().empty() && ImGui::SmallButton(tr_label("Reset all values")))
        state.set_effects(without_values(state.document.scene.effects, effect.id()));
    ImGui::EndDisabled();
}

namespace {

/// Of an effect that draws nothing in this view: one in which it does.
void offer_view(State& state, const effect::Effect& effect) {
    const EffectsModel& model = *state.effects;
    if (!contains(state.is_outside ? model.unseen_outside : model.unseen_within, effect.id()))
        return;
    ImGui::SameLine();
    if (ImGui::SmallButton(tr_label("Show"))) {
        state.document.scene.backdrop =
            state.is_outside ? scene::Backdrop::Horizon : scene::Backdrop::Studio;
        if (!state.is_outside) state.commands.push_back(Command::Whole);
        state.step = true;
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", state.is_outside
                                    ? tr("Not seen from outside: with sky and horizon")
                                    : tr("Seen from outside alone: the DEM as a block"));
}

void effect_row(State& state, const effect::Effect& effect) {
    const bool is_on = state.effects->selection.has(effect.id());
    ImGui::PushID(effect.id().c_str());
    bool on = is_on;
    const bool changed = ImGui::Checkbox("##on", &on);
    ImGui::SameLine();
    const bool open = ImGui::TreeNodeEx(effect.manifest.name.c_str(), ImGuiTreeNodeFlags_None);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s: %s", effect.id().c_str(), effect.manifest.description.c_str());
    if (const std::string why = is_on ? "" : lack_of(state, effect); !why.empty()) {
        ImGui::SameLine();
        const bool has_room =
            ImGui::CalcTextSize(why.c_str()).x <= ImGui::GetContentRegionAvail().x;
        ImGui::TextDisabled("%s", has_room ? why.c_str() : "(?)");
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", why.c_str());
    }
    if (is_on) offer_view(state, effect);
    if (open) {
        effect_values(state, effect);
        ImGui::TreePop();
    }
    ImGui::PopID();
    if (changed) state.set_effects(switched(state.document.scene.effects, effect.id(), on));
}

bool is_found(const effect::Effect& effect, const std::string& word) {
    if (word.empty() ||
        mentions(effect.id() + " " + effect.manifest.name + " " + effect.manifest.description,
                 word))
        return true;
    const std::vector<Param> params = effect.params();
    return std::ranges::any_of(params, [&](const Param& param) {
        return mentions(param.address + " " + param.label, word);
    });
}

/// A group with its effects, by their names; nothing where the search finds none.
/// @param word  effect::Manifest::group
void effect_group(State& state, std::string_view word, const char* title) {
    std::vector<const effect::Effect*> found;
    for (const effect::Effect& effect : state.effects->registry.effects())
        if (effect.manifest.group == word && is_found(effect, state.search))
            found.push_back(&effect);
    if (found.empty()) return;
    std::ranges::sort(found, {}, [](const effect::Effect* one) { return one->manifest.name; });
    ImGui::Spacing();
    {
        const style::Sized small(style::Size::Small);
        ImGui::TextDisabled("%s", title);
    }
    for (const effect::Effect* const effect : found)
        effect_row(state, *effect);
}

void preset_choice(State& state) {
    const std::vector<std::string>& chosen = state.document.scene.effects.presets;
    const std::string shown = chosen.empty() ? tr("no preset") : chosen.back();
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##preset", shown.c_str())) return;
    scene::Effects effects = state.document.scene.effects;
    effects.presets.clear();
    if (ImGui::Selectable(tr_label("no preset"), chosen.empty())) state.set_effects(effects);
    for (const std::string& name : effect::preset_names()) {
        if (!ImGui::Selectable(name.c_str(), shown == name)) continue;
        effects.presets = {name};
        state.set_effects(effects);
    }
    ImGui::EndCombo();
}

}  // namespace

void effects_panel(State& state) {
    preset_choice(state);
    ImGui::Checkbox(tr_label("Compare with the current settings"), &state.compare_is_wanted);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", tr("The left side stays, the right side follows. Drag the line."));
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", tr("search effects and parameters"), &state.search,
                             ImGuiInputTextFlags_AutoSelectAll);
    effect_group(state, "ground", tr("Ground"));
    effect_group(state, "light", tr("Light"));
    effect_group(state, "air", tr("Air and sky"));
    effect_group(state, "water", tr("Water and snow"));
    effect_group(state, "maps", tr("Maps and marks"));
    effect_group(state, "", tr("Yours"));
    ImGui::PushTextWrapPos();
    for (const effect::BrokenEffect& broken : state.effects->registry.broken())
        ImGui::TextColored({1, 0.5f, 0.4f, 1}, "%s", broken.error.c_str());
    for (const std::string& notice : state.effects->selection.notices)
        ImGui::TextDisabled("%s", notice.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace relevo::viewer

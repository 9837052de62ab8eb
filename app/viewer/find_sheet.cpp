#include "viewer/find_sheet.h"

#include <algorithm>
#include <utility>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/error.h"
#include "base/text.h"
#include "dem/places.h"
#include "geo/format.h"
#include "viewer/sheet.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr std::size_t kMostNames = 30;

}  // namespace

std::vector<FoundPlace> find_names(const std::string& text, const EffectsModel& effects,
                                   std::size_t most) {
    const std::string wanted = lower(trimmed(text));
    std::vector<FoundPlace> found;
    if (wanted.empty()) return found;
    for (const effect::Effect* const effect : effects.selection.effects) {
        for (const effect::MarksSpec& marks : effect->manifest.marks) {
            if (marks.from.empty()) continue;  // a module sets them
            const std::string file = effects.values.text(marks.from);
            if (file.empty()) continue;
            try {
                for (const dem::NamedPlace& place : dem::read_points(file, marks.from))
                    if (lower(place.name).find(wanted) != std::string::npos)
                        found.push_back({place.name, place.at.place});
            } catch (const Error&) {
                // The effect itself says what is wrong with its file.
            }
        }
    }
    std::ranges::stable_partition(
        found, [&](const FoundPlace& place) { return lower(place.name).starts_with(wanted); });
    if (found.size() > most) found.resize(most);
    return found;
}

void FindSheet::choose(const geo::Geodetic& place) {
    chosen_ = place;
    is_open_ = false;
}

void FindSheet::draw(glm::vec2 size_px, const EffectsModel* effects) {
    if (!is_open_) return;
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({size_px.x / 2, 4 * line}, ImGuiCond_Appearing, {0.5f, 0});
    ImGui::SetNextWindowSize({std::min(size_px.x - 20, 20 * line), 0}, ImGuiCond_Always);
    if (ImGui::Begin(tr_label("Go to a place"), &is_open_, ImGuiWindowFlags_NoCollapse)) {
        if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-1);
        const bool enter = ImGui::InputTextWithHint(
            "##place", tr("coordinates, or a name that is shown"), &text_,
            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
        if (searched_ != text_) {
            searched_ = text_;
            found_.clear();
            if (const auto place = geo::find_coordinates(text_))
                found_.push_back({geo::degrees_text(*place), *place});
            else if (effects)
                found_ = find_names(text_, *effects, kMostNames);
        }
        for (const FoundPlace& place : found_)
            if (ImGui::Selectable(printable(place.name).c_str())) choose(place.place);
        if (found_.empty())
            ImGui::TextDisabled("%s", text_.empty() ? tr("47.4395, 11.8935; 32N 683473 5255234; "
                                                         "32TPT8347355234")
                                                    : tr("nothing found"));
        if (enter && !found_.empty()) choose(found_.front().place);
        if (closes_sheet()) close();
    }
    ImGui::End();
}

}  // namespace relevo::viewer

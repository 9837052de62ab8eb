#include "viewer/export_sheet.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/text.h"
#include "scene/scene_words.h"
#include "viewer/export.h"
#include "viewer/sheet.h"
#include "viewer/style.h"

namespace relevo::viewer {
namespace {

/// Stamps of one scale and direction, which panoramas and stereo pairs lack.
bool needs_lens(bool scene::Stamps::*stamp) {
    return stamp == &scene::Stamps::scale || stamp == &scene::Stamps::north ||
           stamp == &scene::Stamps::graticule;
}

void size_fields(ExportChoice& choice) {
    if (ImGui::InputInt2(tr_label("Pixels"), &choice.size_px.x))
        choice.size_px = glm::clamp(choice.size_px, glm::ivec2(1), glm::ivec2(scene::kMaxSide_px));
    if (choice.of().is_ortho)
        ImGui::TextDisabled("%s", tr("at most: a map has the shape of the DEM"));
    else
        ImGui::Checkbox(tr_label("Centred on what the panels leave free"), &choice.is_centred);
}

void format_fields(ExportChoice& choice) {
    const auto name_of = [](void*, int i, const char** name) {
        *name = tr(kExportFormats[static_cast<std::size_t>(i)].name);
        return true;
    };
    ImGui::Combo(tr_label("Format"), &choice.format, name_of, nullptr,
                 static_cast<int>(kExportFormats.size()));
    if (choice.file_format().has_quality)
        ImGui::SliderInt(tr_label("Quality"), &choice.quality, 1, 100);
    if (ImGui::BeginCombo(tr_label("Samples"), tr_format("{} a pixel", choice.samples).c_str())) {
        for (const int samples : kExportSamples)
            if (ImGui::Selectable(tr_format("{} a pixel", samples).c_str()))
                choice.samples = samples;
        ImGui::EndCombo();
    }
    ImGui::BeginDisabled(!choice.can_be_transparent());
    ImGui::Checkbox(tr_label("Transparent where there is no ground"), &choice.is_transparent);
    ImGui::EndDisabled();
}

void paper_fields(ExportChoice& choice) {
    ImGui::Combo(tr_label("Paper"), &choice.paper, kExportPapers.data(),
                 static_cast<int>(kExportPapers.size()));
    double scale = choice.map_scale;
    if (ImGui::InputDouble(tr_label("Scale 1 :"), &scale, 0, 0, "%.0f"))
        choice.set_map_scale(scale);
    if (choice.map_scale == 0) ImGui::TextDisabled("%s", tr("0: all of the DEM fits"));
}

/// Part of the displayed image as an exported picture has it. @returns whether all of it is known
bool draw_view(const ExportView& view, ImVec2 at, ImVec2 size) {
    constexpr int kColumns = 48, kRows = 32;
    const auto texture = reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(view.texture));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    bool is_whole = true;
    for (int i = 0; i < kColumns * kRows; ++i) {
        std::array<ImVec2, 4> place, shown;
        bool is_shown = true;
        for (int corner = 0; corner < 4; ++corner) {
            const float x = static_cast<float>(i % kColumns + (corner == 1 || corner == 2)) /
                            kColumns,
                        y = static_cast<float>(i / kColumns + corner / 2) / kRows;
            const auto k = static_cast<std::size_t>(corner);
            place[k] = {at.x + x * size.x, at.y + y * size.y};
            const auto from = view.shown_at({2 * x - 1, 1 - 2 * y});
            is_shown =
                is_shown && from && from->x >= 0 && from->x <= 1 && from->y >= 0 && from->y <= 1;
            if (from) shown[k] = {from->x, from->y};
        }
        if (is_shown)
            list.AddImageQuad(texture, place[0], place[1], place[2], place[3], shown[0], shown[1],
                              shown[2], shown[3]);
        is_whole = is_whole && is_shown;
    }
    return is_whole;
}

}  // namespace

void ExportSheet::use_field(ExportChoice& choice, glm::vec2 window_px) {
    const auto now =
        std::ranges::find_if(kExportUses, [&](const ExportUse& use) { return use.is_of(choice); });
    if (!ImGui::BeginCombo(tr_label("For"),
                           now == kExportUses.end() ? tr("as chosen below") : tr(now->name)))
        return;
    for (const ExportUse& use : kExportUses)
        if (ImGui::Selectable(tr_label(use.name)))
            use.apply_to(choice, stamps_, glm::ivec2(window_px));
    ImGui::EndCombo();
}

void ExportSheet::kind_field(ExportChoice& choice) {
    if (!ImGui::BeginCombo(tr_label("What"), tr(choice.of().name))) return;
    for (std::size_t i = 0; i < kExportKinds.size(); ++i)
        if (ImGui::Selectable(tr_label(kExportKinds[i].name), &kExportKinds[i] == &choice.of()))
            set_kind(choice, static_cast<int>(i));
    ImGui::Separator();
    if (ImGui::Selectable(tr_label("film ..."))) command_ = Command::Film;
    ImGui::EndCombo();
}

void ExportSheet::set_kind(ExportChoice& choice, int index) {
    choice.set_kind(index);
    if (!choice.of().is_sheet) return;
    for (const auto& [word, member] : scene::stamp_words())
        stamps_.*member =
            member != &scene::Stamps::attribution || !stamps_.attribution_text.empty();
}

void ExportSheet::stamp_fields(const ExportKind& kind) {
    ImGui::TextUnformatted(tr("On the picture:"));
    int column = 0;
    for (const auto& [word, member] : scene::stamp_words()) {
        if (column++ % 3 != 0) ImGui::SameLine(7.5f * ImGui::GetFontSize() * ((column - 1) % 3));
        ImGui::BeginDisabled(!kind.has_lens() && needs_lens(member));
        ImGui::Checkbox(std::string(word).c_str(), &(stamps_.*member));
        ImGui::EndDisabled();
    }
    ImGui::BeginDisabled(!kind.has_lens() || kind.is_sheet);
    ImGui::Checkbox(tr_label("Around the picture, so that nothing lies on it"), &stamps_.margin);
    ImGui::EndDisabled();
    if (stamps_.title)
        ImGui::InputText(tr_label("Title"), &stamps_.title_text, ImGuiInputTextFlags_AutoSelectAll);
    if (stamps_.attribution)
        ImGui::InputTextWithHint(tr_label("Source"), tr("of the data"), &stamps_.attribution_text,
                                 ImGuiInputTextFlags_AutoSelectAll);
}

void ExportSheet::fields(ExportChoice& choice, const ExportView& view, glm::vec2 window_px) {
    ImGui::PushItemWidth(
        -widest({tr("For"), tr("What"), tr("Pixels"), tr("Format"), tr("Quality"), tr("Samples"),
                 tr("Title"), tr("Source"), tr("Paper"), tr("Scale 1 :")}));
    use_field(choice, window_px);
    kind_field(choice);
    if (choice.of().is_picture()) {
        if (choice.of().is_sheet) {
            paper_fields(choice);
        } else {
            size_fields(choice);
            format_fields(choice);
        }
        stamp_fields(choice.of());
    } else if (choice.kind == kFigures) {
        if (!view.has_figures)
            ImGui::TextWrapped(
                "%s", tr("there is no sun overlay to export; O shows the day's sun hours"));
    } else {
        if (ImGui::InputDouble(tr_label("Error"), &choice.error_m, 0, 0, "%g m"))
            choice.error_m = std::clamp(choice.error_m, kLeastError_m, kMostError_m);
        ImGui::TextWrapped("%s", tr("No post is farther than this above or below the triangles"));
    }
    ImGui::PopItemWidth();
}

void ExportSheet::preview(const ExportChoice& choice, const ExportView& view) const {
    const ExportKind& kind = choice.of();
    if (!kind.is_picture()) return;
    const float aspect =
        kind.is_ortho ? static_cast<float>(view.map_aspect)
                      : static_cast<float>(choice.size_px.x) / static_cast<float>(choice.size_px.y);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float text = ImGui::GetTextLineHeightWithSpacing();
    const float width = std::min(room.x, std::max(text, room.y - 3 * text) * aspect);
    const ImVec2 at = ImGui::GetCursorScreenPos(), size{width, width / aspect};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const int eyes = kind.stereo == Stereo::Parallel ? 2 : 1;
    const float eye = size.x / static_cast<float>(eyes);
    bool is_whole = true;
    if (!kind.is_ortho && !kind.is_panorama() && view.texture != 0)
        for (int i = 0; i < eyes; ++i)
            is_whole = draw_view(view, {at.x + static_cast<float>(i) * eye, at.y}, {eye, size.y});
    list.AddRect(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_Border));
    ImGui::Dummy(size);
    if (kind.is_sheet) return;
    const style::Sized small(style::Size::Small);
    constexpr double kCm_a_px = 2.54 / 300;
    ImGui::TextDisabled("%s", tr_format("at 300 dpi {:.1f} x {:.1f} cm",
                                        choice.size_px.x * kCm_a_px, choice.size_px.y * kCm_a_px)
                                  .c_str());
    if (!is_whole) ImGui::TextDisabled("%s", tr("grey: not in the window's picture"));
}

void ExportSheet::file_fields(ExportChoice& choice) {
    ImGui::PushItemWidth(-widest({tr("Folder"), tr("Name")}));
    ImGui::InputTextWithHint(tr_label("Folder"), folder_of("x").c_str(), &choice.folder,
                             ImGuiInputTextFlags_AutoSelectAll);
    if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::InputText(tr_label("Name"), &choice.name, ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
        ImGui::SetTooltip("%s", tr("{dem}, and {time:...} with the conversions of strftime"));
    ImGui::PopItemWidth();
}

void ExportSheet::question(const ExportOrder& wanted) {
    const std::filesystem::path path = wanted.path;
    ExportOrder other = wanted;
    other.path = free_name(path.parent_path() / path.stem(), path.extension().string().substr(1));
    const std::string free = std::filesystem::path(other.path).filename().string();
    const auto ends_with = [&](const ExportOrder& order, bool overwrite) {
        order_ = order;
        order_->overwrite = overwrite;
        asks_.clear();
    };
    if (ImGui::Button(tr_format("Save as {}", printable(free)).c_str()) || is_entered_)
        ends_with(other, false);
    ImGui::SameLine();
    if (ImGui::Button(tr_label("Replace it"))) ends_with(wanted, true);
    ImGui::SameLine();
    if (ImGui::Button(tr_label("Cancel"))) asks_.clear();
}

void ExportSheet::buttons(const ExportOrder& wanted, bool is_taken, const ExportView& view) {
    const bool is_figures = wanted.kind == kFigures;
    const bool can_export = !view.is_busy && (!is_figures || view.has_figures);
    if (view.done) {
        ImGui::ProgressBar(static_cast<float>(*view.done),
                           {16 * ImGui::GetFontSize(), ImGui::GetFrameHeight()},
                           tr_format("{:.0f} % done", 100 * *view.done).c_str());
        ImGui::SameLine();
        ImGui::BeginDisabled(!view.cancel);
        if (ImGui::Button(tr_label("Cancel"))) view.cancel();
        ImGui::EndDisabled();
        return;
    }
    ImGui::BeginDisabled(!can_export);
    if (ImGui::Button(view.is_busy ? tr_label("drawing ...") : tr_label("Export"),
                      {8 * ImGui::GetFontSize(), 0}) ||
        (is_entered_ && can_export)) {
        if (is_taken)
            asks_ = wanted.path;
        else
            order_ = wanted;
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(is_figures);
    if (ImGui::Button(tr_label("Copy the command")))
        ImGui::SetClipboardText(command_of(wanted).c_str());
    ImGui::EndDisabled();
}

void ExportSheet::result(const ExportChoice& choice, const ExportView& view) {
    ExportOrder wanted;
    std::vector<std::string> files, taken;
    try {
        wanted = order_of(choice, stamps_, view.scene, view.utc, view.zone);
        files = files_of(wanted);
        std::ranges::copy_if(files, std::back_inserter(taken), relevo::is_taken);
    } catch (const Error& error) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(style::error(), "%s", error.what());
        ImGui::PopTextWrapPos();
        return;
    }
    std::string text = printable(wanted.path);
    for (std::size_t i = 1; i < files.size(); ++i)
        text += ", " + printable(std::filesystem::path(files[i]).filename().string());
    ImGui::TextWrapped("%s", text.c_str());
    if (asks_ != wanted.path) asks_.clear();
    if (!taken.empty())
        ImGui::TextColored(
            style::lit(), "%s",
            tr_format("{} exists already",
                      printable(std::filesystem::path(taken.front()).filename().string()))
                .c_str());
    if (asks_.empty())
        buttons(wanted, !taken.empty(), view);
    else
        question(wanted);
    if (!view.message.empty()) ImGui::TextWrapped("%s", view.message.c_str());
}

void ExportSheet::draw(glm::vec2 window_px, ExportChoice& choice, const ExportView& view) {
    if (!is_open_) return;
    const bool has_keys = has_focus_ && !has_popup_;
    const auto is_pressed = [&](ImGuiKey key) {
        return has_keys && ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false);
    };
    is_entered_ = is_pressed(ImGuiKey_Enter) || is_pressed(ImGuiKey_KeyPadEnter);
    // Return exports: it does not also edit the field that the arrows have reached.
    if (is_entered_) ImGui::GetCurrentContext()->NavActivateInputId = 0;
    if (is_pressed(ImGuiKey_Escape)) {
        is_open_ = !asks_.empty();
        takes_focus_ = is_open_;
        asks_.clear();
    }
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({window_px.x / 2, window_px.y / 2}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(window_px.x - 20, 36 * line), std::min(window_px.y - 2 * line, 25 * line)},
        ImGuiCond_Always);
    if (ImGui::Begin(tr_label("Export"), &is_open_, ImGuiWindowFlags_NoCollapse)) {
        const float width = 0.55f * ImGui::GetContentRegionAvail().x;
        const float height = ImGui::GetContentRegionAvail().y - 7 * line;
        if (ImGui::BeginChild("fields", {width, height}, false, ImGuiWindowFlags_NavFlattened))
            fields(choice, view, window_px);
        ImGui::EndChild();
        ImGui::SameLine();
        if (ImGui::BeginChild("preview", {0, height})) preview(choice, view);
        ImGui::EndChild();
        ImGui::Separator();
        file_fields(choice);
        result(choice, view);
        has_focus_ = ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows);
    }
    ImGui::End();
    has_popup_ = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup);
    has_focus_ = has_focus_ || has_popup_;
}

}  // namespace relevo::viewer

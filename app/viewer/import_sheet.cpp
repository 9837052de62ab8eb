#include "viewer/import_sheet.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/error.h"
#include "base/text.h"
#include "viewer/image_texture.h"
#include "viewer/sheet.h"
#include "viewer/translation.h"
#include "viewer/window.h"
#include "viewer/window_words.h"

namespace relevo::viewer {
namespace {

constexpr int kPreview_px = 320;
constexpr std::size_t kMostFound = 40;
constexpr std::array<const char*, 8> kUnits = {
    tr_later("as the file says"), "m", "ft", "us-ft", "cm", "mm", "dm", "km"};
constexpr std::array<const char*, 3> kEncodings = {tr_later("none: a band has heights"),
                                                   "terrain-rgb", "terrarium"};

/// A message about the files in words of the sheet, which names them above.
std::string sheet_words(const std::string& message, const std::vector<std::string>& files) {
    const std::string subject = printable(files.front()) + ": ";
    return window_words(message.starts_with(subject) ? message.substr(subject.size()) : message);
}

}  // namespace

ImportSheet::Fields ImportSheet::Fields::of(const dem::LoadOptions& options) {
    Fields fields;
    fields.crs = options.crs;
    fields.unit = options.unit;
    fields.crop = options.crop;
    fields.band = options.band;
    fields.encoding = static_cast<int>(options.encoding);
    if (options.no_nodata)
        fields.nodata = "none";
    else if (options.nodata)
        fields.nodata = fmt::format("{}", *options.nodata);
    if (const auto& bounds = options.bounds)
        fields.bounds = fmt::format("{},{},{},{}", bounds->west_deg, bounds->south_deg,
                                    bounds->east_deg, bounds->north_deg);
    return fields;
}

dem::LoadOptions ImportSheet::Fields::options(const dem::LoadOptions& rest) const {
    dem::LoadOptions options = rest;
    options.crs = std::string(trimmed(crs));
    options.unit = unit;
    options.band = band;
    options.encoding = static_cast<dem::Encoding>(encoding);
    const std::string_view value = trimmed(nodata);
    options.no_nodata = value == "none";
    options.nodata.reset();
    if (!value.empty() && !options.no_nodata) {
        options.nodata = parse_number(value);
        if (!options.nodata)
            bad_usage(tr_format("nodata: expected a number or none, but got {}", printable(value)));
    }
    options.crop = std::string(trimmed(crop));
    if (!options.crop.empty()) dem::parse_bounds(options.crop, "crop");
    options.bounds.reset();
    if (!trimmed(bounds).empty()) options.bounds = dem::parse_bounds(trimmed(bounds), "bounds");
    return options;
}

void ImportSheet::open(const RecentDem& dem, std::string reason, const RecentDem& other) {
    dem_ = dem;
    reason_ = std::move(reason);
    fields_ = Fields::of(dem.options);
    error_.clear();
    previewed_.reset();
    shown_ = nullptr;
    suggestions_.clear();
    selected_ = 0;
    other_ = other;
    if (!work_) work_ = std::make_unique<PreviewWork>(&Window::wake);
    work_->forget();
    is_open_ = takes_focus_ = true;
}

ImportSheet::Fields ImportSheet::highlighted() const {
    Fields fields = fields_;
    if (is_choosing()) fields.crs = listed()[static_cast<std::size_t>(selected_)].crs.code;
    return fields;
}

void ImportSheet::want_preview() {
    const Fields fields = highlighted();
    if (previewed_ == fields) return;
    previewed_ = fields;
    try {
        wanted_ = {dem_.files, fields.options(dem_.options), kPreview_px, other_};
        work_->want(wanted_);
        error_.clear();
    } catch (const Error& error) {
        error_ = error.what();
    }
}

void ImportSheet::crs_field() {
    if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
    const auto on_arrow = [](ImGuiInputTextCallbackData* data) {
        *static_cast<int*>(data->UserData) += data->EventKey == ImGuiKey_DownArrow ? 1 : -1;
        return 0;
    };
    const bool is_entered = ImGui::InputTextWithHint(
        tr_label("CRS"), tr("as the file says; or search"), &fields_.crs,
        ImGuiInputTextFlags_AutoSelectAll | ImGuiInputTextFlags_EnterReturnsTrue |
            ImGuiInputTextFlags_CallbackHistory,
        on_arrow, &selected_);
    if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
        ImGui::SetTooltip(
            "%s",
            tr("A code (EPSG:31287), words (austria lambert), or latitude, longitude of a place"));
    search();
    selected_ = std::clamp(selected_, 0, std::max(0, static_cast<int>(listed().size()) - 1));
    if (is_entered && is_choosing()) {
        fields_.crs = highlighted().crs;
        takes_focus_ = true;
    } else if (is_entered && can_open()) {
        choose();
    }
    crs_list();
}

void ImportSheet::search() {
    if (searched_ == fields_.crs) return;
    searched_ = fields_.crs;
    selected_ = 0;
    found_.clear();
    try {
        for (geo::KnownCrs& crs : geo::search_crs(searched_, kMostFound)) {
            std::string area = crs.area;
            found_.push_back({std::move(crs), std::move(area)});
        }
    } catch (const Error& error) {
        error_ = error.what();
    }
}

void ImportSheet::crs_list() {
    if (!is_choosing())
        return ImGui::TextDisabled("%s", listed().empty() ? "" : listed()[0].crs.name.c_str());
    if (fields_.crs.empty()) ImGui::TextDisabled("%s", tr("Suggestions: Return takes one"));
    if (ImGui::BeginChild("found", {0, 6 * ImGui::GetTextLineHeightWithSpacing()}, true))
        for (int i = 0; i < static_cast<int>(listed().size()); ++i) {
            const CrsSuggestion& each = listed()[static_cast<std::size_t>(i)];
            if (ImGui::Selectable((each.crs.code + "  " + each.crs.name).c_str(), i == selected_)) {
                fields_.crs = each.crs.code;
                break;  // the list is another one now
            }
            if (i == selected_) ImGui::SetScrollHereY();
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", each.where.c_str());
        }
    ImGui::EndChild();
}

void ImportSheet::other_fields() {
    ImGui::InputTextWithHint(tr_label("Edges"), tr("W,S,E,N in degrees; of a file without them"),
                             &fields_.bounds);
    ImGui::InputTextWithHint(tr_label("Crop"), tr("W,S,E,N in degrees; only what is in there"),
                             &fields_.crop);
    int unit = 0;
    for (std::size_t i = 1; i < kUnits.size(); ++i)
        if (fields_.unit == kUnits[i]) unit = static_cast<int>(i);
    if (ImGui::Combo(tr_label("Unit"), &unit, tr_all(kUnits).data(),
                     static_cast<int>(kUnits.size())))
        fields_.unit = unit == 0 ? "" : kUnits[static_cast<std::size_t>(unit)];
    ImGui::InputTextWithHint(tr_label("Nodata"), tr("as the file says; a number, or none"),
                             &fields_.nodata, ImGuiInputTextFlags_AutoSelectAll);
    int band = std::max(1, fields_.band);
    if (ImGui::InputInt(tr_label("Band"), &band)) fields_.band = std::max(1, band);
    ImGui::Combo(tr_label("Encoding"), &fields_.encoding, tr_all(kEncodings).data(),
                 static_cast<int>(kEncodings.size()));
}

void ImportSheet::take_preview() {
    auto newer = work_->answer();
    if (newer == shown_) return;
    shown_ = std::move(newer);
    const bool has_picture = shown_ && !shown_->picture.values.empty();
    texture_ = has_picture ? texture_of(shown_->picture) : gl::Texture();
    if (shown_ && !shown_->suggestions.empty()) suggestions_ = shown_->suggestions;
}

bool ImportSheet::can_open() const {
    return error_.empty() && previewed_ == highlighted() && shown_ && shown_->error.empty() &&
           shown_->of.options == wanted_.options;
}

void ImportSheet::preview(float width_px) {
    if (!error_.empty()) return ImGui::TextWrapped("%s", error_.c_str());
    if (!shown_) return ImGui::TextDisabled("%s", tr("reading ..."));
    if (shown_->error == reason_) return;
    if (!shown_->error.empty())
        return ImGui::TextWrapped("%s", sheet_words(shown_->error, dem_.files).c_str());
    const gl::Extent extent = texture_.extent();
    const float scale = std::min(width_px / static_cast<float>(extent.width),
                                 width_px * 0.7f / static_cast<float>(extent.height));
    ImGui::Image(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.name())),
        {scale * static_cast<float>(extent.width), scale * static_cast<float>(extent.height)});
    if (can_open())
        ImGui::TextWrapped("%s", window_words(shown_->text).c_str());
    else
        ImGui::TextDisabled("%s", tr("reading ..."));
}

void ImportSheet::choose() {
    chosen_ = dem_;
    chosen_->options = wanted_.options;
    is_open_ = false;
}

void ImportSheet::buttons() {
    const float width = 5 * ImGui::GetFrameHeight();
    ImGui::BeginDisabled(!can_open());
    if (ImGui::Button(tr_label("Open"), {width, 0})) choose();
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button(tr_label("Cancel"), {width, 0}) || closes_sheet()) is_open_ = false;
}

void ImportSheet::draw(glm::vec2 size_px) {
    if (!is_open_) return;
    take_preview();
    want_preview();
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({size_px.x / 2, size_px.y / 2}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(
        {std::min(size_px.x - 20, 34 * line), std::min(size_px.y - 2 * line, 22 * line)},
        ImGuiCond_Appearing);
    if (ImGui::Begin(tr_label("How the DEM is read"), &is_open_, ImGuiWindowFlags_NoCollapse)) {
        ImGui::TextUnformatted(printable(short_name(dem_.files)).c_str());
        if (!reason_.empty()) ImGui::TextWrapped("%s", sheet_words(reason_, dem_.files).c_str());
        ImGui::Separator();
        const float fields_px = 0.55f * ImGui::GetContentRegionAvail().x;
        const float height_px = ImGui::GetContentRegionAvail().y - 1.5f * line;
        if (ImGui::BeginChild("fields", {fields_px, height_px})) {
            ImGui::PushItemWidth(-widest({tr("CRS"), tr("Edges"), tr("Crop"), tr("Unit"),
                                          tr("Nodata"), tr("Band"), tr("Encoding")}));
            crs_field();
            other_fields();
            ImGui::PopItemWidth();
        }
        ImGui::EndChild();
        ImGui::SameLine();
        if (ImGui::BeginChild("preview", {0, height_px})) preview(ImGui::GetContentRegionAvail().x);
        ImGui::EndChild();
        buttons();
    }
    ImGui::End();
}

}  // namespace relevo::viewer

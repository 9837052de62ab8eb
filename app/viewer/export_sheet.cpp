#include "viewer/export_sheet.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/error.h"
#include "base/text.h"
#include "scene/name_template.h"
#include "scene/panorama.h"
#include "scene/scene_words.h"
#include "scene/stereo.h"
#include "viewer/export.h"
#include "viewer/sheet.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

struct Format {
    const char* name;
    const char* ending;
    int bits = 8;
    bool has_quality = false;
    bool has_alpha = true;
};
constexpr std::array<Format, 7> kFormats = {{{"PNG", "png"},
                                             {tr_later("PNG, 16 bits"), "png", 16},
                                             {"JPEG", "jpg", 8, true, false},
                                             {"WebP", "webp", 8, true},
                                             {"AVIF", "avif", 8, true},
                                             {"TIFF", "tif"},
                                             {tr_later("EXR, linear light"), "exr"}}};

struct Size {
    const char* name;
    glm::ivec2 px;  ///< 0: the window's
};
constexpr std::array<Size, 6> kSizes = {{{tr_later("window"), {0, 0}},
                                         {"1920 x 1080", {1920, 1080}},
                                         {"3840 x 2160", {3840, 2160}},
                                         {tr_later("square, 2048 x 2048"), {2048, 2048}},
                                         {tr_later("A4 at 300 dpi"), {3508, 2480}},
                                         {tr_later("A2 at 300 dpi"), {7016, 4961}}}};

constexpr std::array<int, 4> kSamples = {1, 4, 8, 16};

struct Kind {
    const char* name;
    glm::ivec2 size_px;
    bool is_ortho = false;
    scene::Panorama panorama = scene::Panorama::None;
    scene::Stereo stereo = scene::Stereo::None;

    bool is_picture() const {
        return panorama == scene::Panorama::None && stereo == scene::Stereo::None;
    }
};
constexpr std::array<Kind, 6> kKinds = {
    {{tr_later("picture"), {1920, 1080}},
     {tr_later("map of all of the DEM, with georeference"), {2048, 2048}, true},
     {tr_later("panorama"), {8192, 1024}, false, scene::Panorama::Cylindrical},
     {tr_later("sphere (equirectangular)"), {4096, 2048}, false, scene::Panorama::Equirectangular},
     {tr_later("stereo pair"), {2560, 1024}, false, scene::Panorama::None, scene::Stereo::Parallel},
     {tr_later("anaglyph"), {1920, 1080}, false, scene::Panorama::None, scene::Stereo::Anaglyph}}};

/// Index of the kind of a scene.
std::size_t kind_of(const scene::Scene& scene) {
    const auto found = std::ranges::find_if(kKinds, [&](const Kind& kind) {
        return kind.is_ortho == scene.ortho && kind.panorama == scene.view.panorama &&
               kind.stereo == scene.view.stereo;
    });
    return found == kKinds.end() ? 0 : static_cast<std::size_t>(found - kKinds.begin());
}

}  // namespace

void ExportSheet::take_scene(const scene::Scene& scene) {
    stamps_.reset();
    what_ = kind_of(scene);
}

/// A kind sets a size that suits it.
void ExportSheet::kind_field() {
    if (!ImGui::BeginCombo(tr_label("What"), tr(kKinds[what_].name))) return;
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
        if (!ImGui::Selectable(tr_label(kKinds[i].name), i == what_)) continue;
        what_ = i;
        size_px_ = kKinds[i].size_px;
    }
    ImGui::Separator();
    if (ImGui::Selectable(tr_label("film ..."))) command_ = Command::Film;
    if (ImGui::Selectable(tr_label("figures of the overlay, as GeoTIFF")))
        command_ = Command::SaveOverlay;
    ImGui::EndCombo();
}

void ExportSheet::size_fields(glm::vec2 window_px) {
    if (ImGui::BeginCombo(tr_label("Size"),
                          fmt::format("{} x {}", size_px_.x, size_px_.y).c_str())) {
        for (const Size& size : kSizes)
            if (ImGui::Selectable(tr_label(size.name)))
                size_px_ = size.px.x > 0 ? size.px : glm::ivec2(window_px);
        ImGui::EndCombo();
    }
    if (ImGui::InputInt2(tr_label("Pixels"), &size_px_.x))
        size_px_ = glm::clamp(size_px_, glm::ivec2(1), glm::ivec2(scene::kMaxSide_px));
    ImGui::BeginDisabled(kKinds[what_].is_ortho);
    ImGui::Checkbox(tr_label("Centred on what the panels leave free"), &is_centred_);
    ImGui::EndDisabled();
}

void ExportSheet::format_fields() {
    const auto name_of = [](void*, int i, const char** name) {
        *name = tr(kFormats[static_cast<std::size_t>(i)].name);
        return true;
    };
    ImGui::Combo(tr_label("Format"), &format_, name_of, nullptr, static_cast<int>(kFormats.size()));
    if (kFormats[static_cast<std::size_t>(format_)].has_quality)
        ImGui::SliderInt(tr_label("Quality"), &quality_, 1, 100);
    if (ImGui::BeginCombo(tr_label("Samples"), tr_format("{} a pixel", samples_).c_str())) {
        for (const int samples : kSamples)
            if (ImGui::Selectable(tr_format("{} a pixel", samples).c_str())) samples_ = samples;
        ImGui::EndCombo();
    }
    const bool has_alpha = kFormats[static_cast<std::size_t>(format_)].has_alpha;
    ImGui::BeginDisabled(!has_alpha);
    ImGui::Checkbox(tr_label("Transparent where there is no ground"), &is_transparent_);
    ImGui::EndDisabled();
}

void ExportSheet::stamp_fields(const scene::Scene& scene) {
    if (!stamps_) stamps_ = scene.stamps;
    ImGui::TextUnformatted(tr("On the picture:"));
    int column = 0;
    for (const auto& [word, member] : scene::stamp_words()) {
        if (member == &scene::Stamps::attribution && stamps_->attribution_text.empty()) continue;
        if (column++ % 3 != 0) ImGui::SameLine(9.0f * ImGui::GetFontSize() * ((column - 1) % 3));
        ImGui::Checkbox(std::string(word).c_str(), &((*stamps_).*member));
    }
    ImGui::BeginDisabled(!kKinds[what_].is_picture());
    ImGui::Checkbox(tr_label("Around the picture, so that nothing lies on it"), &stamps_->margin);
    ImGui::EndDisabled();
    if (stamps_->title)
        ImGui::InputText(tr_label("Title"), &stamps_->title_text,
                         ImGuiInputTextFlags_AutoSelectAll);
}

PictureOrder ExportSheet::order(const scene::Scene& scene, sun::Instant utc,
                                const sun::Zone& zone) const {
    const Format& format = kFormats[static_cast<std::size_t>(format_)];
    PictureOrder order;
    order.scene = scene;
    order.scene.width_px = size_px_.x;
    order.scene.height_px = size_px_.y;
    order.scene.samples = samples_;
    order.scene.transparent = is_transparent_ && format.has_alpha;
    order.scene.stamps = stamps_.value_or(scene.stamps);
    const Kind& kind = kKinds[what_];
    order.scene.ortho = kind.is_ortho;
    order.scene.view.panorama = kind.panorama;
    order.scene.view.stereo = kind.stereo;
    order.scene.stamps.margin = order.scene.stamps.margin && kind.is_picture();
    order.scene.resolution = 0;  // the sheet has a size
    scene::check_panorama(order.scene);
    scene::check_stereo(order.scene);
    order.encoding.bits = format.bits;
    if (format.has_quality) order.encoding.quality = quality_;
    const std::string dem = std::filesystem::path(scene.dems.front()).stem().string();
    const std::string stem =
        scene::NameTemplate(name_, {}).name({.number = 1, .dem = dem, .utc = utc, .zone = zone});
    order.path = free_name(stem, format.ending);
    image::check_encoding(
        order.path, order.encoding,
        {.width_px = size_px_.x, .height_px = size_px_.y, .alpha = order.scene.transparent});
    return order;
}

void ExportSheet::result(const scene::Scene& scene, sun::Instant utc, const sun::Zone& zone,
                         bool is_busy) {
    PictureOrder wanted;
    try {
        wanted = order(scene, utc, zone);
    } catch (const Error& error) {
        ImGui::TextWrapped("%s", error.what());
        return;
    }
    ImGui::TextWrapped("%s", printable(wanted.path).c_str());
    if (is_busy) ImGui::BeginDisabled();
    if (ImGui::Button(is_busy ? tr_label("drawing ...") : tr_label("Export"),
                      {8 * ImGui::GetFontSize(), 0}))
        order_ = wanted;
    if (is_busy) ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button(tr_label("Copy the command")))
        ImGui::SetClipboardText(command_of(wanted).c_str());
}

void ExportSheet::draw(glm::vec2 window_px, const scene::Scene& scene, sun::Instant utc,
                       const sun::Zone& zone, bool is_busy) {
    if (!is_open_) return;
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({window_px.x - line, 5.5f * line}, ImGuiCond_Appearing, {1, 0});
    ImGui::SetNextWindowSize({std::min(window_px.x - 20, 19 * line), 0}, ImGuiCond_Always);
    if (ImGui::Begin(tr_label("Export a picture"), &is_open_, ImGuiWindowFlags_NoCollapse)) {
        ImGui::PushItemWidth(-widest({tr("What"), tr("Size"), tr("Pixels"), tr("Format"),
                                      tr("Quality"), tr("Samples"), tr("Title"), tr("Name")}));
        kind_field();
        size_fields(window_px);
        format_fields();
        stamp_fields(scene);
        ImGui::InputText(tr_label("Name"), &name_, ImGuiInputTextFlags_AutoSelectAll);
        if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
            ImGui::SetTooltip("%s", tr("{dem}, and {time:...} with the conversions of strftime"));
        ImGui::PopItemWidth();
        ImGui::Separator();
        result(scene, utc, zone, is_busy);
        if (closes_sheet()) is_open_ = false;
    }
    ImGui::End();
}

}  // namespace relevo::viewer

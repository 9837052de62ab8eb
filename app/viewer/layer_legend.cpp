#include "viewer/layer_legend.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/overlay.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

constexpr int kSteps = 64;  // of a bar

ImU32 packed(const chart::Color& color) {
    return style::colour(color.rgb, static_cast<unsigned>(std::lround(255 * color.opacity)));
}

std::string unit_of(const chart::Legend& legend) {
    if (legend.unit.empty() || legend.unit == "1") return {};
    return (legend.unit == "°" ? "" : " ") + legend.unit;
}

/// Text at the right edge of the panel, on the line of the last item.
void right_text(const std::string& text) {
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x);
    ImGui::TextDisabled("%s", text.c_str());
}

void bar(const chart::Legend& legend) {
    const double low = legend.ramp.stops.front().value, high = legend.ramp.stops.back().value;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, 0.7f * ImGui::GetFontSize()};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (int k = 0; k < kSteps; ++k) {
        const auto x = [&](int step) { return at.x + size.x * static_cast<float>(step) / kSteps; };
        const double value = low + (high - low) * (k + 0.5) / kSteps;
        list.AddRectFilled({x(k), at.y}, {x(k + 1), at.y + size.y}, packed(legend.ramp.at(value)));
    }
    ImGui::Dummy(size);
    constexpr double kDigits = 100;  // between the ends
    const double step = std::pow(10, std::floor(std::log10((high - low) / kDigits)));
    ImGui::TextDisabled("%s", chart::value_text(legend, low, step).c_str());
    right_text(chart::value_text(legend, high, step) + unit_of(legend));
}

void swatch(const chart::Color& color, const std::string& name) {
    const float side = 0.8f * ImGui::GetFontSize();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side}, packed(color));
    ImGui::Dummy({side, side});
    ImGui::SameLine();
    ImGui::TextDisabled("%s", name.c_str());
}

/// Swatches in as many columns as fit.
void swatches(const std::vector<chart::Legend::Class>& classes) {
    float widest = 0;
    for (const chart::Legend::Class& one : classes)
        widest = std::max(widest, ImGui::CalcTextSize(one.name.c_str()).x);
    const float column = widest + 2.5f * ImGui::GetFontSize();
    const int columns = std::max(1, static_cast<int>(ImGui::GetContentRegionAvail().x / column));
    if (!ImGui::BeginTable("swatches", columns, ImGuiTableFlags_SizingFixedSame)) return;
    for (const chart::Legend::Class& one : classes) {
        ImGui::TableNextColumn();
        swatch(one.color, one.name);
    }
    ImGui::EndTable();
}

/// "30 to 35 °", of each class.
std::vector<chart::Legend::Class> classes_of(const chart::Legend& legend) {
    std::vector<chart::Legend::Class> classes;
    for (std::size_t k = 0; k + 1 < legend.edges.size(); ++k)
        classes.push_back(
            {tr_format("{:.6g} to {:.6g}{}", legend.edges[k], legend.edges[k + 1], unit_of(legend)),
             legend.ramp.at(legend.edges[k])});
    return classes;
}

/// The directions of a ring.
std::vector<chart::Legend::Class> directions_of(const chart::Legend& legend) {
    std::vector<chart::Legend::Class> classes;
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 45)
        classes.push_back({compass_text(azimuth_deg), legend.ramp.at(azimuth_deg)});
    return classes;
}

}  // namespace

void layer_legend(const chart::Legend& legend) {
    if (!legend.classes.empty()) return swatches(legend.classes);
    if (!legend.edges.empty()) return swatches(classes_of(legend));
    if (legend.ramp.stops.size() < 2) return;
    if (legend.ring) return swatches(directions_of(legend));
    if (legend.ramp.stops.back().value > legend.ramp.stops.front().value) bar(legend);
}

}  // namespace relevo::viewer

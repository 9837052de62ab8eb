#include "viewer/find_sheet.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/places.h"
#include "geo/format.h"
#include "names/summit_top.h"
#include "viewer/latest_work.h"
#include "viewer/overlay.h"
#include "viewer/sheet.h"
#include "viewer/style.h"
#include "viewer/translation.h"
#include "viewer/window.h"

namespace relevo::viewer {
namespace {

constexpr std::size_t kMostRows = 10;

struct NameWanted {
    std::string text;
    names::Near near;
};

struct NamesFound {
    NameWanted of;
    std::vector<const names::Entry*> entries{};
    std::string error{};  ///< why the lists of names cannot be read; empty: they can
};

/// "Munich (München)": with the first other name.
std::string title_of(const names::Entry& entry) {
    const std::string_view other = entry.others.substr(0, entry.others.find('|'));
    return other.empty() ? std::string(entry.name) : fmt::format("{} ({})", entry.name, other);
}

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

std::string way_text(const geo::Geodetic& place, const dem::Grid& grid) {
    const geo::Geodesic way = geo::geodesic(grid.center(), place);
    const std::string length = length_text(way.distance_m);
    const char* const point = compass_text(degrees(way.azimuth_rad));
    return names::is_on(grid, place) ? tr_format("{} {} of the DEM's middle", length, point)
                                     : tr_format("{} {}, outside the DEM", length, point);
}

/// Finds the names that Relevo brings in the background: the first search reads them.
class FindSheet::Search : public LatestWork<NameWanted, NamesFound> {
  public:
    Search()
        : LatestWork(&Window::wake, [](const NameWanted&, const NameWanted&) { return true; }) {}
    ~Search() override { end(); }

  private:
    void work_out(const NameWanted* wanted) override {
        if (!wanted) return;
        auto found = std::make_shared<NamesFound>(NamesFound{.of = *wanted});
        try {
            found->entries =
                names::Gazetteer::shipped().find(wanted->text, wanted->near, 4 * kMostRows);
        } catch (const Error& error) {
            found->error = error.what();
        }
        publish(found, true);
    }
};

FindSheet::FindSheet() = default;
FindSheet::~FindSheet() = default;

void FindSheet::open() {
    is_open_ = takes_focus_ = true;
    searched_.reset();
    if (!search_) search_ = std::make_unique<Search>();
}

void FindSheet::choose(const FoundPlace& place) {
    chosen_ = place;
    is_open_ = false;
}

bool FindSheet::draw_field() {
    if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1);
    const auto on_arrow = [](ImGuiInputTextCallbackData* data) {
        *static_cast<int*>(data->UserData) += data->EventKey == ImGuiKey_DownArrow ? 1 : -1;
        return 0;
    };
    return ImGui::InputTextWithHint("##place", tr("a place, a summit or coordinates"), &text_,
                                    ImGuiInputTextFlags_EnterReturnsTrue |
                                        ImGuiInputTextFlags_AutoSelectAll |
                                        ImGuiInputTextFlags_CallbackHistory,
                                    on_arrow, &selected_);
}

void FindSheet::look_up(State& state, const dem::Grid& grid) {
    if (searched_ != text_ || grid_ != &grid) {
        searched_ = text_;
        grid_ = &grid;
        selected_ = 0;
        is_done_ = false;
        own_.clear();
        if (const auto place = geo::find_coordinates(text_))
            own_.push_back({geo::degrees_text(*place), *place});
        else if (state.effects)
            own_ = find_names(text_, *state.effects, kMostRows);
        search_->want({text_, names::around(grid)});
    }
    const std::shared_ptr<const NamesFound> answer = search_->answer();
    if (is_done_ || !search_->is_done() || answer->of.text != text_) return;
    is_done_ = true;
    error_ = answer->error;
    rows_ = own_;
    for (const names::Entry* const entry : answer->entries)
        rows_.push_back({title_of(*entry), entry->place,
                         entry->kind == names::Kind::Summit ? entry : nullptr,
                         std::string(entry->country)});
    // The search knows a circle around the DEM.
    std::stable_partition(rows_.begin() + static_cast<std::ptrdiff_t>(own_.size()), rows_.end(),
                          [&](const FoundPlace& row) { return names::is_on(grid, row.place); });
    if (rows_.size() > kMostRows) rows_.resize(kMostRows);
    state.found_names = text_;
    for (FoundPlace& row : rows_) {
        if (!row.details.empty()) row.details += ", ";
        row.details += way_text(row.place, grid);
        state.found_names += row.name;
    }
}

void FindSheet::draw_rows() {
    selected_ = std::clamp(selected_, 0, std::max(0, static_cast<int>(rows_.size()) - 1));
    for (int i = 0; i < static_cast<int>(rows_.size()); ++i) {
        const FoundPlace& row = rows_[static_cast<std::size_t>(i)];
        ImGui::PushID(i);
        const bool clicked = ImGui::Selectable(printable(row.name).c_str(), i == selected_);
        const float width = ImGui::CalcTextSize(row.details.c_str()).x;
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
        ImGui::TextDisabled("%s", row.details.c_str());
        ImGui::PopID();
        if (clicked || (enters_ && i == selected_)) choose(row);
    }
}

void FindSheet::draw(glm::vec2 size_px, State& state, const dem::Grid& grid) {
    if (!is_open_) return;
    const float line = ImGui::GetFrameHeight();
    ImGui::SetNextWindowPos({size_px.x / 2, 4 * line}, ImGuiCond_Appearing, {0.5f, 0});
    ImGui::SetNextWindowSize({std::min(size_px.x - 20, 24 * line), 0}, ImGuiCond_Always);
    if (ImGui::Begin(tr_label("Go to a place"), &is_open_, ImGuiWindowFlags_NoCollapse)) {
        if (draw_field()) enters_ = takes_focus_ = true;
        look_up(state, grid);
        draw_rows();
        if (chosen_ && chosen_->summit && names::is_on(grid, chosen_->place))
            chosen_->place = names::on_top(*chosen_->summit, grid, [&](int column, int row) {
                                 return state.land.height_m(grid.place(column, row));
                             }).place;
        if (is_done_) enters_ = false;
        if (rows_.empty() && error_.empty())
            ImGui::TextDisabled("%s", text_.empty() ? tr("47.4395, 11.8935; 32N 683473 5255234; "
                                                         "32TPT8347355234")
                                      : is_done_    ? tr("nothing found")
                                                    : tr("searching ..."));
        if (!error_.empty()) ImGui::TextWrapped("%s", error_.c_str());
        const style::Sized small(style::Size::Small);
        ImGui::TextDisabled("%s", tr("Names: GeoNames, CC BY 4.0, and others (Help, About)"));
        if (closes_sheet()) close();
    }
    ImGui::End();
}

}  // namespace relevo::viewer

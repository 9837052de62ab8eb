// Sheets of the menu Help.
#include <array>
#include <span>

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/overlay.h"
#include "viewer/style.h"
#include "viewer/translation.h"

namespace relevo::viewer {
namespace {

using Row = std::array<const char*, 2>;

void begin_in_the_middle(const char* title) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {window.x, window.y});
    ImGui::Begin(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
}

void rows(std::span<const Row> of) {
    if (!ImGui::BeginTable("rows", 2, ImGuiTableFlags_SizingFixedFit)) return;
    for (const auto& [what, text] : of) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(tr(what));
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", tr(text));
    }
    ImGui::EndTable();
}

void first_steps() {
    static constexpr std::array<Row, 8> kSteps = {{
        {tr_later("Look around"), tr_later("drag with the left button, turn with the right one, "
                                           "zoom with the wheel; Home shows all")},
        {tr_later("Move the sun"),
         tr_later("drag along the strip at the lower edge, or the sun in the sky")},
        {tr_later("Change the day"), tr_later("by its date and the buttons next to it")},
        {tr_later("Ask a place"), tr_later("click the ground: its direct sun of the day, its "
                                           "horizon and its year")},
        {tr_later("See where sun is"), tr_later("O: hours of sun on the ground")},
        {tr_later("Change the look"), tr_later("Effects and presets in the panel")},
        {tr_later("Take it along"), tr_later("F12 saves a picture, Ctrl + P asks how, F makes a "
                                             "film")},
        {tr_later("Open more"), tr_later("drop a DEM, scene, photograph or track on the window")},
    }};
    begin_in_the_middle(tr_label("First steps"));
    rows(kSteps);
    ImGui::TextUnformatted(tr("Esc closes this. H shows all keys."));
    ImGui::End();
}

void about(const std::string& device) {
    begin_in_the_middle(tr_label("About Relevo"));
    {
        const style::Sized title(style::Size::Title);
        ImGui::TextUnformatted(fmt::format("Relevo {}", RELEVO_VERSION).c_str());
    }
    ImGui::TextUnformatted(tr_format("draws with {}", device).c_str());
    ImGui::Separator();
    // What ships with it: data/README.md has the terms.
    static constexpr std::array<Row, 6> kData = {{
        {tr_later("Climate"),
         tr_later("NOAA (GHCN-CAMS, CMAP, Reanalysis 1, COADS), CHELSA 1.1, ERA5 (Copernicus)")},
        {tr_later("Land cover"), tr_later("NASA LP DAAC (MODIS), NASA Earth Observatory")},
        {tr_later("Time zones"), tr_later("tz-lookup, tz_world, IANA tzdata, Natural Earth")},
        {tr_later("Terrain"), tr_later("SRTM (NASA, USGS)")},
        {tr_later("Place names"), tr_later("GeoNames (geonames.org), CC BY 4.0; Natural Earth")},
        {tr_later("Summits"), tr_later("The Database of British and Irish Hills, CC BY 4.0; GSI "
                                       "(Japan); USGS GNIS; Natural Earth")},
    }};
    rows(kData);
    ImGui::TextUnformatted(
        tr("Everything else on the picture comes from your files, or is generated and said so."));
    ImGui::End();
}

void keys() {
    static constexpr std::array<Row, 37> kKeys = {{
        {tr_later("Left drag"), tr_later("move the ground")},
        {tr_later("Right drag, Shift + drag"), tr_later("turn about the ground under the cursor")},
        {tr_later("Middle drag"), tr_later("look around")},
        {tr_later("Wheel, two fingers"), tr_later("zoom to the ground under the cursor")},
        {tr_later("Shift + wheel"), tr_later("move the ground")},
        {tr_later("Drag the sun"), tr_later("along its path of the day")},
        {tr_later("Arrows"), tr_later("turn about the centre")},
        {tr_later("Page up, Page down"), tr_later("zoom in, zoom out")},
        {"W A S D, Q E", tr_later("fly, down and up; faster with Shift")},
        {"G", tr_later("walk at the clicked point or in the middle, and fly again")},
        {tr_later("Ctrl + F"), tr_later("go to coordinates or a name")},
        {tr_later("Home, N, T"), tr_later("whole DEM, north up, top view")},
        {"L", tr_later("look to the moon")},
        {"[ ]", tr_later("half an hour earlier, later; with Shift a day")},
        {tr_later("Space"), tr_later("play and pause the time")},
        {tr_later("Click"), tr_later("direct sun of the day at a point, its horizon and year")},
        {tr_later("Right click"),
         tr_later("stand there, look there, measure from there, copy its coordinates")},
        {"P", tr_later("horizon and year on and off")},
        {"M", tr_later("measure from the point: clicks set corners, Backspace goes back, M ends")},
        {"C", tr_later("compare: the left side stays, the right side follows; drag the line")},
        {"O", tr_later("sun hours of the day on the ground, on and off")},
        {"F12", tr_later("save the image as a picture")},
        {tr_later("Ctrl + P"), tr_later("export: picture, map, film, mesh, figures")},
        {tr_later("Ctrl + C"), tr_later("copy the command for this picture")},
        {tr_later("Ctrl + S"), tr_later("save the scene")},
        {tr_later("Ctrl + E"), tr_later("export the sun overlay as GeoTIFF")},
        {tr_later("Ctrl + J"), tr_later("save the day's hours as a job")},
        {"F", tr_later("film: a day, a year, orbits and flights, on a time line")},
        {tr_later("Ctrl + O"),
         tr_later("open a DEM, scene, photograph, track ...; files can be dropped too")},
        {tr_later("Ctrl + Page down, Page up"), tr_later("next, previous DEM of the folder")},
        {tr_later("B, then 1 to 9"), tr_later("save the view; go to a saved view")},
        {"F5", tr_later("reload effects (automatic if their files change)")},
        {tr_later("Ctrl + Z, Ctrl + Y"), tr_later("undo, redo")},
        {tr_later("Tab"), tr_later("panels and menu on and off")},
        {tr_later("F6, F10, Esc"),
         tr_later("keyboard to the panels, to the menu, back to the scene")},
        {tr_later("H, Esc"), tr_later("this sheet; Esc also cancels opening a DEM")},
        {tr_later("Ctrl + Q"), tr_later("quit")},
    }};
    begin_in_the_middle(tr_label("Keys"));
    rows(kKeys);
    ImGui::End();
}

}  // namespace

void help_sheet(Command sheet, const std::string& device) {
    if (sheet == Command::FirstSteps) return first_steps();
    if (sheet == Command::About) return about(device);
    keys();
}

}  // namespace relevo::viewer

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart/stamps.h"
#include "image/image.h"
#include "session/session.h"

namespace relevo::session {

/// What stamps are drawn from.
struct Stamped {
    const scene::Scene& scene;  ///< with the stamps to draw
    const LoadedDem& dem;
    const geo::LocalFrame& frame;  ///< of the DEM
    scene::Camera camera;
    /// Depths as Session::read_depths(); empty unless needs_depths().
    std::vector<float> depths_m{};
    std::string clock{}, sun{};  ///< as Session::clock_text() and sun_text(), if stamped
};

/// True if stamps depend on the visible ground.
bool needs_depths(const scene::Stamps& wanted);

/// The stamps of a session's picture before it is drawn, for chart::margins_for(): scale, north and
/// the labels of a graticule stand for those that there may be.
chart::Stamps planned_stamps(const Session& session);

/// Draws a scene's stamps on its picture.
/// @param legends  of the colours in it
/// @param taken     receives where stamps stand in the picture, without lines of the graticule
/// @param depths_m  of the picture, if it is not the session's last frame
/// @param map       the part of the picture that shows the scene; stamps stand around it. nullopt:
///     all of it
/// @returns sentences on stamps that were omitted
std::vector<std::string> add_stamps(const Session& session,
                                    const std::vector<chart::Legend>& legends,
                                    image::Image8& picture, std::vector<chart::Rect>& taken,
                                    const std::vector<float>* depths_m = nullptr,
                                    const std::optional<chart::Rect>& map = std::nullopt);
std::vector<std::string> add_stamps(Stamped stamped, const std::vector<chart::Legend>& legends,
                                    image::Image8& picture, std::vector<chart::Rect>& taken,
                                    const std::optional<chart::Rect>& map = std::nullopt);

/// What stands around the map of a sheet, and the lines of its graticule. Places are pixels of the
/// sheet.
struct SheetStamps {
    chart::Rect map;  ///< where it lies, at whole pixels
    std::vector<chart::Placed> drawings;
    std::vector<chart::Rect> taken;  ///< as chart::LaidStamps
    std::string title;               ///< also if it is not stamped
    std::vector<std::string> notes;  ///< sentences on what was omitted
};

/// What a sheet has within its white edge.
struct SheetRoom {
    glm::ivec2 sheet_px, room_px;
    double unit_px;          ///< as chart::stamp_scale()
    chart::Margins margins;  ///< of planned_stamps()
    glm::ivec2 map_px;       ///< size of the map, which is the session's camera
};

/// Puts the map in the middle, and the stamps around it.
SheetStamps lay_out_sheet(const Session& session, const SheetRoom& room);

/// The eye's position if the sun is described as seen from there, with its height not exaggerated.
/// nullopt above 100 km, where sun::position() is undefined.
std::optional<geo::Geodetic> observer_of(const geo::LocalFrame& frame, const scene::Camera& camera,
                                         double exaggeration);

/// "2026-06-21 10:12 UTC+02:00".
/// @param zone    as sun::choose_zone
/// @param middle  centre of the DEM
std::string clock_text(sun::Instant utc, const std::string& zone, const geo::Geodetic& middle);
std::string clock_text(sun::Instant utc, const sun::Zone& zone);

}  // namespace relevo::session

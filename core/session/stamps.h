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

/// Draws a scene's stamps on its picture.
/// @param legends  of the colours in it
/// @param taken    receives where stamps stand in the picture, without lines of the graticule
/// @returns sentences on stamps that were omitted
std::vector<std::string> add_stamps(const Session& session,
                                    const std::vector<chart::Legend>& legends,
                                    image::Image8& picture, std::vector<chart::Rect>& taken);
std::vector<std::string> add_stamps(Stamped stamped, const std::vector<chart::Legend>& legends,
                                    image::Image8& picture, std::vector<chart::Rect>& taken);

/// The eye's position if the sun is described as seen from there, with its height not exaggerated.
/// nullopt above 100 km, where sun::position() is undefined.
std::optional<geo::Geodetic> observer_of(const geo::LocalFrame& frame, const scene::Camera& camera,
                                         double exaggeration);

/// "2026-06-21 10:12 UTC+02:00".
/// @param zone    as sun::choose_zone
/// @param middle  centre of the DEM
std::string clock_text(sun::Instant utc, const std::string& zone, const geo::Geodetic& middle);

}  // namespace relevo::session

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chart/stamps.h"
#include "image/image.h"
#include "session/session.h"

namespace relevo::session {

/// What a picture's stamps tell of.
struct Stamped {
    const scene::Scene& scene;  ///< what it wants, and what names it
    const LoadedDem& dem;
    const geo::LocalFrame& frame;  ///< the DEM's
    scene::Camera camera;
    /// Along the camera's view, as Session::read_depths(); empty where needs_depths() is not.
    std::vector<float> depths_m{};
    std::string clock{}, sun{};  ///< as Session::clock_text() and sun_text(), where wanted
};

/// Whether stamps tell of the ground in sight.
bool needs_depths(const scene::Stamps& wanted);

/// Puts what a scene wants on a picture of it.
/// @param legends  of what colours mean
/// @returns what could not be stamped and why: whole sentences
std::vector<std::string> add_stamps(const Session& session,
                                    const std::vector<chart::Legend>& legends,
                                    image::Image8& picture);
std::vector<std::string> add_stamps(Stamped stamped, const std::vector<chart::Legend>& legends,
                                    image::Image8& picture);

/// A camera's place where the sun is told of as seen from it, heights as the DEM has them; none
/// above 100 km, where sun::position() has no sun.
std::optional<geo::Geodetic> told_eye(const geo::LocalFrame& frame, const scene::Camera& camera,
                                      double exaggeration);

/// "2026-06-21 10:12 UTC+02:00".
/// @param zone    as sun::choose_zone
/// @param middle  of the DEM
std::string clock_text(sun::Instant utc, const std::string& zone, const geo::Geodetic& middle);

}  // namespace relevo::session

#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "session/session.h"
#include "sun/zone.h"

namespace relevo::viewer {

/// A question: when does the sun next stand over a point?
struct SunOverQuestion {
    std::shared_ptr<const session::LoadedDem> dem;
    scene::Scene scene;    ///< files and options of the DEM, refraction
    geo::Geodetic eye;     ///< height above the zero of the DEM's heights
    geo::Geodetic target;  ///< likewise
    sun::Instant after;
    sun::Zone zone;
};

struct SunOverAnswer {
    std::optional<sun::Instant> utc;  ///< none: not within a year
    std::string words;                ///< for the user
};

/// The first passage of the sun within half a degree, in sight of the eye, in the year after a
/// time; its figures are those of `relevo sun when`.
SunOverAnswer sun_over(const SunOverQuestion& question);

/// Answers the latest question in the background.
class SunOver {
  public:
    void ask(SunOverQuestion question);
    /// The answer, once. @throws Error (BadInput) where the eye or the point is outside the DEM
    std::optional<SunOverAnswer> poll();

  private:
    std::future<SunOverAnswer> answer_;
};

}  // namespace relevo::viewer

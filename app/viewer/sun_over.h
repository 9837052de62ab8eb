#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "session/session.h"
#include "sun/body.h"
#include "sun/zone.h"

namespace relevo::viewer {

/// A question: when does the sun or the moon next stand over a point?
struct SunOverQuestion {
    std::shared_ptr<const session::LoadedDem> dem;
    scene::Scene scene;    ///< files and options of the DEM, refraction
    geo::Geodetic eye;     ///< height above the zero of the DEM's heights
    geo::Geodetic target;  ///< the same height
    sun::Instant after;
    sun::Zone zone;
    sun::Body body = sun::Body::Sun;
};

struct SunOverAnswer {
    std::optional<sun::Instant> utc;  ///< none: not within a year
    std::string words;                ///< for the user
};

/// The first passage of the body within half a degree, in sight of the eye, in the year after a
/// time, as `relevo sun when` finds the sun's.
SunOverAnswer sun_over(const SunOverQuestion& question);

/// Answers the latest question in the background.
class SunOver {
  public:
    /// @returns false: the last question is not answered yet
    bool ask(SunOverQuestion question);
    /// The answer, once; none if it is of another DEM than the open one. @throws Error (BadInput)
    /// where the eye or the point is outside the DEM
    std::optional<SunOverAnswer> poll(const std::shared_ptr<const session::LoadedDem>& open);

  private:
    std::shared_ptr<const session::LoadedDem> dem_;  // of the question
    std::future<SunOverAnswer> answer_;
};

}  // namespace relevo::viewer

#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "session/session.h"
#include "sun/body.h"
#include "sun/zone.h"

namespace relevo::viewer {

/// A question: when does the sun or the moon next stand over a point, or rise over the ground?
struct SunOverQuestion {
    std::shared_ptr<const session::LoadedDem> dem;
    scene::Scene scene;                   ///< files and options of the DEM, refraction
    geo::Geodetic eye;                    ///< height above the zero of the DEM's heights
    std::optional<geo::Geodetic> target;  ///< the same height; none: the moon's next rise by night
    sun::Instant after;
    sun::Zone zone;
    sun::Body body = sun::Body::Sun;
};

struct SunOverAnswer {
    std::optional<sun::Instant> utc;  ///< none: not within a year
    std::string words;                ///< for the user
    bool looks_to_moon = false;       ///< the moon is to be in the middle of the picture
};

/// The first passage of the body within half a degree, in sight of the eye, in the year after a
/// time, as `relevo sun when` finds the sun's. Of a rise: the first one of the moon's centre over
/// the terrain horizon while the sun is at least 6 degrees below the level one.
SunOverAnswer sun_over(const SunOverQuestion& question);

/// Answers the latest question in the background.
class SunOver {
  public:
    /// @returns false: the last question is not answered yet
    bool ask(SunOverQuestion question);
    bool is_looking() const { return answer_.valid(); }
    /// The answer, once; none if it is of another DEM than the open one. @throws Error (BadInput)
    /// where the eye or the point is outside the DEM
    std::optional<SunOverAnswer> poll(const std::shared_ptr<const session::LoadedDem>& open);

  private:
    std::shared_ptr<const session::LoadedDem> dem_;  // of the question
    std::future<SunOverAnswer> answer_;
};

}  // namespace relevo::viewer

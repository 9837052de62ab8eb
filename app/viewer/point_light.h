#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chart/panorama.h"
#include "geo/geodetic.h"
#include "image/image.h"
#include "scene/scene.h"
#include "session/session.h"
#include "sun/zone.h"
#include "viewer/latest_work.h"

namespace relevo::viewer {

/// What is to be known of a point of the ground.
struct PointWanted {
    std::shared_ptr<const session::LoadedDem> dem;
    std::vector<std::string> dems;  ///< its files
    dem::LoadOptions options;       ///< how they are read
    std::string refraction;         ///< as scene::Scene
    geo::Geodetic place;
    sun::Date date;
    sun::Zone zone;
    glm::ivec2 chart_px{0};  ///< sides of the drawings; 0: none are wanted
    double px_a_unit = 1;    ///< of them
};

/// The horizon of a point, with the sun's ways of a day before it.
struct HorizonPicture {
    image::Image8 picture;
    chart::HorizonPanorama::Axes axes;  ///< in units
};

/// A year of light at a point.
struct YearPicture {
    image::Image8 picture;
    chart::Rect plot;  ///< in units
    double lit_s = 0, level_s = 0;
    int dark_days = 0;  ///< on which the sun never shines here, for ground or polar night
    int dark_row = 0;  ///< most of them one after the other; the year's last goes on with its first
    std::pair<sun::Date, sun::Date> dark;  ///< their first and last day, if there are any
};

/// A stretch of a day with sun. Where it shines at midnight the day begins or ends, not the light.
struct LitSpan : sun::TimeSpan {
    bool from_midnight = false, to_midnight = false;
};

/// When the sun reaches a point of the ground on a day.
struct PointLight {
    PointWanted of;
    std::vector<LitSpan> lit;
    double lit_s = 0, flat_s = 0;  ///< of that day, here and over a flat horizon
    double not_known_s = 0;        ///< of lit_s, for holes of the DEM
    /// The first light of the day after; none: there is none. Not looked for after the last year.
    std::optional<sun::Instant> tomorrow;
    bool tomorrow_is_known = false;
    /// Where the DEM ends too near to be sure: azimuths [deg], from and to.
    std::vector<glm::dvec2> open_deg;
    std::shared_ptr<const HorizonPicture> horizon;  ///< null: not yet, or not wanted
    std::shared_ptr<const YearPicture> year;        ///< likewise
    std::string error;                              ///< why there is no answer

    bool is_lit(sun::Instant utc) const;
    /// When that changes next on that day; none: not any more.
    std::optional<sun::Instant> next_change(sun::Instant utc) const;
};

/// Works it out on a thread of its own, from every post of the DEM: first the day, then the
/// drawings. What was begun for another point is given up; what the next answer can use is kept.
class PointWork : public LatestWork<PointWanted, PointLight> {
  public:
    /// @param on_change  called on that thread whenever there is more to be had
    explicit PointWork(std::function<void()> on_change);
    /// Waits for the step in work.
    ~PointWork() override;

  private:
    class Worker;
    void work_out(const PointWanted* wanted) override;

    std::unique_ptr<Worker> worker_;  // the thread's own
};

}  // namespace relevo::viewer

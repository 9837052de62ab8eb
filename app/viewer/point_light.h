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
#include "light/point/direct_light.h"
#include "scene/scene.h"
#include "session/session.h"
#include "sun/zone.h"
#include "viewer/latest_work.h"

namespace relevo::viewer {

/// A request about a point of the ground.
struct PointWanted {
    std::shared_ptr<const session::LoadedDem> dem;
    std::vector<std::string> dems;  ///< files of the DEM
    dem::LoadOptions options;       ///< options of reading them
    std::string refraction;         ///< as scene::Scene
    geo::Geodetic place;
    sun::Date date;
    sun::Zone zone;
    glm::ivec2 chart_px{0};  ///< size of charts; 0: no charts
    double px_a_unit = 1;    ///< scale of charts
};

/// Chart of a point's horizon with the sun's paths of a day.
struct HorizonPicture {
    image::Image8 picture;
    chart::HorizonPanorama::Axes axes;  ///< in chart units
};

/// Chart of sunlight during a year at a point.
struct YearPicture {
    image::Image8 picture;
    chart::Rect plot;                   ///< in chart units
    std::vector<light::LightDay> days;  ///< those that the zone has, in order
    double lit_s = 0, level_s = 0;
    int dark_days = 0;  ///< without direct sun, for terrain or polar night
    int dark_row = 0;   ///< most of them in succession, possibly past the year's end
    std::pair<sun::Date, sun::Date> dark;  ///< first and last day of dark_row, if any
};

/// Ground behind which the sun stands.
struct Ridge {
    double azimuth_deg = 0, elevation_deg = 0;  ///< of the ground, apparent
    double distance_m = 0;                      ///< NaN: the level horizon
};

/// A period of sun within a day. At midnight the day may cut it off.
struct LitSpan : sun::TimeSpan {
    bool from_midnight = false, to_midnight = false;
    Ridge begins_over, ends_over;
};

/// Direct sun at a point of the ground on a day.
struct PointLight {
    PointWanted of;
    std::vector<LitSpan> lit;
    double lit_s = 0, flat_s = 0;  ///< duration of sun [s], here and over a level horizon
    double not_known_s = 0;        ///< part of lit_s that is uncertain because of voids
    /// First light of the next day; nullopt without one. Not computed after the last supported
    /// year.
    std::optional<sun::Instant> tomorrow;
    bool tomorrow_is_known = false;
    /// Ranges of azimuth [deg], from and to, where unmodelled terrain could hide more.
    std::vector<glm::dvec2> open_deg;
    std::shared_ptr<const HorizonPicture> horizon;  ///< null: not computed or not requested
    std::shared_ptr<const YearPicture> year;        ///< null: not computed or not requested
    std::string error;                              ///< why the computation failed

    bool is_lit(sun::Instant utc) const;
    /// Next change between sun and shade on that day; nullopt if there is none.
    std::optional<sun::Instant> next_change(sun::Instant utc) const;
};

/// Computes PointLight in the background from all posts of the DEM: first the day, then the charts.
/// A new point cancels older work; reusable results are cached.
class PointWork : public LatestWork<PointWanted, PointLight> {
  public:
    /// @param on_change  called on that thread when there is a new result
    explicit PointWork(std::function<void()> on_change);
    /// Waits for the current step.
    ~PointWork() override;

  private:
    class Worker;
    void work_out(const PointWanted* wanted) override;

    std::unique_ptr<Worker> worker_;  // used only on that thread
};

}  // namespace relevo::viewer

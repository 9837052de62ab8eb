#include "geo/vertical_datum.h"

#include <cmath>
#include <memory>
#include <string>

#include "base/units.h"
#include "geo/proj.h"
#include "geo/proj_files.h"

namespace relevo::geo {
namespace {

struct Destroy {
    void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
    void operator()(PJ* pj) const { proj_destroy(pj); }
};

/// Latitude, longitude and height in a vertical CRS; empty: PROJ has no name for it.
std::string on_wgs84(const VerticalCrs& vertical) {
    if (vertical.name == "ellipsoidal height") return "EPSG:4979";
    if (!vertical.code.starts_with("EPSG:")) return {};
    return "EPSG:4326+" + vertical.code.substr(5);
}

}  // namespace

std::optional<double> vertical_step_m(const VerticalCrs& from, const VerticalCrs& to,
                                      const Geodetic& place) {
    const std::string source = on_wgs84(from), target = on_wgs84(to);
    if (source.empty() || target.empty()) return std::nullopt;
    const std::unique_ptr<PJ_CONTEXT, Destroy> context(proj_context_create());
    open_regular_files_only(context.get());
    proj_log_level(context.get(), PJ_LOG_NONE);
    const std::unique_ptr<PJ, Destroy> way(
        proj_create_crs_to_crs(context.get(), source.c_str(), target.c_str(), nullptr));
    if (!way) return std::nullopt;
    const PJ_COORD given = proj_coord(degrees(place.lat_rad), degrees(place.lon_rad), 0, HUGE_VAL);
    const double height = proj_trans(way.get(), PJ_FWD, given).xyz.z;
    const std::unique_ptr<PJ, Destroy> used(proj_trans_get_last_used_operation(way.get()));
    if (!used || proj_coordoperation_has_ballpark_transformation(context.get(), used.get()) != 0 ||
        !std::isfinite(height))
        return std::nullopt;
    return to.unit_m * height * (to.down ? -1 : 1);
}

}  // namespace relevo::geo

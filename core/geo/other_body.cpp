#include "geo/other_body.h"

#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

namespace relevo::geo {

std::string other_body(PJ_CONTEXT* context, const PJ* crs) {
    struct Body {
        const char* name;
        double radius_m;
    };
    constexpr std::array kBodies = {Body{"the Moon", 1'737'400}, Body{"Mars", 3'396'190},
                                    Body{"Mercury", 2'439'700}, Body{"Venus", 6'051'800}};
    constexpr double kEarth_m = 6'378'137;
    const auto like = [](double a, double b) { return std::abs(a / b - 1) < 0.01; };
    const std::unique_ptr<PJ, void (*)(PJ*)> ellipsoid(proj_get_ellipsoid(context, crs),
                                                       [](PJ* pj) { proj_destroy(pj); });
    double radius_m = 0;
    if (!ellipsoid || !proj_ellipsoid_get_parameters(context, ellipsoid.get(), &radius_m, nullptr,
                                                     nullptr, nullptr))
        return {};
    if (like(radius_m, kEarth_m)) return {};
    for (const Body& body : kBodies)
        if (like(radius_m, body.radius_m)) return body.name;
    return fmt::format("a body of {:.0f} km radius", radius_m / 1000);
}

}  // namespace relevo::geo

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "render/patch_net.h"
#include "support/support.h"

namespace relevo::render {
namespace {

/// A geographic grid: `spacing_deg` from post to post, rows running south.
PostPlace degrees_grid(double lat_deg, double lon_deg, double spacing_deg) {
    return [=](double column, double row) {
        return geo::geodetic_deg(lat_deg - row * spacing_deg, lon_deg + column * spacing_deg);
    };
}

/// Worst distance [m] from the net to exact places of posts all over the piece, at a height.
double worst_error_m(const PostPlace& place, const geo::LocalFrame& frame, double side,
                     double height_m) {
    const PatchNet net = fit_patch_net(place, frame, {0, 0}, glm::dvec2(side));
    double worst = 0;
    for (int j = 0; j <= 32; ++j) {
        for (int i = 0; i <= 32; ++i) {
            const double u = i / 32.0, v = j / 32.0;
            geo::Geodetic exact = place(u * side, v * side);
            exact.height_m = height_m;
            worst = std::max(worst, distance(net.place(u, v, height_m), frame.to_local(exact)));
        }
    }
    return worst;
}

TEST(PatchNet, PlacesPostsWithinAHundredthOfTheirSpacing) {
    struct Case {
        const char* name;
        double lat_deg, spacing_deg;
        double posts;
    };
    for (const Case& c : {Case{"1 arcsec, 64 posts", 47, 1 / 3600.0, 64},
                          Case{"1 arcsec, 256 posts", 47, 1 / 3600.0, 256},
                          Case{"3 arcsec, 256 posts", 56, 1 / 1200.0, 256},
                          Case{"3 arcsec, 256 posts, 80 north", 80, 1 / 1200.0, 256},
                          Case{"30 arcsec, 64 posts", 30, 1 / 120.0, 64},
                          Case{"2 arcmin, 64 posts", 20, 1 / 30.0, 64}}) {
        const PostPlace place = degrees_grid(c.lat_deg, 11, c.spacing_deg);
        const double half = c.posts / 2 * c.spacing_deg;
        const geo::LocalFrame frame(geo::geodetic_deg(c.lat_deg - half, 11 + half));
        // Posts are nearest to each other along the parallel.
        const double spacing_m = 111e3 * c.spacing_deg * std::cos(radians(c.lat_deg));
        const double worst = worst_error_m(place, frame, c.posts, 4000);
        fmt::print("[ accuracy ] position net, {}: worst {:.3g} m, {:.2g} of the post spacing\n",
                   c.name, worst, worst / spacing_m);
        EXPECT_LT(worst, spacing_m / 100) << c.name;
    }
}

TEST(PatchNet, NeighboursAgreeAlongTheirSharedSide) {
    const PostPlace place = degrees_grid(56, -5, 1 / 1200.0);
    const geo::LocalFrame frame(geo::geodetic_deg(55.5, -4.5));
    const PatchNet west = fit_patch_net(place, frame, {0, 0}, glm::dvec2(64));
    const PatchNet east = fit_patch_net(place, frame, {64, 0}, glm::dvec2(64));
    for (double v = 0; v <= 1; v += 0.125)
        EXPECT_LT(distance(west.place(1, v, 0), east.place(0, v, 0)), 1e-6);
}

TEST(PatchNet, FollowsTheCurveOfTheEarth) {
    // 200 km east of the origin the ellipsoid has dropped by about d^2 / 2R.
    const PostPlace place = degrees_grid(46, 10, 1 / 1200.0);
    const geo::LocalFrame frame(geo::geodetic_deg(46, 10));
    const PatchNet net = fit_patch_net(place, frame, {3000, 0}, glm::dvec2(256));
    const glm::dvec3 at = net.place(0, 0, 0);
    const double drop_m = at.x * at.x / 2 / 6388000;  // radius of the prime vertical at 46 N
    EXPECT_NEAR(at.z, -drop_m, 5);
    EXPECT_NEAR(at.z, frame.to_local(place(3000, 0)).z, 1);
}

}  // namespace
}  // namespace relevo::render

#include "geo/local_frame.h"

#include <vector>

#include <GeographicLib/LocalCartesian.hpp>

#include "base/units.h"

namespace relevo::geo {

struct LocalFrame::Impl {
    GeographicLib::LocalCartesian cartesian;
};

LocalFrame::LocalFrame(const Geodetic& origin)
    : origin_(origin),
      impl_(std::make_unique<Impl>(Impl{GeographicLib::LocalCartesian(
          degrees(origin.lat_rad), degrees(origin.lon_rad), origin.height_m)})) {}

LocalFrame::LocalFrame(const LocalFrame& other)
    : origin_(other.origin_), impl_(std::make_unique<Impl>(*other.impl_)) {}
LocalFrame::LocalFrame(LocalFrame&&) noexcept = default;
LocalFrame& LocalFrame::operator=(LocalFrame&&) noexcept = default;
LocalFrame::~LocalFrame() = default;

LocalFrame& LocalFrame::operator=(const LocalFrame& other) {
    if (this != &other) *this = LocalFrame(other);
    return *this;
}

glm::dvec3 LocalFrame::to_local(const Geodetic& place) const {
    glm::dvec3 local{};
    impl_->cartesian.Forward(degrees(place.lat_rad), degrees(place.lon_rad), place.height_m,
                             local.x, local.y, local.z);
    return local;
}

Geodetic LocalFrame::to_geodetic(const glm::dvec3& local_m) const {
    double lat_deg = 0;
    double lon_deg = 0;
    double height_m = 0;
    impl_->cartesian.Reverse(local_m.x, local_m.y, local_m.z, lat_deg, lon_deg, height_m);
    return geodetic_deg(lat_deg, lon_deg, height_m);
}

glm::dvec3 LocalFrame::up(double lat_rad, double lon_rad) const {
    return axes(lat_rad, lon_rad).up;
}

Axes LocalFrame::axes(double lat_rad, double lon_rad) const {
    // GeographicLib's matrix turns a vector in the east, north, up of the place into this frame;
    // row-major, so its columns are those three.
    thread_local std::vector<double> m(9);
    double x = 0;
    double y = 0;
    double z = 0;
    impl_->cartesian.Forward(degrees(lat_rad), degrees(lon_rad), 0, x, y, z, m);
    return {{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}};
}

}  // namespace relevo::geo

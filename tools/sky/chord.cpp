#include "chord.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "sky/air.h"

namespace relevo::skymaker {

using sky::kEarthRadius_m;

Columns& Columns::operator+=(const Columns& other) {
    rayleigh_m += other.rayleigh_m;
    aerosol_m += other.aerosol_m;
    ozone_m += other.ozone_m;
    return *this;
}

Chord::Chord(const glm::dvec3& from, const glm::dvec3& direction) {
    radius_ = glm::length(from);
    sine_ = glm::dot(from, direction) / radius_;
    excess_ = (radius_ - kEarthRadius_m) * (radius_ + kEarthRadius_m);
    constexpr double kTop = kEarthRadius_m + sky::kTopOfAir_m;
    const double along = -radius_ * sine_;  // distance to the point nearest to the Earth's centre
    const double miss2 = radius_ * radius_ * (1 - sine_ * sine_);
    if (miss2 >= kTop * kTop) return;
    const double half = std::sqrt(kTop * kTop - miss2);
    if (along + half <= 0) return;
    ground_ = sine_ < 0 && miss2 < kEarthRadius_m * kEarthRadius_m;
    // Not along - sqrt(...), which would lose the digits of a small height.
    const double to_ground =
        ground_ ? excess_ / (along + std::sqrt(along * along - excess_)) : along + half;
    divide(std::max(0.0, along - half), std::max(0.0, to_ground));
}

void Chord::divide(double begin, double end) {
    const double lowest = std::clamp(-radius_ * sine_, begin, end);
    const double down = std::sqrt(lowest - begin), up = std::sqrt(end - lowest);
    int before = 0;
    if (down > 0 && up > 0)
        before =
            std::clamp(static_cast<int>(std::lround(kCells * down / (down + up))), 2, kCells - 2);
    else if (down > 0)
        before = kCells;
    for (int i = 0; i <= kCells; ++i) {
        const double x = i < before    ? static_cast<double>(before - i) / before
                         : i == before ? 0.0
                                       : static_cast<double>(i - before) / (kCells - before);
        ends_[static_cast<std::size_t>(i)] =
            i < before ? lowest - down * down * x * x : lowest + up * up * x * x;
    }
}

double Chord::height_m(double distance) const {
    const double more = excess_ + distance * (distance + 2 * radius_ * sine_);
    return std::max(0.0,
                    more / (std::sqrt(kEarthRadius_m * kEarthRadius_m + more) + kEarthRadius_m));
}

Columns Chord::columns(double from, double to) const {
    constexpr double kPlace = 0.7745966692414834;  // sqrt(3 / 5)
    const double centre = 0.5 * (from + to), half = 0.5 * (to - from);
    Columns sum;
    const auto add = [&](double at, double weight) {
        const double h = height_m(at);
        sum.rayleigh_m += weight * sky::rayleigh_density(h);
        sum.aerosol_m += weight * sky::aerosol_density(h);
        sum.ozone_m += weight * sky::ozone_density(h);
    };
    add(centre - kPlace * half, half * 5 / 9);
    add(centre, half * 8 / 9);
    add(centre + kPlace * half, half * 5 / 9);
    return sum;
}

Columns Chord::columns() const {
    Columns sum;
    for (std::size_t i = 0; i < kCells; ++i)
        sum += columns(ends_[i], ends_[i + 1]);
    return sum;
}

}  // namespace relevo::skymaker

#pragma once

#include <array>

#include <glm/vec3.hpp>

/// A straight line through the air of a spherical Earth, from a point to the ground or to space.
namespace relevo::skymaker {

/// Air along a line, as the length of it at full density.
struct Columns {
    double rayleigh_m = 0, aerosol_m = 0, ozone_m = 0;
    Columns& operator+=(const Columns& other);
};

class Chord {
  public:
    /// @param from       in or above the air; the Earth's centre is the origin [m]
    /// @param direction  of length 1
    Chord(const glm::dvec3& from, const glm::dvec3& direction);

    static constexpr int kCells = 40;
    /// Distances that divide the line, finer where it is lowest. From above the air the first is
    /// where the air begins. All are 0 if the line misses it.
    const std::array<double, kCells + 1>& ends() const { return ends_; }
    bool meets_ground() const { return ground_; }

    double height_m(double distance_m) const;
    /// Within one cell. Gauss's rule with three points: 1e-5 of the column.
    Columns columns(double from_m, double to_m) const;
    /// From the first end to the last.
    Columns columns() const;

  private:
    void divide(double begin, double end);

    std::array<double, kCells + 1> ends_{};
    double radius_ = 0, sine_ = 0, excess_ = 0;  // excess: radius^2 - Earth's^2
    bool ground_ = false;
};

}  // namespace relevo::skymaker

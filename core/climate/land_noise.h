#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

namespace relevo::climate {

/// Noise by place: values at the corners of a cubic lattice through the globe, and between them.
/// There is no seam, and a place has the same one in every DEM.
class LandNoise {
  public:
    /// @param largest_m  cells of the first octave; each further one has half
    /// @param least_m    of the last one, no more than nine
    LandNoise(double largest_m, double least_m, std::uint32_t seed);

    /// Mean 0, standard deviation about 1; 0 without octaves. For places one after the other.
    /// @param place_m  from the Earth's centre
    float at(const glm::dvec3& place_m);

  private:
    struct Octave {
        double per_m = 0;
        float weight = 1;
        std::uint32_t seed = 0;
        std::array<std::int64_t, 3> cell{};  // the last one, and its corners' values
        std::array<float, 8> corners{};
        bool has_cell = false;
    };

    static float value(Octave& octave, const glm::dvec3& place_m);

    std::array<Octave, 9> octaves_;
    int count_ = 0;
    float scale_ = 0;
};

}  // namespace relevo::climate

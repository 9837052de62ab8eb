#pragma once

#include <array>
#include <vector>

#include "light/sweep/ground_rows.h"
#include "light/sweep/lines.h"

namespace relevo::light {

/// Finds the horizon of posts of lines next to each other, row by row away from where they look.
///
/// Each line carries a fan of rays over the ground that it has passed, some degrees apart; of each
/// ray it knows the ground that it grazes. The horizon of a post is the ground that the steepest
/// ray over it grazes, of the line nearest to it: a mean of two lines would be no ground at all.
/// Heights are less what the ground has sunk by below the tangent plane of the ray's reference.
class HorizonStrip {
  public:
    static constexpr Sampling kSampling{.near_rows = 8, .line_sets = 1, .distances = true};
    static constexpr int kMostLines = 63;  ///< a fan is 58 numbers

    /// @param lines          of a sun whose tangent is 1 everywhere: what they fall by is how far
    ///     they go
    /// @param curvature      of the ground under a line of sight [1/m]
    /// @param least_tangent  rays below this tangent are ignored; minus infinity: none are
    HorizonStrip(const SweepLines& lines, int line, int count, double curvature,
                 double least_tangent);

    void advance_to(int row, const Sheet& sheet);    ///< as ShadowStrip
    const float* find(int row, int first, int end);  ///< as ShadowStrip, but tangents

  private:
    static constexpr float kFarther_m = 1e9F;  // than any ground
    static constexpr std::ptrdiff_t kPitch = in_vectors(kMostLines + 1) + kVectorFloats;

    double distance_m(int row) const { return lines_.row(row).fall_m; }
    Fans fans();
    void raise(int row);
    void look_at_near_ground(int row, int first, int end, const float* eyes_m);

    const SweepLines& lines_;
    double curvature_;
    int line_, count_;
    double least_tangent_;
    GroundRows ground_;
    std::array<float, kFanRays> tangents_;
    std::vector<float> height_m_, distance_m_;  // of the fans
    std::vector<float> tangent_;
};

}  // namespace relevo::light

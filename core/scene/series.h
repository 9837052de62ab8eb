#pragma once

#include <cstddef>
#include <vector>

/// Numbers along a path, and what makes them smooth. Pure.
namespace relevo::scene {

/// Where a motion is at a share of its time: 0 at 0, 1 at 1. The speed rises from zero over the
/// first fifth and falls to zero over the last, without a step in acceleration.
/// @param share  0 to 1
double eased(double share);

/// The mean speed of an eased motion, of its highest.
inline constexpr double kEasedMeanSpeed = 0.8;

/// What lies beyond the ends of a series.
enum class Ends {
    Mirrored,  ///< the series reflected at its end points, which stay where they are
    Held,      ///< the end values
    Cyclic,    ///< the series again
};

/// Weighted means of the values up to `radius` away: three running means in turn, which leave no
/// step in the second derivative. A constant stays.
std::vector<double> smoothed(const std::vector<double>& values, std::size_t radius, Ends ends);

/// The highest of the values up to `radius` away.
std::vector<double> running_max(const std::vector<double>& values, std::size_t radius, Ends ends);

/// A smooth series that is nowhere lower: every mean in smoothed() is one of maxima that have the
/// value itself among theirs.
std::vector<double> smooth_above(const std::vector<double>& values, std::size_t radius, Ends ends);

/// The same angles without jumps of a turn between neighbours [rad].
std::vector<double> unwrapped(std::vector<double> angles_rad);

/// Smooths a series as little as it takes for its steps to be at most `most_step`. A series whose
/// ends are farther apart than such steps lead becomes as even as it gets.
std::vector<double> with_steps_up_to(const std::vector<double>& values, double most_step);

/// The values that are not NaN; others are interpolated between their neighbours, or held from the
/// nearest. All NaN stay so.
std::vector<double> without_gaps(std::vector<double> values);

}  // namespace relevo::scene

#include "scene/series.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "base/units.h"

namespace relevo::scene {
namespace {

/// The value at any index, also beyond the ends.
double value_at(const std::vector<double>& values, std::ptrdiff_t i, Ends ends) {
    const auto size = static_cast<std::ptrdiff_t>(values.size());
    const auto at = [&](std::ptrdiff_t index) { return values[static_cast<std::size_t>(index)]; };
    if (i >= 0 && i < size) return at(i);
    if (ends == Ends::Cyclic) return at((i % size + size) % size);
    const std::ptrdiff_t end = i < 0 ? 0 : size - 1;
    if (ends == Ends::Held) return at(end);
    const std::ptrdiff_t mirrored = std::clamp<std::ptrdiff_t>(2 * end - i, 0, size - 1);
    return 2 * at(end) - at(mirrored);
}

/// Means of 2 radius + 1 values.
std::vector<double> running_mean(const std::vector<double>& values, std::size_t radius, Ends ends) {
    const auto reach = static_cast<std::ptrdiff_t>(radius);
    std::vector<double> result(values.size());
    double sum = 0;
    for (std::ptrdiff_t i = -reach; i < reach; ++i)
        sum += value_at(values, i, ends);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto here = static_cast<std::ptrdiff_t>(i);
        sum += value_at(values, here + reach, ends);
        result[i] = sum / static_cast<double>(2 * reach + 1);
        sum -= value_at(values, here - reach, ends);
    }
    return result;
}

}  // namespace

double eased(double share) {
    constexpr double kRamp = 0.2;
    // The integral of the speed, which rises as 3 x^2 - 2 x^3.
    const auto begun = [](double x) { return kRamp * (x * x * x - x * x * x * x / 2); };
    constexpr double kWhole = 1 - kRamp;
    if (share < kRamp) return begun(share / kRamp) / kWhole;
    if (share > 1 - kRamp) return 1 - begun((1 - share) / kRamp) / kWhole;
    return (share - kRamp / 2) / kWhole;
}

std::vector<double> smoothed(const std::vector<double>& values, std::size_t radius, Ends ends) {
    if (values.size() < 2 || radius == 0) return values;
    // Three radii that add up to no more than `radius`.
    std::vector<double> result = values;
    for (std::size_t part = 0; part < 3; ++part)
        if (const std::size_t own = (radius + part) / 3; own > 0)
            result = running_mean(result, own, ends);
    return result;
}

std::vector<double> running_max(const std::vector<double>& values, std::size_t radius, Ends ends) {
    const auto size = static_cast<std::ptrdiff_t>(values.size());
    const auto reach = static_cast<std::ptrdiff_t>(radius);
    std::vector<double> result(values.size());
    std::deque<std::ptrdiff_t> falling;  // indices of ever lower values
    for (std::ptrdiff_t i = -reach; i < size + reach; ++i) {
        const double value = value_at(values, i, ends);
        while (!falling.empty() && value_at(values, falling.back(), ends) <= value)
            falling.pop_back();
        falling.push_back(i);
        const std::ptrdiff_t middle = i - reach;
        if (middle < 0) continue;
        while (falling.front() < middle - reach)
            falling.pop_front();
        result[static_cast<std::size_t>(middle)] = value_at(values, falling.front(), ends);
    }
    return result;
}

std::vector<double> smooth_above(const std::vector<double>& values, std::size_t radius, Ends ends) {
    return smoothed(running_max(values, radius, ends), radius, ends);
}

std::vector<double> unwrapped(std::vector<double> angles_rad) {
    for (std::size_t i = 1; i < angles_rad.size(); ++i)
        angles_rad[i] -= 2 * kPi * std::round((angles_rad[i] - angles_rad[i - 1]) / (2 * kPi));
    return angles_rad;
}

std::vector<double> with_steps_up_to(const std::vector<double>& values, double most_step) {
    std::vector<double> result = values;
    const auto is_even = [&] {
        for (std::size_t i = 1; i < result.size(); ++i)
            if (std::abs(result[i] - result[i - 1]) > most_step) return false;
        return true;
    };
    for (std::size_t radius = 3; !is_even() && radius < 2 * values.size(); radius += radius / 3)
        result = smoothed(values, radius, Ends::Mirrored);
    return result;
}

std::vector<double> without_gaps(std::vector<double> values) {
    const std::size_t size = values.size();
    std::size_t known = size;  // the last index with a value
    for (std::size_t i = 0; i < size; ++i) {
        if (std::isnan(values[i])) continue;
        for (std::size_t gap = known == size ? 0 : known + 1; gap < i; ++gap) {
            const double share =
                known == size ? 1
                              : static_cast<double>(gap - known) / static_cast<double>(i - known);
            values[gap] =
                known == size ? values[i] : values[known] + share * (values[i] - values[known]);
        }
        known = i;
    }
    if (known == size) return values;
    for (std::size_t i = known + 1; i < size; ++i)
        values[i] = values[known];
    return values;
}

}  // namespace relevo::scene

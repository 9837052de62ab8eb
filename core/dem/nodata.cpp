#include "dem/nodata.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace relevo::dem {
namespace {

constexpr std::array kCandidates = {-32768.0,  -32767.0, -9999.0, -99999.0,
                                    -999999.0, 32767.0,  65535.0, 0.0};
constexpr double kAlone = 500;  // stored numbers
constexpr double kAboveZero_m = 100;
constexpr std::int64_t kFewest = 16;  // heights beside the holes that make a rule

}  // namespace

double no_height_beyond(double metres) {
    return 1e7 / std::abs(metres);
}

Undeclared find_undeclared(std::span<const double> stored, double metres) {
    struct Candidate {
        std::int64_t count = 0;
        double nearest = std::numeric_limits<double>::infinity();  // of the others
    };
    std::array<Candidate, kCandidates.size()> candidates;
    // Heights that are none pass quickly: all candidates but 0 are far from it.
    const auto is_candidate = [](double value) {
        return value == 0 || (std::abs(value) >= 9999 &&
                              std::ranges::find(kCandidates, value) != kCandidates.end());
    };
    bool any = false;
    Undeclared found;
    const double beyond = no_height_beyond(metres);
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    std::int64_t heights = 0;
    for (const double value : stored) {
        if (!std::isfinite(value)) continue;
        if (std::abs(value) > beyond) {
            found.beyond = true;
            continue;
        }
        ++heights;
        any = any || is_candidate(value);
        if (value != 0) {
            lowest = value < lowest ? value : lowest;
            highest = value > highest ? value : highest;
        }
    }
    if (!any) return found;
    for (const double value : stored) {
        if (!std::isfinite(value) || std::abs(value) > beyond) continue;
        for (std::size_t i = 0; i < kCandidates.size(); ++i) {
            const double away = std::abs(value - kCandidates[i]);
            if (away == 0)
                ++candidates[i].count;
            else if (away < candidates[i].nearest)
                candidates[i].nearest = away;
        }
    }
    for (std::size_t i = 0; i < kCandidates.size() && !found.nodata; ++i) {
        const Candidate& candidate = candidates[i];
        if (candidate.count == 0 || heights - candidate.count < kFewest) continue;
        const bool zero = kCandidates[i] == 0;
        const bool one_side = lowest > 0 || highest < 0;
        if (zero ? one_side && candidate.nearest * std::abs(metres) >= kAboveZero_m
                 : candidate.nearest > kAlone)
            found.nodata = kCandidates[i];
    }
    return found;
}

}  // namespace relevo::dem

#pragma once

#include <functional>
#include <vector>

#include "sun/events.h"

// The search for events. Inside of the layer only.

namespace relevo::sun {

/// The moments at which a threshold is crossed, and the time above it.
struct Crossings {
    std::vector<double> rising_s, setting_s;  ///< since the span's begin
    std::vector<TimeSpan> above;
    Crossing state = Crossing::Crosses;
};

/// The way of the table's body over the sky of one place within one span of time.
class SkyPath {
  public:
    /// All three outlive this.
    SkyPath(const PositionTable& table, const TimeSpan& span, const Observer& observer);

    /// @param threshold_rad  of a distance in au
    Crossings crossings(const std::function<double(double)>& threshold_rad) const;
    Crossings crossings(double threshold_rad) const {
        return crossings([threshold_rad](double) { return threshold_rad; });
    }

    void add_transits(std::vector<Event>& events) const;
    void add(std::vector<Event>& events, EventKind rising, EventKind setting,
             const Crossings& crossings) const;

  private:
    struct Sample {
        double t_s, elevation_rad, east_au, distance_au;
    };
    Sample sample(double t_s) const;
    void add(std::vector<Event>& events, EventKind kind, double t_s) const;

    const PositionTable& table_;
    const TimeSpan& span_;
    const Observer& observer_;
    std::vector<Sample> samples_, extremes_;
    std::vector<Sample>
        at_ends_;  // extremes in the first or last step; crossings() takes them as it needs
};

}  // namespace relevo::sun

#pragma once

#include <cstddef>

namespace relevo::figure {

/// Measures how long rasters take while parts of them are made. Each part gets ready, and then
/// goes on in steps: what it takes to get ready is not multiplied by the steps.
class SampledTime {
  public:
    /// @param share  of all posts
    void begin_part(double share, double now_s);
    /// A step has ended, the first of a part perhaps with nothing done yet.
    /// @param share  of all work
    void end_step(double share, double now_s);
    /// Whether the steps so far say how long all take.
    bool suffices() const;
    double all_s() const;

  private:
    bool is_first_ = true;  // step of its part
    double last_s_ = 0;
    double parts_share_ = 0, ready_s_ = 0, ready_share_ = 0;  // of first steps
    double steps_share_ = 0, steps_s_ = 0;                    // of the others
};

/// What making rasters takes, as a small part of them tells.
struct RasterEstimate {
    double posts = 0;        ///< of the rasters
    std::size_t parts = 0;   ///< in which they are made
    double memory_mib = 0;   ///< of all
    double heights_mib = 0;  ///< of these, heights
    double ready_s = 0;      ///< until the work proper begins
    double computing_s = 0;  ///< all of it
    double sampled_share = 0, sampled_s = 0;
    int threads = 1;  ///< on which
    std::size_t bands = 1;
    double result_bytes = 0;  ///< before compression
};

}  // namespace relevo::figure

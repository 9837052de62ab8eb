#pragma once

namespace relevo::log {

/// Holds notices (log::info) back while it lives, and then writes the first and the number of the
/// others as one line: a run has one line of assumptions, `-v` has all of them. Warnings and errors
/// are written at once.
///
/// One at a time. With -v it does nothing.
class HeldNotices {
  public:
    HeldNotices();
    ~HeldNotices();
    HeldNotices(const HeldNotices&) = delete;
    HeldNotices& operator=(const HeldNotices&) = delete;

    /// Writes what was held; notices are written at once from now on.
    void release();
};

}  // namespace relevo::log

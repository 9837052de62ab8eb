#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "viewer/window_words.h"

namespace relevo::viewer {

/// Calls `act`. Logs an Error that it throws.
template <typename Act>
void try_or_log(const Act& act) {
    try {
        act();
    } catch (const Error& error) {
        log::warning(error.what());
    }
}

/// The message at the window's upper edge. Notes expire; other messages stay until the user closes
/// them.
class Messages {
  public:
    static constexpr std::chrono::seconds kNote{8}, kShortNote{3};

    /// @param shown  the text that panels draw; outlives this
    explicit Messages(std::string& shown) : shown_(shown) {}

    /// @param text  as on the command line; window_words() are shown
    void show(std::string_view text) { shown_ = window_words(text); }
    /// Shows a text for some seconds.
    void note(std::string text, std::chrono::seconds lasts = kNote);
    /// Shows a text for some seconds and logs it.
    void report(std::string text);
    /// Calls `act`. Shows and logs an Error that it throws.
    template <typename Act>
    void try_to(const Act& act) {
        try {
            act();
        } catch (const Error& error) {
            show(error.what());
            log::warning(error.what());
        }
    }
    /// Removes an expired note. @returns whether the shown text changed
    bool expire();

  private:
    std::string& shown_;
    std::string note_;
    std::chrono::steady_clock::time_point until_;
};

}  // namespace relevo::viewer

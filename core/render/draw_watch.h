#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/fatal_signals.h"
#include "base/watchdog.h"
#include "render/programs.h"

namespace relevo::render {

/// Ends the process if a driver hangs in compiling or drawing, for example in an endless loop of a
/// plugin. A hanging driver cannot be stopped otherwise. The message names the plugins, also if the
/// driver crashes.
class DrawWatch {
  public:
    /// @param snippets  of the enabled plugins; must outlive this
    explicit DrawWatch(const std::vector<const shader::Snippet*>& snippets) : snippets_(snippets) {}

    /// A period in which the device must finish within patience(), or longer for large draws. Wait
    /// for the device before destroying it.
    class Turn {
      public:
        /// @param parts  number of pixels and triangles
        Turn(DrawWatch& watch, const ProgramText& program, double parts);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        DrawWatch& watch_;
        std::optional<FatalSignalGuard> guard_;
    };

  private:
    /// The effects in a program that are not bundled with Relevo.
    std::set<std::string> foreign(const shader::Stitched& stitched) const;
    std::string blame(const shader::Stitched& stitched) const;

    std::vector<const shader::Snippet*> snippets_;
    Watchdog watchdog_;
};

}  // namespace relevo::render

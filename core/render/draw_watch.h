#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/fatal_signals.h"
#include "base/watchdog.h"
#include "render/programs.h"

namespace relevo::render {

/// Ends the program where a driver compiles or draws for ever, which nothing else can stop (a loop
/// without an end in a plugin's GLSL), and says whose GLSL it was where a driver ends the program.
class DrawWatch {
  public:
    /// @param snippets  of the enabled plugins; must outlive this
    explicit DrawWatch(const std::vector<const shader::Snippet*>& snippets) : snippets_(snippets) {}

    /// While this lives the device may take patience(), or as long as a slow one takes for work of
    /// that size where that is longer. At its end the device has to have finished.
    class Turn {
      public:
        /// @param parts  pixels and triangles
        Turn(DrawWatch& watch, const ProgramText& program, double parts);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        DrawWatch& watch_;
        std::optional<FatalSignalGuard> guard_;
    };

  private:
    /// Of the effects in a program those that did not come with Relevo, where they have been tried.
    std::set<std::string> foreign(const shader::Stitched& stitched) const;
    std::string blame(const shader::Stitched& stitched) const;

    std::vector<const shader::Snippet*> snippets_;
    Watchdog watchdog_;
};

}  // namespace relevo::render

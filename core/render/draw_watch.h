#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/fatal_signals.h"
#include "base/watchdog.h"
#include "render/programs.h"

namespace relevo::render {

/// Ends the program if a driver compiles or draws without end, for example a loop in a plugin's
/// GLSL: nothing else can stop it. If the driver crashes, the message names the plugins too.
class DrawWatch {
  public:
    /// @param snippets  of the enabled plugins; must outlive this
    explicit DrawWatch(const std::vector<const shader::Snippet*>& snippets) : snippets_(snippets) {}

    /// While this lives the device may take patience(), or longer for much work. The caller waits
    /// for the device before this ends.
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
    /// The effects in a program that Relevo does not ship.
    std::set<std::string> foreign(const shader::Stitched& stitched) const;
    std::string blame(const shader::Stitched& stitched) const;

    std::vector<const shader::Snippet*> snippets_;
    Watchdog watchdog_;
};

}  // namespace relevo::render

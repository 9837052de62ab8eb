#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/watchdog.h"
#include "render/programs.h"

namespace relevo::render {

/// Ends the program where a driver compiles or draws for ever, which nothing else can stop: a loop
/// without an end in a plugin's GLSL.
class DrawWatch {
  public:
    /// @param snippets  of the enabled plugins; must outlive this
    explicit DrawWatch(const std::vector<const shader::Snippet*>& snippets) : snippets_(snippets) {}

    /// While this lives the device may take patience(), or as long as a slow one takes for work of
    /// that size where that is longer. At its end the device has to have finished.
    class Turn {
      public:
        /// @param watch  nothing: nobody watches
        /// @param parts  pixels and triangles
        Turn(std::optional<DrawWatch>& watch, const ProgramText& program, double parts);
        ~Turn();
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

      private:
        DrawWatch* watch_;
    };

  private:
    std::string blame(const shader::Stitched& stitched) const;

    std::vector<const shader::Snippet*> snippets_;
    Watchdog watchdog_;
};

}  // namespace relevo::render

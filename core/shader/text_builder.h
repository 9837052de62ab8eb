#pragma once

#include <string>
#include <string_view>

#include "shader/source.h"
#include "shader/stitch.h"

namespace relevo::shader {

/// Writes a stage's text line by line, and its line map beside it.
class TextBuilder {
  public:
    /// A line of the stitcher's own.
    void line(std::string_view text) { line(text, {}); }
    void line(std::string_view text, LineOrigin origin);
    /// An empty line and a heading; written only if a line follows.
    void heading(std::string_view text) { heading_ = text; }
    /// A piece of a file as it stands, in its own columns, and behind an empty line where it stands
    /// so in its file.
    void item(const Source& source, const Item& item);

    StageText take() { return std::move(stage_); }

  private:
    StageText stage_;
    std::string heading_;
};

}  // namespace relevo::shader

#pragma once

#include <string>
#include <string_view>

#include "shader/source.h"
#include "shader/stitch.h"

namespace relevo::shader {

/// Writes a stage's text and its line map.
class TextBuilder {
  public:
    /// A line of the stitcher.
    void line(std::string_view text) { line(text, {}); }
    void line(std::string_view text, LineOrigin origin);
    /// An empty line and a heading; written only if a line follows.
    void heading(std::string_view text) { heading_ = text; }
    /// An unchanged part of a file, at its columns, after an empty line if it has one there.
    void item(const Source& source, const Item& item);

    StageText take() { return std::move(stage_); }

  private:
    StageText stage_;
    std::string heading_;
};

}  // namespace relevo::shader

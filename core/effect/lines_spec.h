#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "json/object_reader.h"
#include "shader/param_store.h"

namespace relevo::effect {

/// A texture of kind `lines`: a vector file that a text of the plugin names.
struct LinesSpec {
    std::string name;       ///< "way"
    std::string resource;   ///< "tracks.way": its name for the stitcher
    std::string file;       ///< "tracks.file": address of the text with the file's path
    std::string attribute;  ///< a field's name, or the plugin's text "by" with it; may be empty
    int line = 0;           ///< in plugin.json
};

/// Whether an entry of "textures" is of kind `lines`.
bool is_lines(const json::Value& texture);

/// Reads such an entry.
/// @param file, id  of the manifest and of the plugin
/// @throws Error (BadInput) with file and line
LinesSpec read_lines_spec(const std::string& file, const std::string& id, const std::string& name,
                          const json::Value& value);

/// Checks that a spec's file is a text of kind `file`.
/// @param file, id  as above
/// @throws Error (BadInput) with file and line
void check_lines_spec(const std::string& file, const std::string& id, const LinesSpec& spec,
                      const std::vector<shader::TextParam>& texts);

}  // namespace relevo::effect

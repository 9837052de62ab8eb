#pragma once

#include <string_view>

namespace relevo::dem {

/// Whether a name is one of the net or of standard input: "https://...", "/vsis3/...", "WMTS:...".
/// To open it gives the net to the whole process, so it has to be a person's, not a file's.
bool is_remote(std::string_view name);

/// Whether a name begins as that of a GDAL file system over files of this machine: "/vsizip/...".
bool is_local_file_system(std::string_view name);

}  // namespace relevo::dem

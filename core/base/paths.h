#pragma once

#include <filesystem>
#include <optional>

namespace relevo {

/// Where the read-only files are: `../share/relevo` as seen from the program, or from the library
/// where another program has loaded that (also from `lib/x86_64-linux-gnu`), in a build tree and in
/// an installation alike. `$RELEVO_SHARE` overrides it.
/// Holds `data/`, `plugins/` and `shaders/`.
std::filesystem::path share_dir();

/// Where the program's loadable modules are: `../lib/relevo` as seen from there.
std::filesystem::path module_dir();

/// A folder of the user by the XDG base directory specification, which ignores relative paths: the
/// value of `variable` ("XDG_CACHE_HOME"), else `below_home` (".cache") in $HOME; empty without
/// either.
std::filesystem::path user_folder(const char* variable, const char* below_home);

/// The file `name` of a folder; nothing where that is outside it, by `..`, by an absolute name or
/// by a symbolic link. Whether the file is there does not matter.
std::optional<std::filesystem::path> file_inside(const std::filesystem::path& folder,
                                                 const std::filesystem::path& name);

}  // namespace relevo

#pragma once

#include <filesystem>
#include <string>

namespace relevo {

/// Where a path leads, its symbolic links followed one by one: what others change meanwhile makes
/// no difference to it.
struct LinkWalk {
    int folder = -1;   ///< open (O_PATH); the caller closes it. -1: the path leads nowhere
    std::string leaf;  ///< the name there, which is no link and need not exist
    int error = 0;     ///< as errno says why it leads nowhere
    /// Instead of an error: the link that was not followed, as another user has made it in a folder
    /// that others can write to, and it may lead to what is ours alone. The kernel's own rule,
    /// fs.protected_symlinks, is for sticky folders only, and may be off.
    std::filesystem::path foreign_link;
};

LinkWalk walk_links(const std::filesystem::path& path);

}  // namespace relevo

#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace relevo::session {

/// What the user has named, on the command line or by opening it.
struct Named {
    bool all = false;  ///< --trust: whatever files name is used
    std::vector<std::string> plugin_folders;
};

/// Whose names a scene has besides those of the user.
enum class NamedBy {
    File,     ///< a scene or a job
    Picture,  ///< the record in one, which may come from anybody
};

/// What a scene, a job or a picture names is used like what the user names, but for two kinds:
/// plugin folders, whose code would run, and names that are not of this machine (AllowedName).
/// Those are used where the user has named the same or trusts all. Native modules of a folder that
/// only a picture names are never loaded.
class Trust {
  public:
    /// @param file   as messages name it: "scene: view.json"
    Trust(Named given, std::string file, NamedBy by);

    /// Names in settings of effects are refused where they are opened: only an effect knows which
    /// are of files.
    /// @throws Error (Usage) for a name that may not be opened
    void check_names(const scene::Scene& scene) const;
    /// Keeps of a scene's plugin folders those that are used, each once.
    void keep_folders(scene::Effects& effects);
    /// Of the folders that were skipped, in a line for each kind.
    std::vector<std::string> warnings() const;
    /// Logs them.
    void tell() const;

  private:
    enum class Folder { Named, Allowed, LeftOut };
    struct Known {
        std::string path;  ///< absolute
        Folder kind;
        std::vector<std::string> folders;  ///< what is used of it
    };
    const Known& folder(const std::string& name);
    std::vector<std::string> without_modules(const std::string& folder);

    Named given_;
    std::string file_;
    NamedBy by_;
    std::vector<std::string> named_;      ///< by the command line and the user's own
    std::map<std::string, Known> known_;  ///< by the name in a scene
    std::vector<std::string> left_out_;   ///< folders, absolute
    std::vector<std::string> modules_;    ///< folders of plugins whose modules are not loaded
};

}  // namespace relevo::session

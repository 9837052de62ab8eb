#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "effect/effect.h"

namespace relevo::effect {

/// A folder of a plugin that could not be loaded.
struct BrokenEffect {
    std::string id;  ///< the folder's name if the manifest has none
    std::filesystem::path folder;
    std::string error;  ///< the whole message
};

/// All plugins. The selection has those that are on.
class Registry {
  public:
    /// Reads every plugin below the search paths: a folder with a plugin.json, or a folder of such
    /// folders. A broken plugin does not affect the others. Of two with the same id the first is
    /// used, and the second is broken. A folder that two search paths have is read once.
    /// @param data_dir  where `data:` files are
    /// @throws Error (BadInput) only for a search path that is no folder
    static Registry load(const std::vector<std::filesystem::path>& search_paths,
                         const std::filesystem::path& data_dir);
    /// Reads the plugins of plugin_search_path(extra). @throws Error as that, and as load()
    static Registry load_installed(const std::vector<std::filesystem::path>& extra = {});

    const std::vector<Effect>& effects() const { return effects_; }  ///< by id
    const std::vector<BrokenEffect>& broken() const { return broken_; }
    /// Where plugins were looked for.
    const std::vector<std::filesystem::path>& search_paths() const { return search_paths_; }

    const Effect* find(std::string_view id) const;  ///< or null
    bool is_broken(std::string_view id) const;      ///< found, but could not be loaded
    /// @throws Error (BadInput) `who: id: ...` with the nearest id, or why that plugin is broken
    const Effect& effect(std::string_view id, std::string_view who) const;
    std::vector<shader::Param> params() const;     ///< of all effects, for ParamStore::declare
    std::vector<shader::TextParam> texts() const;  ///< of all effects, too
    /// The capability words that plugins provide, sorted.
    std::vector<std::string> provided_words() const;

  private:
    std::vector<Effect> effects_;
    std::vector<BrokenEffect> broken_;
    std::vector<std::filesystem::path> search_paths_;
};

}  // namespace relevo::effect

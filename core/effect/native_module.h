#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "effect/abi/relevo_plugin.h"
#include "effect/manifest.h"
#include "effect/preset.h"
#include "effect/selection.h"

/// Shared libraries behind core/effect/abi/relevo_plugin.h.
namespace relevo::effect {

/// A module that is loaded. Its library stays as long as this does.
class NativeModule {
  public:
    /// Tries the module in a process of its own, and loads it here if it lived.
    /// @throws Error (BadInput) `effect::load: FILE: ...`: a library that is not there or cannot be
    ///         loaded, a symbol that is missing, a wrong version, a registration that fails,
    ///         throws, crashes, aborts or takes more than ten seconds
    static NativeModule load(const Manifest& manifest);

    NativeModule(NativeModule&&) noexcept;
    NativeModule& operator=(NativeModule&&) noexcept;
    ~NativeModule();

    const std::string& id() const { return id_; }                    ///< of its plugin
    const std::filesystem::path& folder() const { return folder_; }  ///< its plugin's
    const std::filesystem::path& library() const { return library_; }
    const relevo_module& functions() const { return functions_; }

  private:
    NativeModule() = default;

    struct Close {
        void operator()(void* library) const;
    };
    std::string id_;
    std::filesystem::path folder_, library_;
    std::unique_ptr<void, Close> handle_;
    relevo_module functions_{};
};

/// A selection with the native modules of its effects.
struct NativeSelection {
    Selection selection;
    std::vector<NativeModule> modules;  ///< in the selection's order
};

/// Selects as select() does and loads what is native among it. An effect whose module cannot be
/// loaded is off, with the reason among the notices, and so is what requires it.
/// @throws Error as select()
NativeSelection select_and_load(const Registry& registry, const std::vector<Preset>& presets,
                                const Switches& command_line);

/// Where the module of a plugin is: beside its plugin.json, else among the program's own.
/// @throws Error (BadInput) naming both places
std::filesystem::path module_file(const Manifest& manifest);

}  // namespace relevo::effect

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <relevo/plugin.h>

#include "effect/manifest.h"
#include "effect/module_call.h"
#include "shader/param_store.h"

/// Shared libraries behind relevo/plugin.h.
namespace relevo::effect {

/// A module that is loaded. Its library stays as long as this does.
class NativeModule {
  public:
    /// Tries the module in a process of its own, which calls each of its functions with services
    /// that have no device behind them, and loads it here if it lived.
    /// @param values  what the module reads and writes in the trial
    /// @throws Error (BadInput) `plugin: FILE: ...`: a library that is not there or cannot be
    ///         loaded, a symbol that is missing, a wrong version, a registration that fails, a
    ///         function that throws, crashes or ends the process, and functions that together take
    ///         more than half of patience(). That one fails in good order is not held against it:
    ///         with a device it may not
    static NativeModule load(const Manifest& manifest, const shader::ParamStore& values);

    NativeModule(NativeModule&&) noexcept;
    ~NativeModule();

    const std::string& id() const { return id_; }                    ///< of its plugin
    const std::filesystem::path& folder() const { return folder_; }  ///< its plugin's
    const std::filesystem::path& library() const { return library_; }
    /// To be called while a ModuleCall of process() lives.
    const relevo_module& functions() const { return functions_; }
    ModuleInProcess& process() const { return *process_; }

  private:
    NativeModule() = default;

    struct Close {
        ModuleInProcess* process;
        void operator()(void* library) const;
    };
    std::string id_;
    std::filesystem::path folder_, library_;
    std::unique_ptr<ModuleInProcess> process_;
    std::unique_ptr<void, Close> handle_;  // goes first
    relevo_module functions_{};
};

/// Where the module of a plugin is: beside its plugin.json, else among the program's own.
/// @throws Error (BadInput) naming both places
std::filesystem::path module_file(const Manifest& manifest);

}  // namespace relevo::effect

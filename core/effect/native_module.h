#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <relevo/plugin.h>

#include "effect/manifest.h"
#include "effect/module_call.h"
#include "shader/param_store.h"

/// Shared libraries behind relevo/plugin.h.
namespace relevo::effect {

/// A module that is loaded. Its library stays loaded as long as this lives.
class NativeModule {
  public:
    /// Tries the module in a separate process (try_module()), and loads it if it passes.
    /// @param values  that the module reads and writes in the trial
    /// @throws Error (BadInput) `plugin: FILE: ...`: a library that does not exist or cannot be
    ///         loaded, a missing symbol, a wrong version, a registration that fails, a function
    ///         that throws, crashes or ends the process, functions that together take more than
    ///         half of patience(). A function that returns an error status is not rejected: it may
    ///         succeed with a device
    static NativeModule load(const Manifest& manifest, const shader::ParamStore& values);

    const std::string& id() const { return process_->id(); }         ///< of its plugin
    const std::filesystem::path& folder() const { return folder_; }  ///< its plugin's
    const std::filesystem::path& library() const { return process_->library(); }
    /// Names of the lists of marks that the module sets.
    const std::vector<std::string>& mark_lists() const { return mark_lists_; }
    /// To be called while a ModuleCall of process() lives.
    const relevo_module& functions() const { return functions_; }
    ModuleInProcess& process() const { return *process_; }

  private:
    struct Close {
        ModuleInProcess* process;
        void operator()(void* library) const;
    };
    NativeModule() = default;

    std::filesystem::path folder_;
    std::vector<std::string> mark_lists_;
    std::unique_ptr<ModuleInProcess> process_;
    std::unique_ptr<void, Close> handle_;  // destroyed before process_
    relevo_module functions_{};
};

/// The module's file: beside its plugin.json, else among those of the program.
/// @throws Error (BadInput) naming both places
std::filesystem::path module_file(const Manifest& manifest);

/// Writes a message of a module. @param level  RELEVO_LOG_
void log_of_module(int level, const char* text);

}  // namespace relevo::effect

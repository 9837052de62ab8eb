#pragma once

#include <filesystem>
#include <string>

#include "shader/param_store.h"

namespace relevo::effect {

/// Has lib/relevo/try_module call every function of a module, in a process of its own.
/// @param folder  of its plugin
/// @returns why it will not do; empty where it will
/// @throws Error (BadInput) if the trial cannot be held
std::string try_module(const std::filesystem::path& library, const std::string& id,
                       const std::filesystem::path& folder, const shader::ParamStore& values);

}  // namespace relevo::effect

#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace relevo::shader {
class ParamStore;
}

namespace relevo::effect {

/// What lib/relevo/try_module writes to its standard output, which is a file of this size.
struct TrialReport {
    std::array<char, 32> function{};  ///< that it called last: "its prepare()"
    std::array<char, 1024> reason{};  ///< why the module is refused; empty if it is accepted
    bool is_complete = false;
};

/// Calls every function of a module in a separate process, lib/relevo/try_module. Its arguments are
/// the library, the id, the folder, and for each parameter, text and list of marks
/// "value ADDRESS V V V V", "host ADDRESS V V V V", "text ADDRESS" or "marks NAME".
/// @param folder  of the plugin
/// @param marks   names of the lists of marks that the module sets
/// @returns why the module is refused; empty if it is accepted
/// @throws Error (BadInput) if try_module does not start
std::string try_module(const std::filesystem::path& library, const std::string& id,
                       const std::filesystem::path& folder, const shader::ParamStore& values,
                       const std::vector<std::string>& marks = {});

}  // namespace relevo::effect

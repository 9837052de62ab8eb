#include "shader/plugin_pass.h"

#include <algorithm>

namespace relevo::shader {

std::string PluginPass::output_name() const {
    std::string result = resource + "_out";
    std::ranges::replace(result, '.', '_');
    return result;
}

}  // namespace relevo::shader

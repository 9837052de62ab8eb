#pragma once

#include <string>
#include <vector>

#include "shader/param_store.h"

namespace relevo::json {
class ObjectReader;
}  // namespace relevo::json

namespace relevo::effect {

/// Parameters of a plugin whose values must rise in this order: "rising": [["base_m", "top_m"]].
struct Rising {
    std::vector<std::string> addresses;  ///< "clouds.base_1_m"
    int line = 0;                        ///< in plugin.json
};

/// Reads the key "rising". @throws Error (BadInput) with file and line
std::vector<Rising> read_rising(json::ObjectReader& object, const std::string& id);

/// What is wrong with the values: "clouds.top_1_m: expected more than clouds.base_1_m, 5000, but
/// got 3000"; empty if they rise.
std::string fault_of(const Rising& rising, const shader::ParamStore& values);

}  // namespace relevo::effect

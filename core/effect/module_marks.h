#pragma once

#include <cstdint>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <relevo/plugin.h>

namespace relevo::effect {

/// Throws std::invalid_argument. Without fmt: the trial's program starts faster.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    throw std::invalid_argument(text.str());
}

/// A mark of a native module, checked.
struct ModuleMark {
    double lat_deg = 0, lon_deg = 0;
    int height_of = RELEVO_ON_GROUND;
    double height_m = 0;  ///< 0 if RELEVO_ON_GROUND
    double rank = 0;
    int symbol = RELEVO_SYMBOL_OF_LIST;
    std::optional<double> azimuth_deg = {};  ///< of the text; nullopt: upright
    std::string text = {};
};
using ModuleMarks = std::vector<ModuleMark>;

/// Copies the marks of a call of relevo_marks_1::set.
/// @param least_size  of a mark [bytes]
/// @throws std::invalid_argument naming the first mark that is wrong: a number that is not finite
///     or outside its range, an unknown word, a text that is null, longer than RELEVO_MAX_MARK_TEXT
///     or not UTF-8, marks of different sizes, more than RELEVO_MAX_MARKS
ModuleMarks read_marks(const relevo_mark* marks, std::uint64_t count, std::uint32_t least_size);

/// Why there is no list of that name.
std::string no_list_text(const char* list);

}  // namespace relevo::effect

#include "effect/module_marks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/utf8.h"

namespace relevo::effect {
namespace {

/// Heights of places in files have the same limit.
constexpr double kMostHeight_m = 2e6;

/// Checks the members of one mark.
class Checker {
  public:
    explicit Checker(std::uint64_t index) : index_(index) {}

    double number(const char* member, double value, double low, double high) const {
        if (!(value >= low && value <= high))
            refuse("marks[", index_, "].", member, ": expected ", low, " to ", high, " but got ",
                   value);
        return value;
    }
    double finite(const char* member, double value) const {
        if (!std::isfinite(value))
            refuse("marks[", index_, "].", member, ": expected a finite number but got ", value);
        return value;
    }
    int word(const char* member, std::int32_t value, std::int32_t last) const {
        if (value < 0 || value > last)
            refuse("marks[", index_, "].", member, ": expected 0 to ", last, " but got ", value);
        return value;
    }
    std::string text(const char* value) const {
        if (!value) refuse("marks[", index_, "].text is null");
        const std::size_t length = strnlen(value, RELEVO_MAX_MARK_TEXT + 1);
        if (length > RELEVO_MAX_MARK_TEXT)
            refuse("marks[", index_, "].text: expected up to ", RELEVO_MAX_MARK_TEXT,
                   " bytes but got more");
        const std::string_view text(value, length);
        if (!is_utf8(text)) refuse("marks[", index_, "].text is not UTF-8");
        return std::string(text);
    }

  private:
    std::uint64_t index_;
};

ModuleMark read_mark(const relevo_mark& given, std::uint64_t index) {
    const Checker check(index);
    ModuleMark mark;
    mark.lat_deg = check.number("lat_deg", given.lat_deg, -90, 90);
    mark.lon_deg = check.number("lon_deg", given.lon_deg, -360, 360);
    mark.height_of = check.word("height_of", given.height_of, RELEVO_ON_KNOWN_GROUND);
    if (mark.height_of != RELEVO_ON_GROUND)
        mark.height_m = check.number("height_m", given.height_m, -kMostHeight_m, kMostHeight_m);
    mark.rank = check.finite("rank", given.rank);
    mark.symbol = check.word("symbol", given.symbol, RELEVO_SYMBOL_TRIANGLE);
    if (check.word("direction", given.direction, RELEVO_ALONG_AZIMUTH) == RELEVO_ALONG_AZIMUTH)
        mark.azimuth_deg = check.number("azimuth_deg", given.azimuth_deg, -360, 360);
    mark.text = check.text(given.text);
    return mark;
}

}  // namespace

std::string no_list_text(const char* list) {
    return std::string("plugin.json has no list of marks \"") + list + "\" without \"from\"";
}

ModuleMarks read_marks(const relevo_mark* marks, std::uint64_t count, std::uint32_t least_size) {
    if (count == 0) return {};
    if (count > RELEVO_MAX_MARKS)
        refuse("expected up to ", RELEVO_MAX_MARKS, " marks but got ", count);
    if (!marks) refuse("marks is null");
    const std::uint32_t size = marks->size;
    if (size < least_size)
        refuse("marks[0].size is ", size, ", expected its sizeof, at least ", least_size);
    ModuleMarks result;
    result.reserve(count);
    const auto* at = reinterpret_cast<const unsigned char*>(marks);
    for (std::uint64_t i = 0; i < count; ++i, at += size) {
        relevo_mark mark{};
        std::memcpy(&mark, at, std::min<std::size_t>(size, sizeof mark));
        if (mark.size != size)
            refuse("marks[", i, "].size is ", mark.size, ", expected ", size, " as of marks[0]");
        result.push_back(read_mark(mark, i));
    }
    return result;
}

}  // namespace relevo::effect

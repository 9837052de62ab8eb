#include <algorithm>
#include <optional>

#include "base/contains.h"
#include "base/text.h"
#include "shader/limits.h"

namespace relevo::shader {
namespace {

constexpr double kMaxTurns = 10000;

class LoopReader {
  public:
    explicit LoopReader(const Source& source) : source_(source) {}

    /// @param head  of a for
    bool is_bounded(std::size_t head) const {
        const std::size_t close = source_.tokens[head + 1].partner;
        const std::size_t condition = source_.until(head + 2, ";") + 1;
        const std::size_t step = source_.until(condition, ";") + 1;
        if (step != condition + 4 || step > close) return false;
        const std::string_view name = str(condition), mark = str(condition + 1);
        const bool rises = mark == "<" || mark == "<=";
        if (!(rises || mark == ">" || mark == ">=") || !is_constant(condition + 2)) return false;
        const std::optional<double> from = start_before(condition - 1),
                                    to = number(str(condition + 2));
        std::optional<double> way;
        if (from && to) way = rises ? *to - *from : *from - *to;
        if (!approaches(step, close, name, rises, way)) return false;
        const std::size_t end = source_.after_statement(close + 1);  // of the body
        for (std::size_t i = close; i < end; ++i)
            if (str(i) == name && !source_.writes(i).empty()) return false;
        return true;
    }

  private:
    std::string_view str(std::size_t i) const { return source_.str(i); }

    bool is_constant(std::size_t i) const {
        if (const std::optional<double> value = number(str(i))) return *value <= kMaxTurns;
        const std::string_view name = str(i);
        for (const Param& param : source_.params)
            if (param.name == name)
                return param.is_static && param.range && param.range->max <= kMaxTurns;
        return std::ranges::any_of(source_.items, [&](const Item& item) {
            const bool known = contains(item.names, name);
            return known && (item.kind == Item::Kind::Macro ||
                             (item.kind == Item::Kind::Declaration && str(item.first) == "const"));
        });
    }

    /// Whether the step in [first, last) brings a variable to its bound within kMaxTurns.
    /// @param rises  the condition is < or <=
    /// @param way    from the first value to the bound; none if one of them is not a number
    bool approaches(std::size_t first, std::size_t last, std::string_view name, bool rises,
                    std::optional<double> way) const {
        const std::string_view single = rises ? "++" : "--";
        if (last - first == 2 && (str(first) == single || str(first + 1) == single))
            return !way || *way <= kMaxTurns;
        if (last - first != 3 || str(first) != name) return false;
        const std::string_view mark = str(first + 1);
        const std::optional<double> by = number(str(first + 2));
        if (mark == (rises ? "+=" : "-=")) {
            if (!by) return is_constant(first + 2);
            return *by > 0 && way.value_or(*by) / *by <= kMaxTurns;
        }
        if (mark == (rises ? "*=" : "/=")) return by && *by > 1;
        return mark == (rises ? "<<=" : ">>=") && by && *by >= 1;
    }

    /// A number of GLSL, without its suffix.
    static std::optional<double> number(std::string_view text) {
        text = text.substr(0, text.find_last_not_of("fFuU") + 1);
        if (text.ends_with('.')) text.remove_suffix(1);
        return parse_number(text);
    }

    /// The number from which `int i = 0;` starts, up to the token `last`.
    std::optional<double> start_before(std::size_t last) const {
        if (str(last - 2) == "=") return number(str(last - 1));
        if (str(last - 2) == "-" && str(last - 3) == "=")
            if (const auto value = number(str(last - 1))) return -*value;
        return std::nullopt;
    }

    const Source& source_;
};

}  // namespace

std::vector<int> open_loops(const Source& source) {
    std::vector<int> lines;
    const LoopReader reader(source);
    for (std::size_t i = 0; i < source.tokens.size(); ++i)
        if (source.is(i, "while") || (source.is(i, "for") && !reader.is_bounded(i)))
            lines.push_back(source.tokens[i].line);
    return lines;
}

}  // namespace relevo::shader

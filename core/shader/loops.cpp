#include "shader/loops.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/contains.h"
#include "base/text.h"

namespace relevo::shader {
namespace {

constexpr double kMaxTurns = 10000;

class LoopReader {
  public:
    explicit LoopReader(const Source& source) : source_(source) {}

    std::vector<int> run() {
        std::vector<int> lines;
        for (std::size_t i = 0; i < source_.tokens.size(); ++i) {
            const std::string_view word = str(i);
            if (word == "while" || (word == "for" && !is_bounded(i)))
                lines.push_back(source_.tokens[i].line);
        }
        return lines;
    }

  private:
    std::string_view str(std::size_t i) const {
        return i < source_.tokens.size() && source_.tokens[i].kind != TokenKind::Directive
                   ? source_.str(source_.tokens[i])
                   : std::string_view();
    }

    /// The token after the bracket that closes the one at `i`.
    std::size_t after_brackets(std::size_t i) const {
        int depth = 0;
        do {
            depth += str(i) == "(" || str(i) == "{";
            depth -= str(i) == ")" || str(i) == "}";
            ++i;
        } while (depth > 0 && i < source_.tokens.size());
        return i;
    }

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

    /// Whether the tokens [first, last) write to a variable.
    bool writes(std::string_view name, std::size_t first, std::size_t last) const {
        constexpr std::array<std::string_view, 7> kWriting = {
            "=", "+=", "-=", "*=", "/=", "++", "--"};
        for (std::size_t i = first; i < last; ++i)
            if (str(i) == name &&
                (contains(kWriting, str(i + 1)) || str(i - 1) == "++" || str(i - 1) == "--"))
                return true;
        return false;
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
        while (!text.empty() && (text.back() == 'f' || text.back() == 'F' || text.back() == 'u' ||
                                 text.back() == 'U'))
            text.remove_suffix(1);
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

    /// @param head  of a for
    bool is_bounded(std::size_t head) const {
        const std::size_t close = after_brackets(head + 1);  // after the )
        std::vector<std::size_t> semicolons;
        for (std::size_t i = head + 1; i < close; ++i)
            if (str(i) == ";") semicolons.push_back(i);
        if (semicolons.size() != 2) return false;
        const std::size_t condition = semicolons[0] + 1;
        const std::string_view name = str(condition), mark = str(condition + 1);
        const bool compares = mark == "<" || mark == "<=" || mark == ">" || mark == ">=";
        if (!compares || semicolons[1] != condition + 3 || !is_constant(condition + 2))
            return false;
        const std::size_t step = semicolons[1] + 1;
        const bool rises = mark == "<" || mark == "<=";
        const std::optional<double> from = start_before(semicolons[0]),
                                    to = number(str(condition + 2));
        std::optional<double> way;
        if (from && to) way = rises ? *to - *from : *from - *to;
        if (!approaches(step, close - 1, name, rises, way)) return false;
        std::size_t end = close;  // of the body
        if (str(close) == "{")
            end = after_brackets(close);
        else
            while (end < source_.tokens.size() && str(end) != ";")
                ++end;
        return !writes(name, close, end);
    }

    const Source& source_;
};

}  // namespace

std::vector<int> open_loops(const Source& source) {
    return LoopReader(source).run();
}

}  // namespace relevo::shader

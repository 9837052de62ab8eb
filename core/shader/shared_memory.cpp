#include "shader/shared_memory.h"

#include <array>
#include <optional>

#include <fmt/format.h>

#include "base/text.h"

namespace relevo::shader {
namespace {

struct TypeSize {
    std::string_view name;
    std::size_t bytes;
};
constexpr std::array<TypeSize, 16> kTypeSizes{{{"float", 4},
                                               {"int", 4},
                                               {"uint", 4},
                                               {"bool", 4},
                                               {"vec2", 8},
                                               {"ivec2", 8},
                                               {"uvec2", 8},
                                               {"vec3", 16},
                                               {"ivec3", 16},
                                               {"uvec3", 16},
                                               {"vec4", 16},
                                               {"ivec4", 16},
                                               {"uvec4", 16},
                                               {"mat2", 16},
                                               {"mat3", 48},
                                               {"mat4", 64}}};

/// A whole number above 0, "16" or "16u".
std::optional<std::size_t> whole(std::string_view text) {
    if (text.ends_with('u') || text.ends_with('U')) text.remove_suffix(1);
    const std::optional<double> value = parse_number(text);
    if (!value || *value < 1 || *value > 1e9) return std::nullopt;
    return static_cast<std::size_t>(*value);
}

class Declaration {
  public:
    Declaration(const Source& source, const Item& item) : source_(source), item_(item) {}

    std::size_t bytes() {
        std::size_t at = item_.first + 1;
        std::size_t total = type_bytes(str(at++));
        for (; str(at) != ";"; ++at) {
            if (str(at) == "," || str(at) == "=")
                fail(
                    "expected one variable without an initial value in a shared declaration; write "
                    "zeros in the function, "
                    "then call barrier()");
            if (str(at) == "[") total *= length(++at);
            // More than any device has: the product must not overflow.
            if (total > std::size_t{1} << 40) total = std::size_t{1} << 40;
        }
        return total;
    }

  private:
    std::string_view str(std::size_t token) const { return source_.str(source_.tokens[token]); }

    [[noreturn]] void fail(std::string_view message) const {
        source_error(
            source_.file, item_.name_line,
            fmt::format("{}: {}", item_.names.empty() ? "shared" : item_.names[0], message));
    }

    std::size_t type_bytes(std::string_view type) const {
        for (const TypeSize& known : kTypeSizes)
            if (known.name == type) return known.bytes;
        fail(fmt::format(
            "expected shared memory of float, int, uint, bool, vectors or matrices but got {}",
            type));
    }

    /// The length between brackets. @param at  its first token; then the closing bracket
    std::size_t length(std::size_t& at) const {
        std::size_t product = 1;
        for (bool factor = true; str(at) != "]"; ++at, factor = !factor) {
            const std::optional<std::size_t> value = factor ? value_of(str(at)) : std::nullopt;
            if (factor ? !value : str(at) != "*")
                fail(
                    fmt::format("expected a length that is a number, a constant of this file, or a "
                                "product of these, but "
                                "got {}",
                                str(at)));
            if (value) product *= *value;
        }
        return product;
    }

    /// The number that a word of the file stands for.
    std::optional<std::size_t> value_of(std::string_view word) const {
        if (const auto number = whole(word)) return number;
        for (const Item& other : source_.items) {
            if (other.names.size() != 1 || other.names[0] != word) continue;
            if (other.kind == Item::Kind::Macro) {
                const auto words =
                    directive_tokens(source_.text, source_.tokens[other.first], source_.file);
                return words.size() == 3 ? whole(source_.str(words[2])) : std::nullopt;
            }
            // const int NAME = NUMBER ;
            if (other.kind == Item::Kind::Declaration && other.last - other.first == 6 &&
                str(other.first) == "const")
                return whole(str(other.first + 4));
        }
        return std::nullopt;
    }

    const Source& source_;
    const Item& item_;
};

}  // namespace

bool is_shared(const Source& source, const Item& item) {
    return item.kind == Item::Kind::Declaration &&
           source.str(source.tokens[item.first]) == "shared";
}

std::size_t shared_bytes(const Source& source, const Item& item) {
    return is_shared(source, item) ? Declaration(source, item).bytes() : 0;
}

}  // namespace relevo::shader

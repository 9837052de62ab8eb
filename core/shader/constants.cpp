#include "shader/constants.h"

#include "base/text.h"

namespace relevo::shader {

void Constants::add_params(const Source& source) {
    for (const Param& param : source.params)
        if (param.is_static && param.range)
            known_[param.name] = std::to_string(static_cast<long long>(param.range->max));
}

void Constants::add(const Source& source, std::size_t i) {
    const std::vector<Token>& words = source.tokens[i].words;
    if (source.directive(i) == "define" && words.size() > 1)
        known_[std::string(source.str(words[1]))] = joined(source, std::span(words).subspan(2));
    if (!source.is(i, "const") || !(source.is(i + 1, "int") || source.is(i + 1, "uint"))) return;
    // const int n = 3, m = 4;
    for (i += 2; source.is(i + 1, "="); ++i) {
        const std::size_t name = i;
        i = source.until(i + 2, ",;");
        known_[std::string(source.str(name))] =
            "( " + joined(source, std::span(source.tokens).subspan(name + 2, i - name - 2)) + ")";
    }
}

std::optional<double> Constants::value(const Source& source,
                                       std::span<const Token> expression) const {
    const std::string text = joined(source, expression);
    // Numbers may be greater than those of #if.
    std::string_view number = trimmed(text);
    number = number.substr(0, number.find_last_not_of("uU") + 1);
    if (const std::optional<double> whole = parse_number(number)) return whole;
    if (const auto known = evaluate_expression(text, known_)) return static_cast<double>(*known);
    return std::nullopt;
}

}  // namespace relevo::shader

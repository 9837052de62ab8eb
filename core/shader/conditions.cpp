#include "shader/conditions.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/text.h"

namespace relevo::shader {
namespace {

using Int = long long;
using Value = std::optional<Int>;

Value truth(const Value& value) {
    if (!value) return std::nullopt;
    return *value != 0;
}

struct Operator {
    std::string_view text;
    int precedence;
    Value (*apply)(Int a, Int b);
};
constexpr std::array kOperators = {
    Operator{"||", 1, [](Int a, Int b) -> Value { return a || b; }},
    Operator{"&&", 2, [](Int a, Int b) -> Value { return a && b; }},
    Operator{"|", 3, [](Int a, Int b) -> Value { return a | b; }},
    Operator{"^", 4, [](Int a, Int b) -> Value { return a ^ b; }},
    Operator{"&", 5, [](Int a, Int b) -> Value { return a & b; }},
    Operator{"==", 6, [](Int a, Int b) -> Value { return a == b; }},
    Operator{"!=", 6, [](Int a, Int b) -> Value { return a != b; }},
    Operator{"<", 7, [](Int a, Int b) -> Value { return a < b; }},
    Operator{">", 7, [](Int a, Int b) -> Value { return a > b; }},
    Operator{"<=", 7, [](Int a, Int b) -> Value { return a <= b; }},
    Operator{">=", 7, [](Int a, Int b) -> Value { return a >= b; }},
    Operator{"<<", 8, [](Int a, Int b) { return b >= 0 && b < 32 ? a * (Int{1} << b) : Value(); }},
    Operator{">>", 8, [](Int a, Int b) { return b >= 0 && b < 32 ? a >> b : Value(); }},
    Operator{"+", 9, [](Int a, Int b) -> Value { return a + b; }},
    Operator{"-", 9, [](Int a, Int b) -> Value { return a - b; }},
    Operator{"*", 10, [](Int a, Int b) -> Value { return a * b; }},
    Operator{"/", 10, [](Int a, Int b) { return b != 0 ? a / b : Value(); }},
    Operator{"%", 10, [](Int a, Int b) { return b != 0 ? a % b : Value(); }}};

/// The expressions of #if (GLSL 4.50, 3.3), by precedence climbing. An unknown value is empty.
class Expression {
  public:
    Expression(std::string_view text, const Macros& macros) : macros_(macros) { expand(text, 0); }

    Value run() {
        const Value value = binary(1);
        if (at_ != words_.size()) return std::nullopt;
        return value;
    }

  private:
    // Deeper macros are recursive. Longer expansions have no end.
    static constexpr int kMaxDepth = 16;
    static constexpr std::size_t kMaxWords = 10000;

    void expand(std::string_view text, int depth) {
        const std::vector<Token> tokens = tokenize(text, "").code;
        for (std::size_t i = 0; i < tokens.size() && words_.size() < kMaxWords; ++i) {
            const std::string word(text_of(text, tokens[i]));
            if (tokens[i].kind != TokenKind::Word) {
                words_.push_back(word);
            } else if (word == "defined") {
                const bool bracket = i + 1 < tokens.size() && text_of(text, tokens[i + 1]) == "(";
                const std::size_t name = i + (bracket ? 2 : 1);
                words_.push_back(name < tokens.size() ? defined(text_of(text, tokens[name])) : "?");
                i = name + (bracket ? 1 : 0);
            } else if (const auto macro = macros_.find(word);
                       macro != macros_.end() && macro->second && depth < kMaxDepth) {
                expand(*macro->second, depth + 1);
            } else {
                words_.push_back(word == "__VERSION__" ? "450" : "?");
            }
        }
    }

    std::string defined(std::string_view name) const {
        if (const auto macro = macros_.find(name); macro != macros_.end())
            return macro->second ? "1" : "?";
        // Macros of extensions are known to the driver only.
        return name.substr(0, 3) == "GL_" || name.substr(0, 2) == "__" ? "?" : "0";
    }

    bool take(std::string_view word) {
        if (at_ == words_.size() || words_[at_] != word) return false;
        ++at_;
        return true;
    }

    static Value apply(const Operator& op, const Value& a, const Value& b) {
        if (op.text == "||" && ((a && *a) || (b && *b))) return 1;
        if (op.text == "&&" && ((a && !*a) || (b && !*b))) return 0;
        return a && b ? op.apply(*a, *b) : std::nullopt;
    }

    /// GLSL's integers have 32 bits. The driver decides about larger values.
    static Value in_range(const Value& value) {
        constexpr long long kMax = 0x7FFFFFFF;
        return value && *value >= -kMax - 1 && *value <= kMax ? value : std::nullopt;
    }

    Value binary(int least) {
        Value left = unary();
        while (at_ < words_.size()) {
            const auto op = std::ranges::find(kOperators, words_[at_], &Operator::text);
            if (op == kOperators.end() || op->precedence < least) break;
            ++at_;
            left = in_range(apply(*op, left, binary(op->precedence + 1)));
        }
        return left;
    }

    Value unary() {
        if (++nesting_ > kMaxWords / 10) return std::nullopt;  // limits the stack
        if (take("!")) {
            const Value value = truth(unary());
            return value ? Value(*value == 0) : std::nullopt;
        }
        if (take("-")) {
            const Value value = unary();
            return value ? in_range(-*value) : std::nullopt;
        }
        if (take("+")) return unary();
        if (take("(")) {
            const Value value = binary(1);
            return take(")") ? value : std::nullopt;
        }
        if (at_ == words_.size()) return std::nullopt;
        std::string_view word = words_[at_++];
        if (word.ends_with('u') || word.ends_with('U')) word.remove_suffix(1);
        const bool hexadecimal = word.substr(0, 2) == "0x" || word.substr(0, 2) == "0X";
        const char* const begin = word.data() + (hexadecimal ? 2 : 0);
        const char* const end = word.data() + word.size();
        int number = 0;
        const auto [stop, error] = std::from_chars(begin, end, number, hexadecimal ? 16 : 10);
        if (error != std::errc{} || stop != end) return std::nullopt;
        return number;
    }

    const Macros& macros_;
    std::vector<std::string> words_;
    std::size_t at_ = 0;
    std::size_t nesting_ = 0;
};

struct Group {
    bool parent_active;
    bool parent_certain;
    bool decided = true;  // every condition so far is known
    bool taken = false;   // a branch is certainly active
    bool active = false;  // the current branch may be compiled
    std::vector<std::size_t> directives;
};

/// Evaluates the directives of a file in order.
class Walk {
  public:
    Walk(const Source& source, Macros& macros) : source_(source), macros_(macros) {
        result_.active.resize(source.tokens.size());
    }

    Conditions run() {
        for (std::size_t i = 0; i < source_.tokens.size(); ++i) {
            result_.active[i] = is_active();
            words_ = source_.tokens[i].words;
            if (!words_.empty()) obey(i);
        }
        return std::move(result_);
    }

  private:
    bool is_active() const { return groups_.empty() || groups_.back().active; }
    bool is_certain() const {
        return groups_.empty() || (groups_.back().parent_certain && groups_.back().decided);
    }

    std::string word(std::size_t n) const { return std::string(source_.str(words_[n])); }

    /// The text from the directive's word `n`.
    std::string rest(std::size_t n) const { return joined(source_, words_.subspan(n)); }

    Value condition() const {
        const std::string name = word(0);
        if (name == "ifdef") return evaluate_expression("defined " + rest(1), macros_);
        if (name == "ifndef") return evaluate_expression("!defined " + rest(1), macros_);
        return truth(evaluate_expression(rest(1), macros_));
    }

    /// @param i  the directive's token
    void obey(std::size_t i) {
        const std::string name = word(0);
        if (name == "define" && is_active() && words_.size() > 1) {
            define();
        } else if (name == "undef" && is_active() && words_.size() > 1) {
            if (is_certain())
                macros_.erase(word(1));
            else
                macros_[word(1)] = std::nullopt;
        } else if (name.starts_with("if")) {
            open(i);
        } else if (name == "elif" || name == "else") {
            go_on(i);
        } else if (name == "endif") {
            close(i);
        }
    }

    void define() {
        const bool function = words_.size() > 2 && word(2) == "(" &&
                              words_[2].offset == words_[1].offset + words_[1].length;
        macros_[word(1)] = function || !is_certain() ? std::nullopt : std::make_optional(rest(2));
    }

    void open(std::size_t i) {
        Group group{is_active(), is_certain(), true, false, false, {i}};
        const Value value = group.parent_active ? condition() : Value(0);
        group.active = group.parent_active && value.value_or(1) != 0;
        group.taken = value.value_or(0) != 0;
        group.decided = value.has_value();
        groups_.push_back(group);
    }

    void go_on(std::size_t i) {
        Group& group = groups_.back();
        group.directives.push_back(i);
        const bool is_else = word(0) == "else";
        Value value = is_else ? Value(1) : Value(0);
        if (!is_else && group.parent_active && !group.taken) value = condition();
        group.active = group.parent_active && !group.taken && value.value_or(1) != 0;
        group.decided = group.decided && value.has_value();
        group.taken = group.taken || value.value_or(0) != 0;
    }

    void close(std::size_t i) {
        Group& group = groups_.back();
        group.directives.push_back(i);
        if (group.parent_active && !group.decided)
            result_.undecided.push_back(std::move(group.directives));
        groups_.pop_back();
    }

    const Source& source_;
    Macros& macros_;
    Conditions result_;
    std::vector<Group> groups_;
    std::span<const Token> words_;  // of the directive
};

}  // namespace

std::optional<long long> evaluate_expression(std::string_view expression, const Macros& macros) {
    return Expression(expression, macros).run();
}

Conditions evaluate_conditions(const Source& source, Macros& macros) {
    return Walk(source, macros).run();
}

// ---- constants

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

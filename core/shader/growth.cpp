#include "shader/growth.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "shader/conditions.h"

namespace relevo::shader {
namespace {

constexpr double kMaxWords = 1e6;
constexpr int kMaxDepth = 200;
constexpr std::size_t kMaxParams = 64;  // of a macro
constexpr double kMaxElements = 65536;

using Words = std::span<const Token>;

/// Number of words of an expanded text: a constant, and for each parameter of the macro around it
/// how often its argument occurs.
struct Count {
    double words = 0;
    std::vector<double> of_params;

    void add(const Count& other, double times = 1) {
        words += times * other.words;
        for (std::size_t i = 0; i < of_params.size(); ++i)
            of_params[i] += times * other.of_params[i];
    }
};

struct Macro {
    const Source* source;
    std::vector<Token> directive;  ///< after the #
    bool is_function = false;
    std::vector<std::string_view> params;
    std::size_t body = 2;  ///< the first of its words in `directive`
    std::optional<Count> count;
    bool is_open = false;  ///< being expanded: the preprocessor does not expand it again
};

struct Function {
    const Source* source;
    const Item* item;
    std::optional<double> words;
    bool is_open = false;
};

class Growth {
  public:
    explicit Growth(const std::vector<Snippet>& files) {
        for (const Snippet& file : files)
            for (const Item& item : file.source.items) {
                if (item.kind == Item::Kind::Macro) add_macro(file.source, item);
                if (item.kind == Item::Kind::Function)
                    functions_[item.names.front()].push_back({&file.source, &item, {}});
            }
    }

    void check(const std::vector<Snippet>& files) {
        for (const Snippet& file : files)
            for (const Item& item : file.source.items) {
                if (item.kind != Item::Kind::Function && item.kind != Item::Kind::Declaration)
                    continue;
                at_ = {&file.source, item.name_line};
                const double words =
                    item.kind == Item::Kind::Function
                        ? function(item.names.front())
                        : count(file.source, words_of(file.source, item), {}).words;
                if (words > kMaxWords)
                    fail(fmt::format(
                        "{}: {:.2g} words when expanded, expected at most {:.0g}: drivers expand "
                        "macros and inline calls; use a loop",
                        item.names.empty() ? "it" : item.names.front(), words, kMaxWords));
            }
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        source_error(at_.first->file, at_.second, message);
    }

    static Words words_of(const Source& source, const Item& item) {
        return Words(source.tokens).subspan(item.first, item.last - item.first);
    }

    void add_macro(const Source& source, const Item& item) {
        Macro macro{&source, directive_tokens(source.text, source.tokens[item.first], source.file),
                    false,   {},
                    2,       {}};
        const std::vector<Token>& words = macro.directive;
        if (words.size() < 2) return;
        macro.is_function = words.size() > 2 && source.str(words[2]) == "(" &&
                            words[2].offset == words[1].offset + words[1].length;
        if (macro.is_function) {
            std::size_t i = 3;
            for (; i < words.size() && source.str(words[i]) != ")"; ++i)
                if (words[i].kind == TokenKind::Word) macro.params.push_back(source.str(words[i]));
            macro.body = i + 1;
        }
        if (macro.params.size() > kMaxParams)
            source_error(source.file, item.line,
                         fmt::format("expected a macro of at most {} parameters but got {}",
                                     kMaxParams, macro.params.size()));
        macros_[std::string(source.str(words[1]))].push_back(std::move(macro));
    }

    /// @param params  of the macro whose words these are
    Count count(const Source& source, Words words, const std::vector<std::string_view>& params) {
        if (++depth_ > kMaxDepth)
            fail(fmt::format("macros and calls nest more than {} deep", kMaxDepth));
        Count sum{0, std::vector<double>(params.size())};
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i].kind == TokenKind::Directive) continue;
            ++sum.words;
            if (words[i].kind != TokenKind::Word) continue;
            const std::string_view word = source.str(words[i]);
            const bool is_call = i + 1 < words.size() && source.str(words[i + 1]) == "(";
            const auto param = std::ranges::find(params, word);
            if (param != params.end()) {
                ++sum.of_params[static_cast<std::size_t>(param - params.begin())];
            } else if (const auto macro = macros_.find(word); macro != macros_.end()) {
                i = add_macro_use(source, words, i, params, macro->second, sum);
            } else if (is_call) {
                sum.words += function(word);
            }
        }
        --depth_;
        return sum;
    }

    /// Adds the words of the macro call at `i`. @returns its last word
    std::size_t add_macro_use(const Source& source, Words words, std::size_t i,
                              const std::vector<std::string_view>& params,
                              std::vector<Macro>& definitions, Count& sum) {
        const bool is_call = i + 1 < words.size() && source.str(words[i + 1]) == "(";
        std::size_t end = i;
        std::vector<Count> arguments;
        const bool takes_arguments =
            is_call &&
            std::ranges::any_of(definitions, [](const Macro& macro) { return macro.is_function; });
        if (takes_arguments) arguments = arguments_of(source, words, i + 1, params, end);
        // The longest of several definitions, whichever is valid here.
        Count longest{0, std::vector<double>(params.size())};
        for (Macro& macro : definitions) {
            if (macro.is_function && !is_call) continue;
            const Count& body = of(macro);
            Count use{body.words, std::vector<double>(params.size())};
            for (std::size_t k = 0; k < body.of_params.size() && k < arguments.size(); ++k)
                use.add(arguments[k], body.of_params[k]);
            if (use.words >= longest.words) longest = std::move(use);
        }
        sum.add(longest);
        return end;
    }

    /// @param open  the bracket. @param end  becomes its closing bracket
    std::vector<Count> arguments_of(const Source& source, Words words, std::size_t open,
                                    const std::vector<std::string_view>& params, std::size_t& end) {
        std::vector<Count> arguments;
        int depth = 0;
        std::size_t begin = open + 1;
        for (std::size_t i = open; i < words.size(); ++i) {
            const std::string_view mark = source.str(words[i]);
            depth += mark == "(";
            depth -= mark == ")";
            if (depth == 0 || (depth == 1 && mark == ",")) {
                arguments.push_back(count(source, words.subspan(begin, i - begin), params));
                begin = i + 1;
            }
            end = i;
            if (depth == 0) break;
        }
        return arguments;
    }

    const Count& of(Macro& macro) {
        static const Count kNothing;
        if (macro.count) return *macro.count;
        if (std::exchange(macro.is_open, true)) return kNothing;
        const Words words = macro.directive;
        macro.count =
            count(*macro.source, words.subspan(std::min(macro.body, words.size())), macro.params);
        return *macro.count;
    }

    double function(std::string_view name) {
        const auto found = functions_.find(name);
        if (found == functions_.end()) return 0;
        double longest = 0;
        for (Function& function : found->second) {
            if (!function.words && !std::exchange(function.is_open, true)) {
                const Words words = words_of(*function.source, *function.item);
                function.words = count(*function.source, words, {}).words;
            }
            longest = std::max(longest, function.words.value_or(0));
        }
        return longest;
    }

    std::map<std::string, std::vector<Macro>, std::less<>> macros_;
    std::map<std::string, std::vector<Function>, std::less<>> functions_;
    std::pair<const Source*, int> at_;  ///< file and line for messages
    int depth_ = 0;
};

/// Lengths of arrays that numbers, macros and `const int` give.
class Arrays {
  public:
    void check(const Source& source) {
        for (const Param& param : source.params)
            if (param.is_static && param.range)
                known_[param.name] = std::to_string(static_cast<long long>(param.range->max));
        const std::vector<Token>& words = source.tokens;
        double elements = 1;  // of arrays of arrays
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i].kind == TokenKind::Directive)
                directive(source, words[i]);
            else if (source.str(words[i]) == "const")
                constant(source, i);
            else if (source.str(words[i]) == "[")
                elements = bracket(source, words, i,
                                   i > 0 && source.str(words[i - 1]) == "]" ? elements : 1);
        }
    }

  private:
    /// The words from one up to a mark.
    static std::string until(const Source& source, Words words, std::size_t& i,
                             std::string_view marks) {
        std::string text;
        int depth = 0;
        for (; i < words.size(); ++i) {
            std::string_view word = source.str(words[i]);
            if (depth == 0 && word.size() == 1 && marks.find(word) != std::string_view::npos) break;
            depth += word == "(" || word == "[";
            depth -= word == ")" || word == "]";
            if (words[i].kind == TokenKind::Number && (word.ends_with('u') || word.ends_with('U')))
                word.remove_suffix(1);
            text += std::string(word) + ' ';
        }
        return text;
    }

    /// A macro may contain a declaration.
    void directive(const Source& source, const Token& token) {
        const std::vector<Token> words = directive_tokens(source.text, token, source.file);
        if (words.size() < 2 || source.str(words[0]) != "define") return;
        std::size_t i = 2;
        known_[std::string(source.str(words[1]))] = until(source, words, i, "");
        for (i = 2; i < words.size(); ++i)
            if (source.str(words[i]) == "[") bracket(source, words, i, 1);
    }

    /// const int n = 3, m = 4;
    void constant(const Source& source, std::size_t i) {
        const Words words = source.tokens;
        if (i + 4 >= words.size()) return;
        const std::string_view type = source.str(words[i + 1]);
        if (type != "int" && type != "uint") return;
        for (i += 2; i + 2 < words.size() && source.str(words[i + 1]) == "="; ++i) {
            const std::string name(source.str(words[i]));
            i += 2;
            known_[name] = "( " + until(source, words, i, ",;") + ")";
            if (i >= words.size() || source.str(words[i]) != ",") return;
        }
    }

    /// @returns the number of elements so far. @throws Error for too many
    double bracket(const Source& source, Words words, std::size_t i, double elements) const {
        const int line = words[i].line;
        ++i;
        const std::string text = until(source, words, i, "]");
        const std::optional<double> number = parse_number(trimmed(text));
        const std::optional<long long> value = evaluate_expression(text, known_);
        elements *= number.value_or(value ? static_cast<double>(*value) : 1);
        if (elements > kMaxElements)
            source_error(source.file, line,
                         fmt::format("[{}]: expected an array of at most {:.0f} elements but got "
                                     "{:.0f}",
                                     trimmed(text), kMaxElements, elements));
        return elements;
    }

    Macros known_;
};

}  // namespace

void check_growth(const std::vector<Snippet>& files) {
    Growth(files).check(files);
    Arrays arrays;
    for (const Snippet& file : files)
        arrays.check(file.source);
}

}  // namespace relevo::shader

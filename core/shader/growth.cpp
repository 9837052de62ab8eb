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
#include "shader/limits.h"

namespace relevo::shader {
namespace {

constexpr double kMaxWords = 1e6;
constexpr int kMaxDepth = 200;
constexpr std::size_t kMaxParams = 64;  // of a macro
constexpr double kMaxElements = 65536;

/// Tokens of a file, or of a directive in it.
struct Words {
    const Source* source;
    const std::vector<Token>* all;
    std::size_t first, last;

    std::string_view str(std::size_t i) const {
        return i < last ? source->str((*all)[i]) : std::string_view();
    }
};

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

/// A macro or a function.
struct Definition {
    Words body;
    bool is_function = false;  ///< or a macro with parameters
    std::vector<std::string_view> params{};
    std::optional<Count> count{};
    bool is_open = false;  ///< being expanded: the preprocessor does not expand it again
};
using Definitions = std::map<std::string_view, std::vector<Definition>>;

class Growth {
  public:
    void check(const std::vector<Snippet>& files) {
        for (const Snippet& file : files)
            for (const Item& item : file.source.items) {
                if (item.kind == Item::Kind::Macro) add_macro(file.source, item);
                if (item.kind == Item::Kind::Function)
                    functions_[item.names[0]].push_back({words_of(file.source, item)});
            }
        for (const Snippet& file : files)
            for (const Item& item : file.source.items) {
                if (item.kind != Item::Kind::Function && item.kind != Item::Kind::Declaration)
                    continue;
                at_ = {&file.source, item.name_line};
                const double words = item.kind == Item::Kind::Function
                                         ? function(item.names[0])
                                         : count(words_of(file.source, item), {}).words;
                if (words > kMaxWords)
                    fail(fmt::format(
                        "{}: {:.2g} words when expanded, expected at most {:.0g}: drivers expand "
                        "macros and inline calls; use a loop",
                        item.names.empty() ? "it" : item.names[0], words, kMaxWords));
            }
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        source_error(at_.first->file, at_.second, message);
    }

    static Words words_of(const Source& source, const Item& item) {
        return {&source, &source.tokens, item.first, item.last};
    }

    void add_macro(const Source& source, const Item& item) {
        const std::vector<Token>& words = source.tokens[item.first].words;
        Definition macro{{&source, &words, 2, words.size()}};
        macro.is_function =
            macro.body.str(2) == "(" && words[2].offset == words[1].offset + words[1].length;
        if (macro.is_function) {
            macro.body.first = words[2].partner + 1;
            for (std::size_t i = 3; i < words[2].partner; ++i)
                if (words[i].kind == TokenKind::Word) macro.params.push_back(source.str(words[i]));
        }
        if (macro.params.size() > kMaxParams)
            source_error(source.file, item.line,
                         fmt::format("expected a macro of at most {} parameters but got {}",
                                     kMaxParams, macro.params.size()));
        macros_[item.names[0]].push_back(std::move(macro));
    }

    /// @param params  of the macro whose words these are
    Count count(const Words& words, const std::vector<std::string_view>& params) {
        if (++depth_ > kMaxDepth)
            fail(fmt::format("macros and calls nest more than {} deep", kMaxDepth));
        Count sum{0, std::vector<double>(params.size())};
        for (std::size_t i = words.first; i < words.last; ++i) {
            const Token& token = (*words.all)[i];
            if (token.kind == TokenKind::Directive) continue;
            ++sum.words;
            if (token.kind != TokenKind::Word) continue;
            const std::string_view word = words.str(i);
            const auto param = std::ranges::find(params, word);
            if (param != params.end()) {
                ++sum.of_params[static_cast<std::size_t>(param - params.begin())];
            } else if (const auto macro = macros_.find(word); macro != macros_.end()) {
                i = add_macro_use(words, i, params, macro->second, sum);
            } else if (words.str(i + 1) == "(") {
                sum.words += function(word);
            }
        }
        --depth_;
        return sum;
    }

    /// Adds the words of the macro call at `i`. @returns its last word
    std::size_t add_macro_use(const Words& words, std::size_t i,
                              const std::vector<std::string_view>& params,
                              std::vector<Definition>& definitions, Count& sum) {
        const bool is_call = words.str(i + 1) == "(";
        std::vector<Count> arguments;
        if (is_call && std::ranges::any_of(definitions, &Definition::is_function)) {
            const std::size_t open = i + 1;
            i = (*words.all)[open].partner;
            arguments = arguments_of({words.source, words.all, open + 1, i}, params);
        }
        // The longest of several definitions, whichever is valid here.
        Count longest{0, std::vector<double>(params.size())};
        for (Definition& macro : definitions) {
            if (macro.is_function && !is_call) continue;
            const Count& body = of(macro);
            Count use{body.words, std::vector<double>(params.size())};
            for (std::size_t k = 0; k < body.of_params.size() && k < arguments.size(); ++k)
                use.add(arguments[k], body.of_params[k]);
            if (use.words >= longest.words) longest = std::move(use);
        }
        sum.add(longest);
        return i;
    }

    /// @param words  between the brackets
    std::vector<Count> arguments_of(Words words, const std::vector<std::string_view>& params) {
        std::vector<Count> arguments;
        const std::size_t end = words.last;
        for (std::size_t i = words.first; i <= end; i = std::max(i, (*words.all)[i].partner) + 1) {
            if (i < end && words.source->str((*words.all)[i]) != ",") continue;
            words.last = i;
            arguments.push_back(count(words, params));
            words.first = i + 1;
        }
        return arguments;
    }

    const Count& of(Definition& definition) {
        static const Count kNothing;
        if (definition.count) return *definition.count;
        if (std::exchange(definition.is_open, true)) return kNothing;
        return definition.count.emplace(count(definition.body, definition.params));
    }

    double function(std::string_view name) {
        double longest = 0;
        if (const auto found = functions_.find(name); found != functions_.end())
            for (Definition& function : found->second)
                longest = std::max(longest, of(function).words);
        return longest;
    }

    Definitions macros_, functions_;
    std::pair<const Source*, int> at_;  ///< file and line for messages
    int depth_ = 0;
};

/// Lengths of arrays that are known.
class Arrays {
  public:
    void check(const Source& source) {
        constants_.add_params(source);
        double elements = 1, in_macro = 1;  // of arrays of arrays
        for (std::size_t i = 0; i < source.tokens.size(); ++i) {
            constants_.add(source, i);
            const std::vector<Token>& words = source.tokens[i].words;
            for (std::size_t k = 0; k < words.size(); ++k)
                in_macro = bracket(source, words, k, in_macro);
            elements = bracket(source, source.tokens, i, elements);
        }
    }

  private:
    /// @returns the number of elements so far. @throws Error for too many
    double bracket(const Source& source, std::span<const Token> tokens, std::size_t i,
                   double elements) const {
        if (source.str(tokens[i]) != "[") return elements;
        if (i == 0 || source.str(tokens[i - 1]) != "]") elements = 1;
        const auto length = tokens.subspan(i + 1, tokens[i].partner - i - 1);
        elements *= constants_.value(source, length).value_or(1);
        if (elements > kMaxElements)
            source_error(source.file, tokens[i].line,
                         fmt::format("[{}]: expected an array of at most {:.0f} elements but got "
                                     "{:.0f}",
                                     trimmed(joined(source, length)), kMaxElements, elements));
        return elements;
    }

    Constants constants_;
};

}  // namespace

void check_growth(const std::vector<Snippet>& files) {
    Growth().check(files);
    Arrays arrays;
    for (const Snippet& file : files)
        arrays.check(file.source);
}

}  // namespace relevo::shader

#include "shader/uses.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/contains.h"

namespace relevo::shader {
namespace {

// A word after one of these is not a declared name.
constexpr std::array<std::string_view, 17> kNotTypes = {
    "return",  "else", "do",      "case",   "in",   "out",     "inout",  "const",        "highp",
    "mediump", "lowp", "precise", "struct", "flat", "uniform", "smooth", "noperspective"};

class UseReader {
  public:
    UseReader(const Source& source, const Item& item) : source_(source), item_(item) {}

    Uses run(const std::vector<bool>& active) {
        for (std::size_t i = item_.first; i < item_.last; ++i) {
            if (!active[i]) continue;
            const Token& token = source_.tokens[i];
            if (token.kind == TokenKind::Directive) directive(token.words);
            if (token.kind == TokenKind::Word) word(i);
            if (token.partner > i) open_.push_back(i);
            if (!open_.empty() && source_.tokens[open_.back()].partner == i) open_.pop_back();
        }
        return std::move(uses_);
    }

  private:
    void directive(const std::vector<Token>& words) {
        // The text of a macro is after its name, and may have calls.
        const bool defines = !words.empty() && source_.str(words[0]) == "define";
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i].kind != TokenKind::Word) continue;
            uses_.names.emplace(source_.str(words[i]));
            if (defines && i > 1 && i + 1 < words.size() && source_.str(words[i + 1]) == "(")
                uses_.calls.emplace(source_.str(words[i]));
        }
    }

    void word(std::size_t i) {
        const std::string_view name = source_.str(i);
        if (i > item_.first && source_.is(i - 1, ".")) return;
        const bool called = source_.is(i + 1, "(");
        const bool is_head =
            called && open_.empty() &&
            (item_.kind == Item::Kind::Function || item_.kind == Item::Kind::Prototype);
        if (is_head) return;  // the function's own name
        if (!called && declares(i)) {
            // In `vec3 n = normalize(n)` the second n is the outer one.
            locals_[name].push_back({source_.until(i, ",;)"), end_of_scope()});
            return;
        }
        if (!called && is_local(name, i)) return;
        uses_.names.emplace(name);
        if (called) uses_.calls.emplace(name);
    }

    // `vec3 name` and `float[3] name` declare; `return name` and `in name` do not.
    bool declares(std::size_t i) const {
        if (item_.kind != Item::Kind::Function || i == item_.first) return false;
        return source_.is_word(i - 1) ? !contains(kNotTypes, source_.str(i - 1))
                                      : source_.is(i - 1, "]");
    }

    bool is_local(std::string_view name, std::size_t i) {
        const auto found = locals_.find(name);
        if (found == locals_.end()) return false;
        std::vector<Scope>& scopes = found->second;
        while (!scopes.empty() && scopes.back().end <= i)
            scopes.pop_back();
        return std::ranges::any_of(scopes, [&](const Scope& scope) { return scope.begin <= i; });
    }

    /// The end of the scope of a name that is declared here: of the block, of the function for its
    /// arguments, of the loop for a name in its head.
    std::size_t end_of_scope() const {
        if (open_.size() < 2) return item_.last;
        const std::size_t open = open_.back();
        if (source_.is(open - 1, "for"))
            return source_.after_statement(source_.tokens[open].partner + 1);
        return source_.tokens[open_[open_.size() - (source_.is(open, "{") ? 1 : 2)]].partner;
    }

    struct Scope {
        std::size_t begin, end;  ///< tokens
    };

    const Source& source_;
    const Item& item_;
    Uses uses_;
    std::map<std::string_view, std::vector<Scope>> locals_;
    std::vector<std::size_t> open_;  ///< brackets around the token
};

}  // namespace

Uses uses_of(const Source& source, const Item& item, const std::vector<bool>& active) {
    return UseReader(source, item).run(active);
}

std::set<std::string> reachable(std::vector<std::string> names, const UsesOf& uses) {
    std::set<std::string> reached;
    while (!names.empty()) {
        const std::string name = names.back();
        names.pop_back();
        const auto found = uses.find(name);
        if (!reached.insert(name).second || found == uses.end()) continue;
        for (const auto* needed : {&found->second.names, &found->second.calls})
            names.insert(names.end(), needed->begin(), needed->end());
    }
    return reached;
}

}  // namespace relevo::shader

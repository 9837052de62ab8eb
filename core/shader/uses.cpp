#include "shader/uses.h"

#include <algorithm>
#include <array>

#include "base/contains.h"

namespace relevo::shader {
namespace {

// A word after one of these is not a declared name.
constexpr std::array<std::string_view, 17> kNotTypes = {
    "return",  "else", "do",      "case",   "in",   "out",     "inout",  "const",        "highp",
    "mediump", "lowp", "precise", "struct", "flat", "uniform", "smooth", "noperspective"};

class UseReader {
  public:
    UseReader(const Source& source, const Item& item, const std::vector<bool>& active)
        : source_(source), item_(item), active_(active) {}

    Uses run() {
        scopes_.emplace_back();
        for (std::size_t i = item_.first; i < item_.last; ++i) {
            if (!active_[i]) continue;
            const Token& token = source_.tokens[i];
            if (token.kind == TokenKind::Directive) {
                directive(token);
            } else if (token.kind == TokenKind::Word) {
                word(i);
            } else {
                mark(source_.str(token));
            }
        }
        return std::move(uses_);
    }

  private:
    std::string_view str(std::size_t i) const { return source_.str(source_.tokens[i]); }

    void directive(const Token& token) {
        const std::vector<Token> words = directive_tokens(source_.text, token, source_.file);
        // The text of a macro is after its name, and may have calls.
        const bool defines = !words.empty() && source_.str(words[0]) == "define";
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (words[i].kind != TokenKind::Word) continue;
            uses_.names.emplace(source_.str(words[i]));
            const bool called =
                defines && i > 1 && i + 1 < words.size() && source_.str(words[i + 1]) == "(";
            if (called) uses_.calls.emplace(source_.str(words[i]));
        }
    }

    bool is_local(std::string_view name) const {
        return std::ranges::any_of(scopes_,
                                   [&](const auto& scope) { return scope.count(name) > 0; });
    }

    // `vec3 name` and `float[3] name` declare; `return name` and `in name` do not.
    bool declares(std::size_t i) const {
        if (item_.kind != Item::Kind::Function || i == item_.first) return false;
        if (source_.tokens[i - 1].kind == TokenKind::Word) return !contains(kNotTypes, str(i - 1));
        return str(i - 1) == "]";
    }

    void word(std::size_t i) {
        const std::string name(str(i));
        if (name == "for") begin_loop();
        if (i > item_.first && str(i - 1) == ".") return;
        const bool called = i + 1 < item_.last && str(i + 1) == "(";
        const bool head = item_.kind == Item::Kind::Function || item_.kind == Item::Kind::Prototype;
        if (head && !head_read_ && called) {
            head_read_ = true;  // the function's own name
            return;
        }
        if (!called && declares(i)) {
            pending_.push_back({name, depth_});
            return;
        }
        if (!called && is_local(name)) return;
        uses_.names.insert(name);
        if (called) uses_.calls.insert(name);
    }

    // The scope of a name begins after its declarator: in `vec3 n = normalize(n)` the second n is
    // the outer one.
    void declare_pending() {
        for (auto name = pending_.begin(); name != pending_.end();) {
            if (name->depth < depth_) {
                ++name;
                continue;
            }
            scopes_.back().insert(name->name);
            name = pending_.erase(name);
        }
    }

    /// The scope of a declaration in a loop's head ends with the body.
    struct Loop {
        int depth;           // its depth of ( and [
        std::size_t scopes;  // including its own
        bool in_head = true;
        bool has_block = false;
    };
    void begin_loop() {
        scopes_.emplace_back();
        loops_.push_back({depth_, scopes_.size()});
    }
    /// A statement ends, with the loops whose body it is.
    /// @param with_block  at the } of a block
    void end_loops(bool with_block) {
        while (!loops_.empty()) {
            const Loop& loop = loops_.back();
            if (loop.in_head || loop.depth != depth_ || loop.scopes != scopes_.size()) return;
            if (loop.has_block && !with_block) return;
            scopes_.pop_back();
            loops_.pop_back();
        }
    }

    void mark(std::string_view text) {
        if (text == "(" || text == "[") {
            ++depth_;
        } else if (text == ")" || text == "]") {
            // Arguments of a function end at its `)`, declarators inside a for(...) at their `;`.
            declare_pending();
            --depth_;
            if (!loops_.empty() && loops_.back().depth == depth_) loops_.back().in_head = false;
        } else if (text == "," || text == ";") {
            declare_pending();
            if (text == ";") end_loops(/*with_block=*/false);
        } else if (text == "{") {
            if (!loops_.empty() && loops_.back().scopes == scopes_.size())
                loops_.back().has_block = true;
            scopes_.emplace_back();
        } else if (text == "}") {
            if (scopes_.size() > 1) scopes_.pop_back();
            end_loops(/*with_block=*/true);
        }
    }

    struct Pending {
        std::string name;
        int depth;  // its depth of ( and [
    };

    const Source& source_;
    const Item& item_;
    const std::vector<bool>& active_;
    Uses uses_;
    std::vector<std::set<std::string, std::less<>>> scopes_;
    std::vector<Pending> pending_;
    std::vector<Loop> loops_;
    int depth_ = 0;
    bool head_read_ = false;
};

}  // namespace

Uses uses_of(const Source& source, const Item& item, const std::vector<bool>& active) {
    return UseReader(source, item, active).run();
}

}  // namespace relevo::shader

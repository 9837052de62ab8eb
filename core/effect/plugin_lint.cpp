#include "effect/plugin_lint.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/text.h"
#include "shader/limits.h"
#include "shader/uses.h"

namespace relevo::effect {
namespace {

/// Functions that need the derivatives of their arguments over the image.
constexpr std::array<std::string_view, 8> kDerivatives = {
    "dFdx", "dFdy", "fwidth", "dFdxFine", "dFdyFine", "fwidthFine", "texture", "textureOffset"};

class Linter {
  public:
    Linter(const Effect& effect, const Registry& registry) : effect_(effect), registry_(registry) {}

    std::vector<Finding> run() {
        for (const auto check :
             {&Linter::check_words, &Linter::check_loops, &Linter::check_parameters,
              &Linter::check_passes, &Linter::check_derivatives, &Linter::check_ambient})
            (this->*check)();
        return std::move(findings_);
    }

  private:
    void add(bool is_error, const std::string& file, int line, const std::string& text) {
        findings_.push_back({is_error, fmt::format("{}:{}: {}", file, line, text)});
    }

    // ---- the manifest

    void check_words() {
        const Manifest& manifest = effect_.manifest;
        const std::vector<std::string> provided = registry_.provided_words();
        const auto check = [&](const char* key, const std::vector<std::string>& words,
                               bool is_error) {
            for (const std::string& word : words) {
                if (contains(provided, word) || (!is_error && is_core_word(word))) continue;
                add(is_error, manifest.file.string(), line_of(key, word),
                    fmt::format("{}: no installed plugin provides \"{}\"{}", key, word,
                                suggestion(word, provided)));
            }
        };
        check("requires", manifest.needs, true);
        check("wants", manifest.wants, false);
        check("after", manifest.after, false);
    }

    static std::string suggestion(const std::string& word,
                                  const std::vector<std::string>& provided) {
        if (const std::optional<std::string> near = nearest(word, provided))
            return fmt::format("; did you mean \"{}\"?", *near);
        return provided.empty() ? "" : fmt::format("; there are {}", fmt::join(provided, ", "));
    }

    /// The line of a word in the list of a key.
    int line_of(const std::string& key, const std::string& word) const {
        const std::string text = read_text(effect_.manifest.file, "plugin");
        const std::size_t list = text.find('"' + key + '"');
        const std::size_t at = text.find('"' + word + '"', list == text.npos ? 0 : list);
        const auto end =
            text.begin() + static_cast<std::ptrdiff_t>(at == text.npos ? text.size() : at);
        return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
    }

    // ---- the GLSL

    void check_loops() {
        for (const shader::Snippet& snippet : effect_.snippets)
            for (const int line : shader::open_loops(snippet.source))
                add(false, snippet.file, line,
                    "this loop has no constant bound and may never end; write for (int i = 0; i < "
                    "N; ++i) with a constant N "
                    "of at most 10000");
    }

    /// The names that functions need, their own included.
    std::set<std::string> reached_from(const std::vector<std::string>& functions) const {
        shader::UsesOf uses;
        for (const shader::Snippet& snippet : effect_.snippets) {
            const std::vector<bool> active(snippet.source.tokens.size(), true);
            for (const shader::Item& item : snippet.source.items)
                for (const std::string& name : item.names)
                    uses[name].names.merge(shader::uses_of(snippet.source, item, active).names);
        }
        return shader::reachable(functions, uses);
    }

    /// Functions of hooks that have this in their heads.
    std::vector<std::string> hook_functions(std::string_view head) const {
        std::vector<std::string> functions;
        for (const shader::Snippet& snippet : effect_.snippets)
            for (const shader::HookFunction& function : snippet.hooks)
                if (function.hook->signature.find(head) != std::string_view::npos)
                    functions.push_back(function.name);
        return functions;
    }

    /// Calls a function with each token of these functions, and its file.
    template <typename Visit>
    void each_token(const std::set<std::string>& within, const Visit& visit) const {
        for (const shader::Snippet& snippet : effect_.snippets)
            for (const shader::Item& item : snippet.source.items)
                if (item.kind == shader::Item::Kind::Function && within.contains(item.names[0]))
                    for (std::size_t i = item.first; i < item.last; ++i)
                        visit(snippet.source, i);
    }

    /// Parameters that the manifest, a ramp or a directive names are read, too.
    std::set<std::string> named_elsewhere() const {
        std::set<std::string> addresses;
        if (effect_.manifest.displaces)
            for (const DisplaceSpec::Length* length : effect_.manifest.displaces->lengths())
                addresses.insert(length->address);
        if (effect_.manifest.invents) addresses.insert(effect_.manifest.invents->address);
        if (effect_.manifest.weather)
            for (const WeatherSpec::Setting& setting : effect_.manifest.weather->settings)
                addresses.insert(setting.address);
        for (const MarksSpec& marks : effect_.manifest.marks)
            for (const MarkKey& key : mark_keys())
                addresses.insert((marks.*key.member).address);
        for (const shader::ColourRamp& ramp : effect_.ramps())
            addresses.insert({ramp.from.address, ramp.to.address, ramp.where});
        return addresses;
    }

    void check_parameters() {
        if (!effect_.manifest.module.empty()) return;  // modules may read any
        std::vector<std::string> called = hook_functions("");
        for (const shader::PluginPass& pass : effect_.manifest.passes)
            called.push_back(pass.function);
        for (const shader::InstanceSet& set : effect_.manifest.instances)
            called.push_back(set.function);
        const std::set<std::string> reached = reached_from(called);
        const std::set<std::string> named = named_elsewhere();
        for (const shader::Param& param : effect_.params())
            if (!reached.contains(param.name) && !named.contains(param.address))
                add(false, param.file, param.line,
                    fmt::format("{}: no hook reads this parameter; use it or remove it",
                                param.name));
    }

    /// What nothing reads is never computed. Other plugins may read it.
    void check_passes() {
        std::set<std::string> read;
        for (const Effect& effect : registry_.effects())
            for (const shader::Snippet& snippet : effect.snippets)
                for (const shader::Sampler& sampler : snippet.source.samplers)
                    read.insert(sampler.resource);
        for (const shader::PluginPass& pass : effect_.manifest.passes)
            if (!read.contains(pass.resource))
                add(false, effect_.manifest.file.string(), pass.line,
                    fmt::format("passes.{}: nothing reads it, so it is never computed; add uniform "
                                "{} {}_{}, or remove it",
                                pass.name, shader::sampler_of(pass.output), effect_.id(),
                                pass.name));
    }

    void check_derivatives() {
        const auto check = [&](const shader::Source& source, std::size_t i) {
            const std::string_view word = source.str(i);
            if (!contains(kDerivatives, word) || !source.is(i + 1, "(")) return;
            add(false, source.file, source.tokens[i].line,
                fmt::format("{}: the next pixel may be other ground, so derivatives are wrong; {}",
                            word,
                            word.starts_with("texture")
                                ? "use textureGrad with s.ground_dx_m and s.ground_dy_m"
                                : "use s.height_dx_m, s.height_dy_m, s.ground_dx_m or "
                                  "s.ground_dy_m"));
        };
        each_token(reached_from(hook_functions("Surface")), check);
    }

    /// Ground that is painted in direct light alone keeps its earlier colour in shade.
    void check_ambient() {
        for (const std::string& hook : hook_functions("inout Surface")) {
            std::string file;
            int line = 0;  // that sets diffuse first
            bool sets_ambient = false;
            each_token(reached_from({hook}), [&](const shader::Source& source, std::size_t i) {
                // s.diffuse = or s.diffuse.r =
                if (!source.is(i - 1, ".") || source.writes(i) != "=") return;
                sets_ambient = sets_ambient || source.is(i, "ambient");
                if (!source.is(i, "diffuse") || line > 0) return;
                file = source.file;
                line = source.tokens[i].line;
            });
            if (line == 0 || sets_ambient) continue;
            add(false, file, line,
                fmt::format("{} sets diffuse without ambient, so the ground keeps its earlier "
                            "colour in the sky's light and in shade; set s.ambient, too",
                            hook));
        }
    }

    const Effect& effect_;
    const Registry& registry_;
    std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> lint(const Effect& effect, const Registry& registry) {
    return Linter(effect, registry).run();
}

}  // namespace relevo::effect

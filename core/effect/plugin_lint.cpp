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
#include "shader/loops.h"
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
        check_words();
        check_loops();
        check_parameters();
        check_passes();
        check_derivatives();
        check_ambient();
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
    std::set<std::string> reached_from(std::vector<std::string> pending) const {
        std::map<std::string, std::set<std::string>> uses;
        for (const shader::Snippet& snippet : effect_.snippets) {
            const std::vector<bool> active(snippet.source.tokens.size(), true);
            for (const shader::Item& item : snippet.source.items) {
                const shader::Uses used = shader::uses_of(snippet.source, item, active);
                for (const std::string& name : item.names)
                    uses[name].insert(used.names.begin(), used.names.end());
            }
        }
        std::set<std::string> reached;
        while (!pending.empty()) {
            const std::string name = pending.back();
            pending.pop_back();
            if (!reached.insert(name).second) continue;
            if (const auto found = uses.find(name); found != uses.end())
                pending.insert(pending.end(), found->second.begin(), found->second.end());
        }
        return reached;
    }

    template <typename Wanted>
    std::vector<std::string> hook_functions(const Wanted& wanted) const {
        std::vector<std::string> functions;
        for (const shader::Snippet& snippet : effect_.snippets)
            for (const shader::HookFunction& function : snippet.hooks)
                if (wanted(function)) functions.push_back(function.name);
        return functions;
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
        std::vector<std::string> called = hook_functions([](const auto&) { return true; });
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
        const std::vector<shader::Sampler> samplers = [&] {
            std::vector<shader::Sampler> all;
            for (const effect::Effect& effect : registry_.effects())
                for (const shader::Snippet& snippet : effect.snippets)
                    all.insert(all.end(), snippet.source.samplers.begin(),
                               snippet.source.samplers.end());
            return all;
        }();
        for (const shader::PluginPass& pass : effect_.manifest.passes)
            if (std::ranges::find(samplers, pass.resource, &shader::Sampler::resource) ==
                samplers.end())
                add(false, effect_.manifest.file.string(), pass.line,
                    fmt::format("passes.{}: nothing reads it, so it is never computed; add uniform "
                                "{} {}_{}, or remove it",
                                pass.name, shader::sampler_of(pass.output), effect_.id(),
                                pass.name));
    }

    void check_derivatives() {
        const std::set<std::string> reached =
            reached_from(hook_functions([](const shader::HookFunction& function) {
                return function.hook->signature.find("Surface") != std::string_view::npos;
            }));
        for (const shader::Snippet& snippet : effect_.snippets)
            for (const shader::Item& item : snippet.source.items)
                if (item.kind == shader::Item::Kind::Function && reached.contains(item.names[0]))
                    check_derivatives(snippet, item);
    }

    void check_derivatives(const shader::Snippet& snippet, const shader::Item& item) {
        const shader::Source& source = snippet.source;
        for (std::size_t i = item.first; i + 1 < item.last; ++i) {
            const std::string_view word = source.str(i);
            if (!contains(kDerivatives, word) || !source.is(i + 1, "(")) continue;
            add(false, snippet.file, source.tokens[i].line,
                fmt::format("{}: the next pixel may be other ground, so derivatives are wrong; {}",
                            word,
                            word.starts_with("texture")
                                ? "use textureGrad with s.ground_dx_m and s.ground_dy_m"
                                : "use s.height_dx_m, s.height_dy_m, s.ground_dx_m or "
                                  "s.ground_dy_m"));
        }
    }

    /// Where functions assign a member of Surface: "s.diffuse =" or "s.diffuse.r =".
    /// @param within  names of the functions
    /// @returns files and lines
    std::vector<std::pair<std::string, int>> assignments(
        std::string_view member, const std::set<std::string>& within) const {
        std::vector<std::pair<std::string, int>> found;
        for (const shader::Snippet& snippet : effect_.snippets) {
            const shader::Source& source = snippet.source;
            for (const shader::Item& item : source.items) {
                if (item.kind != shader::Item::Kind::Function || !within.contains(item.names[0]))
                    continue;
                for (std::size_t i = item.first; i < item.last; ++i)
                    if (source.is(i, ".") && source.is(i + 1, member) &&
                        source.writes(i + 1) == "=")
                        found.emplace_back(snippet.file, source.tokens[i].line);
            }
        }
        return found;
    }

    /// Ground that is painted in direct light alone keeps its earlier colour in shade.
    void check_ambient() {
        for (const std::string& hook : hook_functions([](const shader::HookFunction& function) {
                 return function.hook->signature.find("inout Surface") != std::string_view::npos;
             })) {
            const std::set<std::string> reached = reached_from({hook});
            const auto painted = assignments("diffuse", reached);
            if (painted.empty() || !assignments("ambient", reached).empty()) continue;
            add(false, painted[0].first, painted[0].second,
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

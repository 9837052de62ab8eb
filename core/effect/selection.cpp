#include "effect/selection.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"

namespace relevo::effect {
namespace {

constexpr std::string_view kSelectionWho = "effects";

class Selector {
  public:
    Selector(const Registry& registry, const std::vector<Preset>& presets,
             const Switches& command_line, const Unusable& unusable, const GroundWords& ground)
        : registry_(registry), command_line_(command_line) {
        for (const Effect& effect : registry.effects())
            if (effect.manifest.enabled_by_default && !lacking(effect, ground))
                on_.insert(effect.id());
        for (const Preset& preset : presets)
            apply(known_of(preset));
        check_command_line(command_line);
        apply(command_line);
        for (const std::string& id : on_)
            if (const auto word = lacking(effect(id), ground))
                notices_.push_back(fmt::format("{} is on, but this DEM has no {}", id, *word));
        for (const auto& [id, reason] : unusable) {
            if (on_.erase(id) > 0) warn_off(id, reason);
            asked_.erase(id);
            unmet_.insert(id);
            broken_.insert(id);
        }
    }

    Selection run() {
        do {
            while (meet_requirements()) {
            }
        } while (settle_exclusive_words());
        check_exclusive_hooks();
        Selection selection;
        selection.effects = ordered();
        selection.over_overlay = over_overlay(selection.effects);
        selection.lit_overlay_is_over_all = std::ranges::none_of(
            selection.effects, [&](const Effect* one) { return is_over_overlay(one->id()); });
        std::set<std::string> words;
        for (const Effect* effect : selection.effects)
            words.insert(effect->manifest.provides.begin(), effect->manifest.provides.end());
        selection.capabilities.assign(words.begin(), words.end());
        selection.notices = std::move(notices_);
        selection.warnings = std::move(warnings_);
        selection.refused = std::move(refused_);
        return selection;
    }

  private:
    const Effect& effect(const std::string& id) const {
        return registry_.effect(id, kSelectionWho);
    }

    /// Features that an effect needs and the DEM lacks, for messages.
    static std::optional<std::string> lacking(const Effect& effect, const GroundWords& ground) {
        if (!ground) return std::nullopt;
        for (std::string word : effect.manifest.default_where) {
            if (contains(*ground, word)) continue;
            std::ranges::replace(word, '_', ' ');
            return word;
        }
        return std::nullopt;
    }

    // ---- switches

    /// A preset's switches without unknown plugins.
    Switches known_of(const Preset& preset) {
        const auto known = [&](const std::vector<std::string>& ids) {
            std::vector<std::string> result;
            for (const std::string& id : ids) {
                if (registry_.find(id))
                    result.push_back(id);
                else
                    notices_.push_back(
                        fmt::format("{}: {} is skipped, there is no such plugin", preset.file, id));
            }
            return result;
        };
        Switches switches;
        if (preset.switches.only) switches.only = known(*preset.switches.only);
        switches.enable = known(preset.switches.enable);
        switches.disable = known(preset.switches.disable);
        return switches;
    }

    void check_command_line(const Switches& switches) const {
        const std::vector<std::string> only = switches.only.value_or(std::vector<std::string>{});
        for (const auto* ids : {&only, &switches.enable, &switches.disable})
            for (const std::string& id : *ids)
                if (ids != &switches.disable || !registry_.is_broken(id)) effect(id);
        for (const std::string& id : switches.disable)
            if (contains(switches.enable, id) || contains(only, id))
                bad_input(fmt::format("{}: {}: expected it either on or off but got both",
                                      kSelectionWho, id));
        check_order(switches.order);
    }

    void check_order(const std::vector<std::string>& order) const {
        for (auto id = order.begin(); id != order.end(); ++id) {
            if (*id != kOverlay && !registry_.is_broken(*id)) effect(*id);
            if (std::find(order.begin(), id, *id) != id)
                bad_input(fmt::format("{}: order: {} is named twice", kSelectionWho, *id));
        }
    }

    void apply(const Switches& switches) {
        const auto ask = [&](const std::string& id) {
            on_.insert(id);
            asked_.insert(id);
            disabled_.erase(id);
            turns_[id] = ++turn_;
        };
        if (switches.only) {
            on_.clear();
            asked_.clear();
            disabled_.clear();
            turns_.clear();
            for (const std::string& id : *switches.only)
                ask(id);
        }
        for (const std::string& id : switches.enable)
            ask(id);
        for (const std::string& id : switches.disable) {
            on_.erase(id);
            asked_.erase(id);
            disabled_.insert(id);
        }
    }

    // ---- requirements

    bool is_provided(const std::string& word) const {
        return std::ranges::any_of(
            on_, [&](const std::string& id) { return effect(id).provides(word); });
    }

    /// Providers that are off, those that would be on by default first.
    std::vector<const Effect*> providers(const std::string& word) const {
        std::vector<const Effect*> result;
        for (const Effect& effect : registry_.effects())
            if (effect.provides(word)) result.push_back(&effect);
        std::ranges::stable_partition(
            result, [](const Effect* effect) { return effect->manifest.enabled_by_default; });
        return result;
    }

    /// Resolves one unmet requirement. @returns false if there is none
    bool meet_requirements() {
        for (const std::string& id : on_) {
            for (const std::string& word : effect(id).manifest.needs) {
                if (is_provided(word)) continue;
                if (asked_.count(id) == 0 || !pull_in(id, word)) switch_off(id, word);
                return true;
            }
        }
        return false;
    }

    bool pull_in(const std::string& id, const std::string& word) {
        for (const Effect* provider : providers(word)) {
            if (disabled_.count(provider->id()) > 0 || unmet_.count(provider->id()) > 0) continue;
            notices_.push_back(
                fmt::format("{} requires {}: {} is switched on too", id, word, provider->id()));
            on_.insert(provider->id());
            asked_.insert(provider->id());
            turns_[provider->id()] = turn_of(id);
            return true;
        }
        return false;
    }

    void switch_off(const std::string id, const std::string& word) {
        std::vector<std::string> offers;
        bool needs_broken = false;
        for (const Effect* provider : providers(word)) {
            needs_broken = needs_broken || broken_.count(provider->id()) > 0;
            const bool disabled = disabled_.count(provider->id()) > 0;
            const bool unmet = unmet_.count(provider->id()) > 0;
            offers.push_back(
                fmt::format("{} is {}", provider->id(),
                            disabled ? "disabled"
                            : unmet  ? "off"
                                     : "off, --enable " + provider->id() + " changes that"));
        }
        const std::string reason =
            fmt::format("it requires {}, {}", word,
                        offers.empty() ? "which no plugin here provides" + suggestion(word)
                                       : fmt::format("{}", fmt::join(offers, "; ")));
        if (needs_broken) {
            broken_.insert(id);
            warn_off(id, reason);
        } else {
            notices_.push_back(fmt::format("{} is off: {}", id, reason));
            refuse_named(id, reason, word);
        }
        reasons_[id] = reason;
        on_.erase(id);
        asked_.erase(id);
        unmet_.insert(id);
    }

    /// "; did you mean materials?" for a word that is nearly one that a plugin provides.
    std::string suggestion(const std::string& word) const {
        const std::optional<std::string> near = nearest(word, registry_.provided_words());
        return near ? fmt::format("; did you mean {}?", *near) : "";
    }

    /// The option of the command line that switches an effect on by name; empty: none.
    std::string_view named_by(const std::string& id) const {
        if (command_line_.only && contains(*command_line_.only, id)) return "--only";
        return contains(command_line_.enable, id) ? "--enable" : "";
    }

    std::string refusal(const std::string& id, const std::string& reason) const {
        return fmt::format("{}: {}: it cannot be switched on: {}; take it out of {}", kSelectionWho,
                           id, reason, named_by(id));
    }

    void refuse_named(const std::string& id, const std::string& reason, const std::string& word) {
        if (named_by(id).empty()) return;
        // A provider that is off has a reason itself.
        std::string whole = reason;
        for (const Effect* provider : providers(word))
            if (const auto why = reasons_.find(provider->id()); why != reasons_.end())
                whole += fmt::format(" ({})", why->second);
        refused_.push_back(refusal(id, whole));
    }

    /// Warns that an effect is off because something is broken.
    /// @throws Error if the command line asks for that effect by name
    void warn_off(const std::string& id, const std::string& reason) {
        if (!named_by(id).empty()) bad_input(refusal(id, reason));
        warnings_.push_back(
            fmt::format("{} is off: {}; --disable {} silences this", id, reason, id));
    }

    // ---- exclusive words

    /// A word that both provide and one has as `exclusive`; or empty.
    static std::string rival_word(const Effect& a, const Effect& b) {
        for (const std::string& word : a.manifest.exclusive)
            if (std::ranges::find(b.manifest.exclusive, word) != b.manifest.exclusive.end())
                return word;
        return "";
    }

    /// Of two effects that cannot both be on, switches off the one that was requested earlier.
    /// @returns whether there were two
    bool settle_exclusive_words() {
        for (const std::string& id : on_) {
            for (const std::string& other : on_) {
                if (!(id < other)) continue;
                const std::string word = rival_word(effect(id), effect(other));
                if (word.empty()) continue;
                const bool is_earlier = turn_of(id) < turn_of(other);
                give_way(is_earlier ? id : other, is_earlier ? other : id, word);
                return true;
            }
        }
        return false;
    }

    int turn_of(const std::string& id) const {
        const auto found = turns_.find(id);
        return found == turns_.end() ? 0 : found->second;
    }

    void give_way(const std::string id, const std::string& other, const std::string& word) {
        notices_.push_back(
            fmt::format("{} is off: {} provides {} in its place; --disable {} brings it back", id,
                        other, word, other));
        on_.erase(id);
        asked_.erase(id);
        unmet_.insert(id);
    }

    // ---- hooks and order

    void check_exclusive_hooks() const {
        for (const shader::Hook& hook : shader::hooks()) {
            if (hook.kind == shader::HookKind::Chain) continue;
            std::vector<std::string> ids, mends;
            for (const std::string& id : on_) {
                if (!effect(id).answers(hook.name)) continue;
                ids.push_back(id);
                mends.push_back("--disable " + id);
            }
            if (ids.size() > 1)
                bad_input(fmt::format(
                    "{}: {}: expected one provider of this exclusive hook but got {}; add {}",
                    kSelectionWho, hook.name, fmt::join(ids, " and "), fmt::join(mends, " or ")));
        }
    }

    /// Effects that must come before, and the word of `after`.
    std::map<std::string, std::string> before(const std::string& id) const {
        const std::vector<std::string>& order = command_line_.order;
        const auto place = std::ranges::find(order, id);
        std::map<std::string, std::string> result;
        for (const std::string& word : effect(id).manifest.after)
            for (const std::string& other : on_)
                if (other != id && effect(other).provides(word) &&
                    std::find(place, order.end(), other) == order.end())
                    result.emplace(other, word);
        if (place == order.end()) return result;
        for (const std::string& other : on_)
            if (std::find(order.begin(), place, other) != place) result.emplace(other, "order");
        return result;
    }

    /// Whether the order names an effect after the scene's overlay.
    bool is_over_overlay(const std::string& id) const {
        const std::vector<std::string>& order = command_line_.order;
        return std::find(std::ranges::find(order, kOverlay), order.end(), id) != order.end();
    }

    /// Effects over the scene's overlay, which lies directly under the first that the order names
    /// after it, or else over the last that it names before it. nullopt if it names none of both.
    std::optional<std::vector<std::string>> over_overlay(
        const std::vector<const Effect*>& effects) const {
        const std::vector<std::string>& order = command_line_.order;
        const auto overlay = std::ranges::find(order, kOverlay);
        if (overlay == order.end()) return std::nullopt;
        const auto is_over = [&](const Effect* one) { return is_over_overlay(one->id()); };
        const auto is_under = [&](const Effect* one) {
            return std::find(order.begin(), overlay, one->id()) != overlay;
        };
        auto first = std::ranges::find_if(effects, is_over);
        if (first == effects.end()) {
            first = std::find_if(effects.rbegin(), effects.rend(), is_under).base();
            if (first == effects.begin()) return std::nullopt;
        }
        std::vector<std::string> ids;
        for (; first != effects.end(); ++first)
            ids.push_back((*first)->id());
        return ids;
    }

    std::vector<const Effect*> ordered() const {
        std::vector<const Effect*> order;
        std::set<std::string> left = on_;
        while (!left.empty()) {
            const auto next = std::ranges::find_if(left, [&](const std::string& id) {
                const auto others = before(id);
                return std::ranges::none_of(
                    others, [&](const auto& other) { return left.count(other.first) > 0; });
            });
            if (next == left.end()) fail_circle(left);
            order.push_back(&effect(*next));
            left.erase(next);
        }
        return order;
    }

    /// Every effect of `left` must come after another of `left`: going back meets one twice.
    [[noreturn]] void fail_circle(const std::set<std::string>& left) const {
        std::vector<std::string> path = {*left.begin()};
        while (true) {
            const auto others = before(path.back());
            const auto next = std::ranges::find_if(
                others, [&](const auto& other) { return left.count(other.first) > 0; });
            const auto seen = std::ranges::find(path, next->first);
            if (seen == path.end()) {
                path.push_back(next->first);
                continue;
            }
            path.erase(path.begin(), seen);
            break;
        }
        std::vector<std::string> links, files;
        for (std::size_t i = 0; i < path.size(); ++i) {
            const std::string& other = path[(i + 1) % path.size()];
            links.push_back(
                fmt::format("{} after {} ({})", path[i], other, before(path[i]).at(other)));
            files.push_back(effect(path[i]).manifest.file.string());
        }
        bad_input(fmt::format("{}: {}: their order is circular: {}; change \"after\" in {}",
                              kSelectionWho, fmt::join(path, " and "), fmt::join(links, ", "),
                              fmt::join(files, " or ")));
    }

    const Registry& registry_;
    const Switches& command_line_;
    std::set<std::string> on_;
    std::set<std::string> asked_;       // by name, or as a requirement of such effects
    std::map<std::string, int> turns_;  // order in which effects were asked for, from 1
    int turn_ = 0;
    std::set<std::string> disabled_;  // by name
    std::set<std::string> unmet_;     // switched off here
    std::set<std::string> broken_;    // of those, unusable ones and those that require them
    std::map<std::string, std::string> reasons_;  // of those that lack a requirement
    std::vector<std::string> notices_, warnings_, refused_;
};

}  // namespace

bool Selection::has(std::string_view id) const {
    return std::ranges::find(effects, id, &Effect::id) != effects.end();
}

std::vector<const shader::Snippet*> Selection::snippets() const {
    std::vector<const shader::Snippet*> result;
    for (const Effect* effect : effects)
        for (const shader::Snippet& snippet : effect->snippets)
            result.push_back(&snippet);
    return result;
}

std::vector<shader::PluginPass> Selection::passes() const {
    std::vector<shader::PluginPass> result;
    for (const Effect* effect : effects)
        result.insert(result.end(), effect->manifest.passes.begin(), effect->manifest.passes.end());
    return result;
}

shader::StitchInput Selection::stitch_input() const {
    shader::StitchInput input{.snippets = snippets(), .capabilities = capabilities};
    input.passes = passes();
    for (const Effect* effect : effects)
        input.instances.insert(input.instances.end(), effect->manifest.instances.begin(),
                               effect->manifest.instances.end());
    input.over_overlay = over_overlay;
    input.lit_overlay_is_over_all = lit_overlay_is_over_all;
    return input;
}

Selection select(const Registry& registry, const std::vector<Preset>& presets,
                 const Switches& command_line, const Unusable& unusable,
                 const GroundWords& ground) {
    return Selector(registry, presets, command_line, unusable, ground).run();
}

}  // namespace relevo::effect

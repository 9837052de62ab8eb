#include "shader/stage.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "shader/annotation.h"

namespace relevo::shader {
namespace {

constexpr std::string_view kHookPrefix = "hook_";

bool is_service(const Hook& hook) {
    return hook.kind == HookKind::Service;
}

}  // namespace

const Source* CoreLibrary::find(SourceKind kind, const std::string& name) {
    if (const auto known = sources_.find(name); known != sources_.end()) return known->second.get();
    const std::optional<std::string> text = texts_.text(name);
    if (!text) return nullptr;
    auto source = std::make_unique<Source>(parse_source(kind, "core", texts_.file(name), *text));
    return sources_.emplace(name, std::move(source)).first->second.get();
}

std::string CoreLibrary::library_of(const std::string& function) {
    if (!functions_) {
        functions_.emplace();
        for (const std::string& name : texts_.libraries())
            for (const Item& item : find(SourceKind::Lib, name)->items)
                if (item.kind == Item::Kind::Function) functions_->emplace(item.names[0], name);
    }
    const auto found = functions_->find(function);
    return found == functions_->end() ? "" : found->second;
}

std::optional<std::string> CoreLibrary::nearest_library(const std::string& name) const {
    return nearest(name, texts_.libraries());
}

Stage::Stage(CoreLibrary& library, const ProgramRecipe& program, const StitchInput& input,
             StageKind kind)
    : library_(library), input_(input), kind_(kind), output_(program.output) {
    const bool vertex = kind == StageKind::Vertex;
    const std::string& main = vertex                       ? program.vertex_main
                              : kind == StageKind::Compute ? program.compute_main
                                                           : program.fragment_main;
    const Source* const main_source =
        core_source(vertex ? SourceKind::VertexMain : SourceKind::FragmentMain, main);
    const Source* const defaults = core_source(SourceKind::Defaults, "defaults.glsl");
    add_unit(UnitRole::Types, core_source(SourceKind::Lib, "lib/types.glsl"), "lib/types.glsl");
    add_unit(UnitRole::Frame, core_source(SourceKind::Lib, "lib/frame.glsl"), "lib/frame.glsl");
    // Core's items first: plugins must not change its text.
    std::vector<std::string> pending;
    add_includes(*main_source, pending);
    add_includes(*defaults, pending);
    for (const Snippet* snippet : input.snippets)
        add_includes(snippet->source, pending);
    add_unit(UnitRole::Defaults, defaults, "defaults.glsl");
    for (const Snippet* snippet : input.snippets)
        add_unit(UnitRole::Snippet, &snippet->source,
                 std::filesystem::path(snippet->file).filename().string());
    add_unit(UnitRole::Main, main_source, main);

    Macros macros;
    for (const Define& define : program.defines)
        macros[define.name] = define.value;
    for (const Snippet* snippet : input.snippets)
        for (const Wanted& wanted : snippet->wanted)
            macros[std::string(kHasPrefix) + wanted.word] = "0";
    for (const std::string& capability : input.capabilities)
        macros[std::string(kHasPrefix) + capability] = "1";
    index(std::move(macros));
}

// ---- files

void Stage::add_unit(UnitRole role, const Source* source, std::string title) {
    units_.push_back({role, source, std::move(title), {}, {}});
}

const Source* Stage::core_source(SourceKind kind, const std::string& name) {
    const Source* const source = library_.find(kind, name);
    if (!source) failed(fmt::format("shader: {}: core has no such shader file", name));
    return source;
}

std::string Stage::no_library(const Source& source, const Include& include) const {
    const std::optional<std::string> near = library_.nearest_library(include.name);
    return fmt::format("shader: {}:{}: {}: core has no such file{}", source.file, include.line,
                       include.name, near ? fmt::format("; did you mean {}?", *near) : "");
}

// Depth first: a file comes after its includes.
void Stage::add_includes(const Source& source, std::vector<std::string>& pending) {
    for (const Include& include : source.includes) {
        const Source* const lib = library_.find(SourceKind::Lib, include.name);
        if (!lib) throw AuthorError(source.owner, no_library(source, include));
        if (contains(pending, include.name))
            failed(fmt::format("shader: {}:{}: {} includes itself", source.file, include.line,
                               include.name));
        pending.push_back(include.name);
        add_includes(*lib, pending);
        pending.pop_back();
        if (source.kind == SourceKind::Snippet) {
            // And the files that it includes.
            const std::function<void(const std::string&)> note = [&](const std::string& name) {
                if (!includes_[source.owner].insert(name).second) return;
                for (const Include& inner : library_.find(SourceKind::Lib, name)->includes)
                    note(inner.name);
            };
            note(include.name);
        }
        if (libs_.insert(include.name).second) add_unit(UnitRole::Lib, lib, include.name);
    }
}

void Stage::index(Macros macros) {
    for (std::size_t u = 0; u < units_.size(); ++u) {
        Unit& unit = units_[u];
        const Source& source = *unit.source;
        unit.conditions = evaluate_conditions(source, macros);
        unit.kept.resize(source.items.size());
        for (std::size_t i = 0; i < source.items.size(); ++i) {
            if (!unit.conditions.active[source.items[i].first]) continue;
            for (const std::string& name : source.items[i].names)
                places_[name].push_back({u, i});
        }
        for (const Lifted& lifted : source.lifted())
            lift(lifted);
    }
    for (const auto& [name, places] : places_) {
        const auto other = lifted_.find(name);
        for (const Place& place : places) {
            const Source& first = *unit_of(places[0]).source;
            if (unit_of(place).source->owner != first.owner)
                fail(place, fmt::format("{} is declared by {} too, in {}:{}", name, first.owner,
                                        first.file, item(places[0]).name_line));
            if (other != lifted_.end())
                fail(place, fmt::format("{} is declared already, in {}:{}", name,
                                        other->second.file, other->second.line));
        }
    }
}

void Stage::lift(const Lifted& lifted) {
    const auto [known, fresh] = lifted_.try_emplace(lifted.name, lifted);
    if (fresh) return;
    // Two of core's files may declare the same sampler.
    const Lifted& other = known->second;
    if (lifted.owner == "core" && lifted.sampler && other.sampler &&
        lifted.sampler->type == other.sampler->type)
        return;
    throw AuthorError(lifted.owner,
                      fmt::format("shader: {}:{}: {} is declared already, in {}:{}", lifted.file,
                                  lifted.line, lifted.name, other.file, other.line));
}

// ---- queries

const Unit& Stage::unit(UnitRole role) const {
    return *std::ranges::find_if(units_, [&](const Unit& unit) { return unit.role == role; });
}

const Item& Stage::item(const Place& place) const {
    return unit_of(place).source->items[place.item];
}

const Stage::Place& Stage::definition(const std::string& function) const {
    const std::vector<Place>& places = places_.find(function)->second;
    const auto found = std::ranges::find_if(
        places, [&](const Place& place) { return item(place).kind == Item::Kind::Function; });
    return found == places.end() ? places.front() : *found;
}

void Stage::fail(const Place& place, std::string_view message) const {
    const Source& source = *unit_of(place).source;
    const std::string text =
        fmt::format("shader: {}:{}: {}", source.file, item(place).name_line, message);
    if (source.kind == SourceKind::Snippet) throw AuthorError(source.owner, text);
    failed(text);
}

std::string Stage::trail(const std::string& name) const {
    std::vector<std::string> names;
    for (auto at = parents_.find(name); at != parents_.end() && !at->second.empty();
         at = parents_.find(at->second))
        names.insert(names.begin(), at->second);
    return fmt::format("{}", fmt::join(names, " -> "));
}

const std::string& Stage::owner_of(const std::string& name) const {
    return lifted_.find(name)->second.owner;
}

std::vector<Stage::OwnedSampler> Stage::samplers() const {
    std::vector<OwnedSampler> result;
    for (const Unit& unit : units_)
        for (const Sampler& sampler : unit.source->samplers)
            if (reaches(sampler.name)) result.push_back({&sampler, unit.source->owner});
    return result;
}

std::vector<const Varying*> Stage::varyings() const {
    std::vector<const Varying*> result;
    for (const Unit& unit : units_)
        for (const Varying& varying : unit.source->varyings)
            if (reaches(varying.name)) result.push_back(&varying);
    return result;
}

const Varying* Stage::find_varying(std::string_view name) const {
    const auto found = lifted_.find(name);
    return found == lifted_.end() ? nullptr : found->second.varying;
}

std::vector<Define> Stage::has_macros() const {
    std::vector<Define> result;
    for (const auto& [name, by] : parents_) {
        if (name.substr(0, kHasPrefix.size()) != kHasPrefix) continue;
        const bool present = contains(input_.capabilities, name.substr(kHasPrefix.size()));
        result.push_back({name, present ? "1" : "0"});
    }
    return result;
}

bool Stage::is_foreign(const Sampler& sampler) {
    return sampler.resource.find('.') != std::string::npos &&
           sampler.resource != address_of(sampler.name);
}

bool Stage::needs_prototype(const Hook& hook) const {
    return calls(hook) && (is_service(hook) || early_hooks_.count(hook.name) > 0);
}

const Hook* Stage::chain_after(const Hook& service) const {
    const auto chain = std::ranges::find(hooks(), service.name, &Hook::modifies);
    return chain == hooks().end() || providers(*chain).empty() ? nullptr : &*chain;
}

std::string Stage::head(const Hook& hook) const {
    std::string text(hook.signature);
    if (!is_service(hook)) text.insert(text.find(' ') + 1, kHookPrefix);
    return text;
}

std::vector<std::string> Stage::providers(const Hook& hook) const {
    std::vector<std::string> ids;
    for (const Snippet* snippet : input_.snippets) {
        if (!snippet->find(hook.name)) continue;
        const bool read = std::ranges::any_of(input_.snippets, [&](const Snippet* other) {
            return other->id == snippet->id &&
                   std::ranges::any_of(other->source.varyings, [&](const Varying& varying) {
                       return std::ranges::any_of(readers_, [&](const Stage* reader) {
                           return reader->reaches(varying.name);
                       });
                   });
        });
        if (hook.name != "vertex" || read) ids.push_back(snippet->id);
    }
    if (hook.kind != HookKind::Chain && ids.size() > 1)
        bad_input(
            fmt::format("shader: {}: expected one provider of this exclusive hook "
                        "but got {}",
                        hook.name, fmt::join(ids, " and ")));
    return ids;
}

std::vector<std::string> Stage::called_functions(const Hook& hook) const {
    const std::vector<std::string> ids = providers(hook);
    std::vector<std::string> functions;
    for (const std::string& id : ids)
        functions.push_back(fmt::format("{}_on_{}", id, hook.name));
    const std::string of_core = fmt::format("core_on_{}", hook.name);
    if (hook.kind != HookKind::Chain) {
        if (functions.empty()) functions.push_back(of_core);
    } else if (places_.count(of_core) > 0) {
        functions.insert(functions.begin() + place_of_overlay(hook, ids), of_core);
    }
    return functions;
}

std::ptrdiff_t Stage::place_of_overlay(const Hook& hook,
                                       const std::vector<std::string>& ids) const {
    const bool is_lit = hook.name != "display";
    if (is_lit && (!input_.over_overlay || input_.lit_overlay_is_over_all))
        return static_cast<std::ptrdiff_t>(ids.size());
    if (!input_.over_overlay) return 0;
    const auto first = std::ranges::find_if(
        ids, [&](const std::string& id) { return contains(*input_.over_overlay, id); });
    return first - ids.begin();
}

// ---- reachability

void Stage::reach(std::vector<const Stage*> readers) {
    readers_ = std::move(readers);
    for (std::size_t u = 0; u < units_.size(); ++u) {
        const UnitRole role = units_[u].role;
        for (std::size_t i = 0; i < units_[u].source->items.size(); ++i) {
            const Item::Kind kind = units_[u].source->items[i].kind;
            const bool whole = role == UnitRole::Types || role == UnitRole::Frame;
            if (kind != Item::Kind::Conditional && (whole || kind == Item::Kind::Interface) &&
                units_[u].conditions.active[units_[u].source->items[i].first])
                keep({u, i});
        }
    }
    if (places_.count("main") == 0)
        failed(fmt::format("shader: {}: no main()", unit(UnitRole::Main).source->file));
    need("main", "");
    while (!queue_.empty()) {
        const Place place = queue_.front();
        queue_.pop_front();
        read(place);
    }
    check_recursion();
    if (kind_ == StageKind::Vertex) check_displace();
    if (kind_ == StageKind::Compute) check_shared_size();
}

void Stage::need(const std::string& name, const std::string& by) {
    const auto places = places_.find(name);
    const bool known = places != places_.end() || lifted_.count(name) > 0 ||
                       name.substr(0, kHasPrefix.size()) == kHasPrefix;
    if (!known || !parents_.try_emplace(name, by).second || places == places_.end()) return;
    for (const Place& place : places->second)
        keep(place);
}

void Stage::keep(const Place& place) {
    if (units_[place.unit].kept[place.item]) return;
    units_[place.unit].kept[place.item] = true;
    queue_.push_back(place);
    if (item(place).kind != Item::Kind::Conditional) keep_conditionals(place);
}

// Keeps the undecided directives around kept items: the driver evaluates them.
void Stage::keep_conditionals(const Place& place) {
    const Unit& unit = unit_of(place);
    const std::vector<Item>& items = unit.source->items;
    const std::size_t at = items[place.item].first;
    for (const std::vector<std::size_t>& group : unit.conditions.undecided) {
        if (at < group.front() || at > group.back()) continue;
        for (const std::size_t directive : group) {
            const auto found = std::ranges::find(items, directive, &Item::first);
            keep({place.unit, static_cast<std::size_t>(found - items.begin())});
        }
    }
}

void Stage::read(const Place& place) {
    const Unit& unit = unit_of(place);
    const Item& it = item(place);
    const Uses uses = uses_of(*unit.source, it, unit.conditions.active);
    const std::string by = it.names.empty() ? unit.title : it.names[0];
    if (it.kind == Item::Kind::Function) {
        check_stage(place, uses);
        // Overloads may call each other. By name that would look like recursion.
        const auto [known, fresh] = functions_.try_emplace(by, uses);
        if (!fresh) known->second.calls.clear();
    }
    if (it.kind == Item::Kind::Declaration) check_shared(place);
    for (const std::string& name : uses.names) {
        const bool called = uses.calls.count(name) > 0;
        check_name(place, name, called);
        const bool prefixed = name.substr(0, kHookPrefix.size()) == kHookPrefix;
        const Hook* const hook =
            called ? find_hook(prefixed ? name.substr(kHookPrefix.size()) : name) : nullptr;
        if (hook && prefixed != is_service(*hook))
            call_hook(*hook, place, by);
        else if (called && prefixed)
            fail(place, fmt::format("{}: there is no such hook", name));
        else
            need(name, by);
    }
}

void Stage::call_hook(const Hook& hook, const Place& from, const std::string& by) {
    // What shades a pixel may be computed too.
    const HookStage wanted = kind_ == StageKind::Vertex ? HookStage::Vertex : HookStage::Fragment;
    const HookStage stage = hook.stage == HookStage::Post ? HookStage::Fragment : hook.stage;
    if (stage != wanted && stage != HookStage::Any)
        fail(from, fmt::format("hook_{} is called from the {} stage, which does not have it",
                               hook.name, word_of(kind_)));
    if (unit_of(from).role != UnitRole::Main) early_hooks_.insert(hook.name);
    if (!hooks_.insert(hook.name).second) return;
    const std::string name = is_service(hook) ? std::string(hook.name)
                                              : std::string(kHookPrefix) + std::string(hook.name);
    parents_.try_emplace(name, by);
    Uses calls;
    for (const std::string& function : called_functions(hook)) {
        if (function.substr(0, 5) == "core_") check_default(function, hook);
        need(function, name);
        calls.calls.insert(function);
    }
    if (const Hook* const chain = chain_after(hook)) {
        call_hook(*chain, from, name);
        calls.calls.insert(std::string(kHookPrefix) + std::string(chain->name));
    }
    functions_.try_emplace(name, calls);
}

}  // namespace relevo::shader

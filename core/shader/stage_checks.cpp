// The checks of Stage.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "shader/shared_memory.h"
#include "shader/stage.h"

namespace relevo::shader {
namespace {

// GLSL 4.50, 7.1 and 8: names that only one of the stages has, or that only compute passes need.
constexpr std::array<std::string_view, 18> kFragmentOnly = {"dFdx",
                                                            "dFdy",
                                                            "fwidth",
                                                            "dFdxFine",
                                                            "dFdyFine",
                                                            "fwidthFine",
                                                            "dFdxCoarse",
                                                            "dFdyCoarse",
                                                            "fwidthCoarse",
                                                            "discard",
                                                            "gl_FragCoord",
                                                            "gl_FrontFacing",
                                                            "gl_PointCoord",
                                                            "textureQueryLod",
                                                            "gl_SampleID",
                                                            "interpolateAtCentroid",
                                                            "interpolateAtSample",
                                                            "interpolateAtOffset"};
constexpr std::array<std::string_view, 2> kVertexOnly = {"gl_VertexID", "gl_InstanceID"};
constexpr std::array<std::string_view, 12> kComputeOnly = {"barrier",
                                                           "memoryBarrier",
                                                           "memoryBarrierBuffer",
                                                           "memoryBarrierImage",
                                                           "memoryBarrierShared",
                                                           "groupMemoryBarrier",
                                                           "gl_GlobalInvocationID",
                                                           "gl_LocalInvocationID",
                                                           "gl_LocalInvocationIndex",
                                                           "gl_NumWorkGroups",
                                                           "gl_WorkGroupID",
                                                           "gl_WorkGroupSize"};

/// The only stage that has a name of GLSL's; none of a name that several have.
std::optional<StageKind> only_stage_of(std::string_view name) {
    if (contains(kFragmentOnly, name)) return StageKind::Fragment;
    if (contains(kVertexOnly, name)) return StageKind::Vertex;
    if (contains(kComputeOnly, name)) return StageKind::Compute;
    return std::nullopt;
}

}  // namespace

std::string_view word_of(StageKind kind) {
    switch (kind) {
        case StageKind::Vertex:
            return "vertex";
        case StageKind::Compute:
            return "compute";
        default:
            return "fragment";
    }
}

void Stage::check_default(const std::string& function, const Hook& hook) const {
    const std::string& file = unit(UnitRole::Defaults).source->file;
    const auto places = places_.find(function);
    if (places == places_.end())
        failed(fmt::format("shader: {}: no {}, the default of the hook {}", file, function,
                           hook.name));
    Signature expected = parse_signature(hook.signature);
    expected.name = function;
    const Signature found = unit_of(places->second[0]).source->signature(item(places->second[0]));
    if (!found.matches(expected))
        fail(places->second[0], fmt::format("{}: wrong signature, expected {} but got {}", function,
                                            expected.text(), found.text()));
}

// A plugin may use its own names, functions of core that it includes, and services.
void Stage::check_name(const Place& place, const std::string& name, bool called) const {
    const Source& source = *unit_of(place).source;
    if (source.kind != SourceKind::Snippet) return;
    if (const auto lifted = lifted_.find(name); lifted != lifted_.end()) {
        if (lifted->second.owner != "core" && lifted->second.owner != source.owner)
            fail(place, fmt::format("{} uses {}, which is the plugin {}'s; a plugin uses only "
                                    "itself, core and services",
                                    item(place).names[0], name, lifted->second.owner));
    }
    const auto places = places_.find(name);
    if (places == places_.end()) {
        check_output(place, name);
        if (called) check_library(place, name);
        return;
    }
    const Place& target = places->second[0];
    const Unit& owner = unit_of(target);
    if (owner.role == UnitRole::Snippet) {
        if (owner.source->owner != source.owner)
            fail(place, fmt::format("{} uses {}, which is the plugin {}'s; a plugin uses only "
                                    "itself, core and services",
                                    item(place).names[0], name, owner.source->owner));
        return;
    }
    const Item::Kind kind = item(target).kind;
    const bool function = kind == Item::Kind::Function || kind == Item::Kind::Prototype;
    if (function && !called) return;  // a local variable of that name
    if (owner.role == UnitRole::Main)
        fail(place, fmt::format("{} uses {}, which is {}'s own; a plugin uses only itself, "
                                "shaders/lib and services",
                                item(place).names[0], name, owner.title));
    const auto asked = includes_.find(source.owner);
    const bool included = asked != includes_.end() && asked->second.count(owner.title) > 0;
    if (owner.role == UnitRole::Lib && !included)
        fail(place, fmt::format("{} uses {} of {}; add //@ include {}", item(place).names[0], name,
                                owner.title, owner.title));
}

// GLSL's own functions have no underscore, those of lib/ that plugins call have one.
void Stage::check_library(const Place& place, const std::string& name) const {
    if (name.find('_') == std::string::npos || find_hook(name)) return;
    const std::string library = library_.library_of(name);
    if (library.empty()) return;
    fail(place, fmt::format("{} uses {} of {}; add //@ include {}", item(place).names[0], name,
                            library, library));
}

void Stage::check_stage(const Place& place, const Uses& uses) const {
    const std::string& function = item(place).names[0];
    for (const std::string& name : uses.names) {
        const std::optional<StageKind> only = only_stage_of(name);
        if (only && *only != kind_)
            fail(place,
                 fmt::format("{} uses {}, which only the {} stage has, but the {} stage "
                             "reaches it ({})",
                             function, name, word_of(*only), word_of(kind_), trail(function)));
    }
}

// Core declares what the compute pass of this program writes, and nothing else.
void Stage::check_output(const Place& place, const std::string& name) const {
    if (name == output_) return;
    const std::string& owner = unit_of(place).source->owner;
    for (const PluginPass& pass : input_.passes)
        if (pass.kind == PluginPass::Kind::Compute && pass.output_name() == name &&
            pass.resource.starts_with(owner + '.'))
            fail(place, fmt::format("{} uses {}, which only the pass {} writes; others read it by "
                                    "uniform {} {}",
                                    item(place).names[0], name, pass.name, sampler_of(pass.output),
                                    name.substr(0, name.size() - 4)));
}

void Stage::check_shared(const Place& place) const {
    if (kind_ == StageKind::Compute || !is_shared(*unit_of(place).source, item(place))) return;
    const std::string& name = item(place).names[0];
    fail(place, fmt::format("{} is shared memory, which only compute passes have, but the {} stage "
                            "reaches it ({})",
                            name, word_of(kind_), trail(name)));
}

void Stage::check_shared_size() const {
    std::size_t total = 0;
    for (std::size_t u = 0; u < units_.size(); ++u)
        for (std::size_t i = 0; i < units_[u].source->items.size(); ++i) {
            if (!units_[u].kept[i]) continue;
            total += shared_bytes(*units_[u].source, item({u, i}));
            if (total > kMaxSharedBytes)
                fail({u, i},
                     fmt::format("{}: expected at most {} bytes of shared memory in a pass, "
                                 "which every device has, but got {} up to here",
                                 item({u, i}).names[0], kMaxSharedBytes, total));
        }
}

void Stage::check_recursion() const {
    std::set<std::string> done;
    std::vector<std::string> path;
    const std::function<void(const std::string&)> visit = [&](const std::string& name) {
        const auto function = functions_.find(name);
        if (function == functions_.end() || done.count(name) > 0) return;
        const auto start = std::ranges::find(path, name);
        if (start != path.end()) {
            std::vector<std::string> circle(start, path.end());
            circle.push_back(name);
            const auto written = std::ranges::find_if(
                circle, [&](const std::string& f) { return places_.count(f) > 0; });
            fail(definition(*written), fmt::format("{} calls itself ({}); GLSL has no recursion",
                                                   *written, fmt::join(circle, " -> ")));
        }
        path.push_back(name);
        for (const std::string& callee : function->second.calls) {
            const bool hook = hooks_.count(callee) > 0;
            if (hook || functions_.count(callee) > 0) visit(callee);
        }
        path.pop_back();
        done.insert(name);
    };
    for (const auto& [name, uses] : functions_)
        visit(name);
}

// Core may displace a vertex several times, for its neighbours, and in depth passes too.
void Stage::check_displace() const {
    const Hook& displace = *find_hook("displace");
    if (!calls(displace)) return;
    for (const std::string& function : called_functions(displace)) {
        std::vector<std::string> pending = {function};
        std::set<std::string> seen;
        while (!pending.empty()) {
            const std::string name = pending.back();
            pending.pop_back();
            const auto found = functions_.find(name);
            if (found == functions_.end() || !seen.insert(name).second) continue;
            for (const std::string& used : found->second.names) {
                const auto lifted = lifted_.find(used);
                if (lifted != lifted_.end() && lifted->second.varying)
                    fail(definition(name),
                         fmt::format("{} uses the varying {}; varyings are filled in "
                                     "{}_on_vertex, displace runs in depth passes too",
                                     name, used, lifted->second.owner));
            }
            pending.insert(pending.end(), found->second.calls.begin(), found->second.calls.end());
        }
    }
}

}  // namespace relevo::shader

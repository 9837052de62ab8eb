// The checks of Stage.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "shader/conditions.h"
#include "shader/stage.h"

namespace relevo::shader {
namespace {

/// Names of GLSL that a rule is about.
struct Row {
    std::string_view names;  ///< with spaces between them
    int value;

    bool has(std::string_view name) const {
        return (' ' + std::string(names) + ' ').find(' ' + std::string(name) + ' ') != names.npos;
    }
};

// GLSL 4.50, 7.1 and 8: names that only one of the stages has, or that only compute passes need.
constexpr std::array kOnlyStages = {
    Row{"dFdx dFdy fwidth dFdxFine dFdyFine fwidthFine dFdxCoarse dFdyCoarse fwidthCoarse discard "
        "gl_FragCoord gl_FrontFacing gl_PointCoord gl_SampleID textureQueryLod "
        "interpolateAtCentroid interpolateAtSample interpolateAtOffset",
        static_cast<int>(StageKind::Fragment)},
    Row{"gl_VertexID gl_InstanceID", static_cast<int>(StageKind::Vertex)},
    Row{"barrier memoryBarrier memoryBarrierBuffer memoryBarrierImage memoryBarrierShared "
        "groupMemoryBarrier gl_GlobalInvocationID gl_LocalInvocationID gl_LocalInvocationIndex "
        "gl_NumWorkGroups gl_WorkGroupID gl_WorkGroupSize",
        static_cast<int>(StageKind::Compute)}};

/// Bytes of types. A vector of three takes as much as one of four, as devices may lay it out.
constexpr std::array kTypeBytes = {Row{"float int uint bool", 4},
                                   Row{"vec2 ivec2 uvec2", 8},
                                   Row{"vec3 ivec3 uvec3", 16},
                                   Row{"vec4 ivec4 uvec4 mat2", 16},
                                   Row{"mat3", 48},
                                   Row{"mat4", 64}};

template <std::size_t N>
std::optional<int> value_of(const std::array<Row, N>& rows, std::string_view name) {
    for (const Row& row : rows)
        if (row.has(name)) return row.value;
    return std::nullopt;
}

/// Whether a declaration is `shared`: memory of a work group of a compute pass.
bool is_shared(const Source& source, const Item& item) {
    return item.kind == Item::Kind::Declaration && source.is(item.first, "shared");
}

/// Bytes of a shared variable.
double shared_bytes(const Source& source, const Item& item) {
    const auto refuse = [&](const std::string& message) {
        source_error(source.file, item.name_line,
                     fmt::format("{}: {}", item.names.empty() ? "shared" : item.names[0], message));
    };
    const std::string_view type = source.str(item.first + 1);
    const std::optional<int> bytes = value_of(kTypeBytes, type);
    if (!bytes)
        refuse(fmt::format(
            "expected shared memory of float, int, uint, bool, vectors or matrices but got {}",
            type));
    Constants constants;
    for (const Item& other : source.items)
        constants.add(source, other.first);
    double total = *bytes;
    for (std::size_t i = item.first + 2; !source.is(i, ";"); i = source.next(i)) {
        if (source.is(i, ",") || source.is(i, "="))
            refuse(
                "expected one variable without an initial value in a shared declaration; write "
                "zeros in the function, then call barrier()");
        if (!source.is(i, "[")) continue;
        const auto length =
            std::span(source.tokens).subspan(i + 1, source.tokens[i].partner - i - 1);
        const std::optional<double> value = constants.value(source, length);
        if (!value || *value < 1)
            refuse(fmt::format("expected a length of numbers and constants of this file but got {}",
                               trimmed(joined(source, length))));
        total *= *value;
    }
    return total;
}

}  // namespace

std::string_view word_of(StageKind kind) {
    constexpr std::array<std::string_view, 3> kWords = {"vertex", "fragment", "compute"};
    return kWords[static_cast<std::size_t>(kind)];
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
    if (!source.is_snippet()) return;
    const auto refuse = [&](const std::string& what) {
        fail(place, fmt::format("{} uses {}{}", item(place).names[0], name, what));
    };
    const auto refuse_plugins = [&](const std::string& owner) {
        if (owner != source.owner)
            refuse(
                fmt::format(", which is the plugin {}'s; a plugin uses only itself, core and "
                            "services",
                            owner));
    };
    if (const auto lifted = lifted_.find(name); lifted != lifted_.end())
        if (lifted->second.owner != "core") refuse_plugins(lifted->second.owner);
    const auto places = places_.find(name);
    if (places == places_.end()) {
        check_output(place, name);
        // GLSL's own functions have no underscore, those of lib/ that plugins call have one.
        if (!called || name.find('_') == std::string::npos || find_hook(name)) return;
        if (const std::string library = library_.library_of(name); !library.empty())
            refuse(fmt::format(" of {}; add //@ include {}", library, library));
        return;
    }
    const Place& target = places->second[0];
    const Unit& owner = unit_of(target);
    if (owner.role == UnitRole::Snippet) return refuse_plugins(owner.source->owner);
    const Item::Kind kind = item(target).kind;
    const bool function = kind == Item::Kind::Function || kind == Item::Kind::Prototype;
    if (function && !called) return;  // a local variable of that name
    if (owner.role == UnitRole::Main)
        refuse(
            fmt::format(", which is {}'s own; a plugin uses only itself, shaders/lib and "
                        "services",
                        owner.title));
    const auto asked = includes_.find(source.owner);
    if (owner.role == UnitRole::Lib &&
        (asked == includes_.end() || !asked->second.contains(owner.title)))
        refuse(fmt::format(" of {}; add //@ include {}", owner.title, owner.title));
}

void Stage::check_stage(const Place& place, const Uses& uses) const {
    const std::string& function = item(place).names[0];
    for (const std::string& name : uses.names) {
        const std::optional<int> only = value_of(kOnlyStages, name);
        if (only && *only != static_cast<int>(kind_))
            fail(place, fmt::format("{} uses {}, which only the {} stage has, but the {} stage "
                                    "reaches it ({})",
                                    function, name, word_of(static_cast<StageKind>(*only)),
                                    word_of(kind_), trail(function)));
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
    double total = 0;
    for (std::size_t u = 0; u < units_.size(); ++u)
        for (std::size_t i = 0; i < units_[u].source->items.size(); ++i) {
            if (!units_[u].kept[i] || !is_shared(*units_[u].source, item({u, i}))) continue;
            total += shared_bytes(*units_[u].source, item({u, i}));
            if (total > kMaxSharedBytes)
                fail({u, i},
                     fmt::format("{}: expected at most {} bytes of shared memory in a pass, "
                                 "which every device has, but got {:.0f} up to here",
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
    for (const std::string& name : reachable(called_functions(displace), functions_)) {
        const auto function = functions_.find(name);
        if (function == functions_.end()) continue;
        for (const std::string& used : function->second.names) {
            const auto lifted = lifted_.find(used);
            if (lifted != lifted_.end() && lifted->second.varying)
                fail(definition(name),
                     fmt::format("{} uses the varying {}; varyings are filled in "
                                 "{}_on_vertex, displace runs in depth passes too",
                                 name, used, lifted->second.owner));
        }
    }
}

}  // namespace relevo::shader

#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "render/graph/graph.h"

namespace relevo::render {

/// How a FrameGraph is executed.
struct Plan {
    struct Step {
        int pass = 0;             ///< index in FrameGraph::passes
        bool barrier = false;     ///< an earlier step wrote by a compute shader what this one uses
        std::vector<int> begins;  ///< resources of Lifetime::Frame that no earlier step uses
    };
    std::vector<Step> steps;

    /// Resources of one kind, format and size, of which no two are needed at once.
    struct Memory {
        std::vector<int> resources;
    };
    std::vector<Memory> memory;
    std::vector<int> memory_of;  ///< of each resource: index in `memory`; -1: none is allocated

    /// Names of the resources that some step reads.
    std::set<std::string, std::less<>> read;
    bool reads(std::string_view resource) const { return read.contains(resource); }
};

/// Derives the plan of a graph. Passes without an order between them keep that of the declaration.
/// @throws Error (Failed) `render: graph: ...` for two passes or resources of one name, a resource
/// or
///         version that does not exist, a read before any write, two writers, updates without an
///         order, a pass that reads what it draws into, a pass that is not executed in every frame
///         and uses what lasts for one, a pass that contradicts its kind, and a cycle
Plan plan(const FrameGraph& graph);

/// A graph and its plan in Graphviz's language: passes as boxes in their order, resources as
/// ellipses; what is not executed is dashed, what shares memory has a common number.
std::string dot_text(const FrameGraph& graph, const Plan& plan, std::string_view title);

}  // namespace relevo::render

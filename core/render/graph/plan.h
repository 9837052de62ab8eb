#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "render/graph/graph.h"

namespace relevo::render {

/// Execution plan of a FrameGraph.
struct Plan {
    struct Step {
        int pass = 0;             ///< index in FrameGraph::passes
        bool barrier = false;     ///< needs a barrier after an earlier compute write
        std::vector<int> begins;  ///< Lifetime::Frame resources first used here
    };
    std::vector<Step> steps;

    /// Resources of one kind, format and size with disjoint lifetimes.
    struct Memory {
        std::vector<int> resources;
    };
    std::vector<Memory> memory;
    std::vector<int> memory_of;  ///< by resource: index in `memory`; -1: not allocated

    /// Names of resources that a step reads.
    std::set<std::string, std::less<>> read;
    bool reads(std::string_view resource) const { return read.contains(resource); }
};

/// Derives the plan of a graph. Passes that are not ordered otherwise keep their order of
/// declaration.
/// @throws Error (Failed) `render: graph: ...` for duplicate names, unknown resources and versions,
///     reads before any write, several writers, unordered updates, passes that read their own
///     targets, conditional passes that use Lifetime::Frame resources, passes that contradict their
///     kind, and cycles
Plan plan(const FrameGraph& graph);

/// A graph and its plan in Graphviz's DOT language. Passes are boxes in order, resources ellipses.
/// Dashed: not executed. Resources that share memory have the same number.
std::string dot_text(const FrameGraph& graph, const Plan& plan, std::string_view title);

}  // namespace relevo::render

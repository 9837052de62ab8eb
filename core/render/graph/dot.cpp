#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/graph/plan.h"

namespace relevo::render {
namespace {

using Mode = Access::Mode;

const char* word(When when) {
    switch (when) {
        case When::Frame:
            return "each frame";
        case When::Sun:
            return "when the sun has moved";
        case When::Parameters:
            return "when parameters have changed";
        case When::Dem:
            return "once for each ground";
    }
    return "";
}

const char* word(PassKind kind) {
    switch (kind) {
        case PassKind::Fullscreen:
            return "full-screen";
        case PassKind::Geometry:
            return "geometry";
        case PassKind::Compute:
            return "compute";
        case PassKind::Host:
            return "host";
    }
    return "";
}

std::string format_text(const PixelLayout& layout) {
    const char* const kind = layout.kind == ChannelKind::Unorm   ? "unorm"
                             : layout.kind == ChannelKind::Snorm ? "snorm"
                             : layout.kind == ChannelKind::Whole ? "uint"
                                                                 : "float";
    return fmt::format("{} x {}-bit {}", layout.channels, 8 * layout.channel_bytes, kind);
}

std::string size_text(const ResourceSize& size) {
    if (size.share == 1) return "frame";
    if (size.share > 0) return fmt::format("{:g} of the frame", size.share);
    return fmt::format("{} x {}", size.width, size.height);
}

std::string resource_text(const Resource& resource, int memory) {
    if (resource.lifetime == Lifetime::Provided) return resource.name;
    std::string text = resource.name + "\\n";
    if (resource.kind == ResourceKind::Buffer)
        text += fmt::format("{} bytes", resource.size.bytes);
    else
        text += fmt::format("{}, {}", format_text(layout_of(resource.format)),
                            size_text(resource.size));
    if (resource.size.depth > 1) text += fmt::format(" x {}", resource.size.depth);
    text += memory < 0 ? "\\nnot allocated" : fmt::format("\\nmemory {}", memory);
    if (resource.lifetime == Lifetime::Kept) text += ", kept";
    if (resource.output) text += ", output";
    return text;
}

}  // namespace

std::string dot_text(const FrameGraph& graph, const Plan& plan, std::string_view title) {
    std::string text = fmt::format(
        "digraph \"{}\" {{\n  rankdir=LR;\n  node [fontname=\"sans-serif\", fontsize=10];\n",
        title);
    for (std::size_t r = 0; r < graph.resources.size(); ++r) {
        const Resource& resource = graph.resources[r];
        text += fmt::format("  \"{}\" [shape=ellipse, style={}, label=\"{}\"];\n", resource.name,
                            resource.lifetime == Lifetime::Provided ? "dotted" : "solid",
                            resource_text(resource, plan.memory_of[r]));
    }
    for (std::size_t p = 0; p < graph.passes.size(); ++p) {
        const Pass& pass = graph.passes[p];
        const auto step = std::ranges::find(plan.steps, static_cast<int>(p), &Plan::Step::pass);
        const bool executed = step != plan.steps.end();
        std::string label =
            executed ? fmt::format("{}. {}", step - plan.steps.begin() + 1, pass.name) : pass.name;
        label += fmt::format("\\n{}, {}", word(pass.kind), executed ? word(pass.when) : "unused");
        if (!pass.program.empty()) label += fmt::format("\\nprogram {}", pass.program);
        if (executed && step->barrier) label += "\\nbarrier before";
        text += fmt::format("  \"pass {}\" [shape=box, style={}, label=\"{}\"];\n", pass.name,
                            executed ? "bold" : "dashed", label);
        for (const Access& access : accesses(pass)) {
            const std::string& name = access.version.resource;
            const std::string& version = access.version.pass;
            const std::string edge =
                version.empty() ? "" : fmt::format(" [label=\"@{}\", fontsize=8]", version);
            if (access.mode != Mode::Write)
                text += fmt::format("  \"{}\" -> \"pass {}\"{};\n", name, pass.name, edge);
            if (access.mode != Mode::Read)
                text += fmt::format("  \"pass {}\" -> \"{}\";\n", pass.name, name);
        }
    }
    return text + "}\n";
}

}  // namespace relevo::render

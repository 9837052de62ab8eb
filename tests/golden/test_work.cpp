// What the default frame asks of a device, counted and not timed: no machine is too busy for it.
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/paths.h"
#include "base/pixel_format.h"
#include "golden/reference_compiler.h"
#include "golden/shipped.h"
#include "render/programs.h"
#include "support/support.h"

namespace relevo::test::test_work {
namespace {

/// Instructions and reads of textures of a program, bytes a pixel of targets; by name.
using Work = std::map<std::string, std::array<int, 2>>;

int reads_of(const std::vector<std::uint32_t>& code) {
    int reads = 0;
    // OpImageSampleImplicitLod to OpImageDrefGather, of SPIR-V's list.
    for (std::uint32_t operation = 87; operation <= 97; ++operation)
        reads += count_operations(code, operation);
    return reads;
}

void add_targets(const std::string& name, const render::FrameGraph& graph, Work& work) {
    int bytes = 0;
    for (const render::Resource& resource : graph.resources)
        if (resource.lifetime == render::Lifetime::Frame && resource.size.share == 1)
            bytes += layout_of(resource.format).bytes() * resource.size.depth;
    work[name] = {bytes, 0};
}

/// Of the effects that are on by default, with water, as a capture has them.
Work default_work() {
    const Shipped shipped;
    const shader::ParamStore values = shipped.values();
    const render::StitchedFrames frames =
        stitched(effect::select(shipped.registry, {}, {}), values, {.shown = true},
                 /*constants=*/true);
    Work work;
    for (const render::ProgramText& text : frames.programs) {
        const ReferenceProgram program =
            reference_compile(text.stitched.vertex.text, text.stitched.fragment.text);
        EXPECT_EQ(program.refused, "") << text.name;
        const auto fragment = optimised(program.fragment);
        work[text.name] = {count_operations(fragment), reads_of(fragment)};
    }
    add_targets("bytes_within", frames.within, work);
    if (frames.outside) add_targets("bytes_outside", *frames.outside, work);
    return work;
}

/// Lines of a name and two numbers; what follows them says why.
Work read_baseline() {
    std::ifstream file(source_dir() / "tests/golden/work.txt");
    Work work;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words(line);
        std::string name;
        std::array<int, 2> of{};
        words >> name >> of[0] >> of[1];
        work[name] = of;
    }
    return work;
}

TEST(Work, OfTheDefaultFrameIsNoMoreThanItsBaseline) {
    constexpr double kAllowance = 1.02;
    const Work found = default_work(), baseline = read_baseline();
    std::string table;
    for (const auto& [name, of] : found)
        table += fmt::format("{} {} {}\n", name, of[0], of[1]);
    for (const auto& [name, of] : found) {
        const auto known = baseline.find(name);
        ASSERT_NE(known, baseline.end()) << "a new program: " << name << "\n" << table;
        for (std::size_t i = 0; i < of.size(); ++i)
            EXPECT_LE(of[i], std::floor(kAllowance * known->second[i]))
                << name << ": if it is worth it, write the new figure and why into work.txt\n"
                << table;
    }
    for (const auto& [name, of] : baseline)
        EXPECT_TRUE(found.contains(name)) << name << " is no more: take it out of work.txt";
}

}  // namespace
}  // namespace relevo::test::test_work

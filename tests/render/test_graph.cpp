#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/core_passes.h"
#include "render/graph/plan.h"
#include "support/support.h"

namespace relevo::render::test_graph {
namespace {

Pass pass(const std::string& name, std::vector<std::string> reads, std::vector<std::string> writes,
          std::vector<std::string> updates = {}, std::vector<std::string> after = {}) {
    return {.name = name,
            .kind = PassKind::Host,
            .reads = std::move(reads),
            .writes = std::move(writes),
            .updates = std::move(updates),
            .after = std::move(after),
            .body = [](PassContext&) {}};
}

Resource texture(const std::string& name, bool output = false) {
    return {.name = name, .output = output};
}

std::vector<std::string> order(const FrameGraph& graph) {
    std::vector<std::string> names;
    for (const Plan::Step& step : plan(graph).steps)
        names.push_back(graph.passes[static_cast<std::size_t>(step.pass)].name);
    return names;
}

std::string error_of(const FrameGraph& graph) {
    const std::string text = test::error_of([&] { plan(graph); });
    constexpr std::string_view kPrefix = "render: graph: ";
    const std::size_t at = text.find(kPrefix);
    return at == std::string::npos ? text : text.substr(at + kPrefix.size());
}

using Names = std::vector<std::string>;

TEST(Graph, PutsWritersBeforeReadersWhateverTheDeclaration) {
    const FrameGraph graph{
        {texture("a"), texture("b"), texture("c", true)},
        {pass("last", {"b"}, {"c"}), pass("middle", {"a"}, {"b"}), pass("first", {}, {"a"})}};
    EXPECT_EQ(order(graph), (Names{"first", "middle", "last"}));
}

TEST(Graph, CullsWhatNobodyNeeds) {
    FrameGraph graph{{texture("a"), texture("b"), texture("c", true)},
                     {pass("a", {}, {"a"}), pass("b", {"a"}, {"b"}), pass("c", {}, {"c"})}};
    EXPECT_EQ(order(graph), (Names{"c"}));
    const Plan planned = plan(graph);
    EXPECT_EQ(planned.memory_of, (std::vector<int>{-1, -1, 0}));
    EXPECT_FALSE(planned.reads("a"));
    graph.passes[2].reads = {"b"};
    EXPECT_EQ(order(graph), (Names{"a", "b", "c"}));
    EXPECT_TRUE(plan(graph).reads("a"));
}

TEST(Graph, ReadsTheVersionThatAPassNames) {
    // `shade` reads the depth of `geometry`, `smooth` that with the walls, which come after `shade`
    // as they draw over its light.
    const FrameGraph graph{
        {texture("depth"), texture("light"), texture("end", true)},
        {pass("walls", {}, {}, {"depth", "light"}), pass("smooth", {"depth", "light"}, {"end"}),
         pass("shade", {"depth@geometry"}, {"light"}), pass("geometry", {}, {"depth"})}};
    EXPECT_EQ(order(graph), (Names{"geometry", "shade", "walls", "smooth"}));
}

TEST(Graph, UpdatesKeepTheOrderOfAfter) {
    FrameGraph graph{{texture("light", true)},
                     {pass("sky", {}, {}, {"light"}, {"walls"}), pass("walls", {}, {}, {"light"}),
                      pass("ground", {}, {"light"})}};
    EXPECT_EQ(order(graph), (Names{"ground", "walls", "sky"}));
    graph.passes[0].after = {"something that is not there"};
    EXPECT_EQ(error_of(graph),
              "passes sky and walls both draw over light in no order: one has to name "
              "the other in `after`");
}

TEST(Graph, HistoryIsReadBeforeItIsWrittenAnew) {
    FrameGraph graph{
        {{.name = "history", .lifetime = Lifetime::Kept}, texture("end", true)},
        {pass("keep", {"end"}, {"history"}), pass("blend", {"history@before"}, {"end"})}};
    EXPECT_EQ(order(graph), (Names{"blend", "keep"}));
    graph.resources[0].lifetime = Lifetime::Frame;
    EXPECT_EQ(error_of(graph), "pass blend reads history@before, which lasts for one frame");
}

TEST(Graph, RefusesWhatCannotBeExecuted) {
    const auto refused = [](std::vector<Resource> resources, std::vector<Pass> passes) {
        return error_of({std::move(resources), std::move(passes)});
    };
    EXPECT_EQ(refused({texture("a"), texture("b", true)},
                      {pass("one", {"a"}, {"b"}), pass("two", {"b"}, {"a"})}),
              "passes one, two wait for each other");
    EXPECT_EQ(refused({texture("a"), texture("b", true)}, {pass("one", {"a"}, {"b"})}),
              "pass one reads a, which no pass writes");
    EXPECT_EQ(refused({texture("a", true)}, {pass("one", {}, {"a"}), pass("two", {}, {"a"})}),
              "passes one and two both write a");
    EXPECT_EQ(refused({texture("a", true)}, {pass("one", {}, {}, {"a"})}),
              "pass one draws over a, which no pass writes");
    EXPECT_EQ(refused({texture("a", true)}, {pass("one", {"a"}, {"a"})}),
              "pass one both reads a and draws into it");
    EXPECT_EQ(refused({texture("a", true)}, {pass("one", {}, {"b"})}),
              "pass one names b, which is no resource");
    EXPECT_EQ(refused({texture("a"), texture("b", true)},
                      {pass("one", {}, {"a"}), pass("two", {"a@three"}, {"b"})}),
              "pass two reads a@three, but three does not write a");
    EXPECT_EQ(refused({texture("a"), texture("a")}, {}), "two resources are called a");
    EXPECT_EQ(refused({}, {pass("one", {}, {}), pass("one", {}, {})}), "two passes are called one");
    Pass rare = pass("rare", {}, {"a"});
    rare.when = When::Sun;
    EXPECT_EQ(refused({texture("a", true)}, {rare}),
              "pass rare is not executed in every frame but uses a, which lasts for one frame");
}

TEST(Graph, RefusesAPassThatContradictsItself) {
    const auto refused = [](const std::function<void(Pass&)>& change) {
        Pass drawn{.name = "one", .program = "one", .colours = {{"a"}}};
        change(drawn);
        return error_of({{texture("a", true), {.name = "z", .format = PixelFormat::Depth32F}},
                         {drawn, pass("far", {}, {"z"})}});
    };
    EXPECT_EQ(refused([](Pass&) {}), "no error");
    EXPECT_EQ(refused([](Pass& p) { p.name = "before"; }),
              "pass before has a name that means a version");
    EXPECT_EQ(refused([](Pass& p) { p.body = [](PassContext&) {}; }),
              "pass one is full-screen and has a body");
    EXPECT_EQ(refused([](Pass& p) { p.kind = PassKind::Geometry; }), "pass one has no body");
    EXPECT_EQ(refused([](Pass& p) { p.program.clear(); }), "pass one has no program");
    EXPECT_EQ(refused([](Pass& p) { p.dispatch = Dispatch{}; }),
              "pass one has work groups and is not compute");
    EXPECT_EQ(refused([](Pass& p) { p.kind = PassKind::Compute; }),
              "pass one is compute and has no work groups");
    EXPECT_EQ(refused([](Pass& p) {
                  p.kind = PassKind::Compute;
                  p.dispatch = Dispatch{};
              }),
              "pass one is compute and does not write one image or buffer");
    EXPECT_EQ(refused([](Pass& p) {
                  p.depth = Depth{"z"};
                  p.stencil = Stencil{"z"};
              }),
              "pass one has both a depth and a stencil");
    EXPECT_EQ(refused([](Pass& p) { p.depth = Depth{.resource = "z", .clear = 0.0F}; }),
              "pass one clears a depth that it reads");
    EXPECT_EQ(refused([](Pass& p) {
                  p.colours = {{.resource = "a", .clear = {{0, 0, 0, 0}}, .updates = true}};
              }),
              "pass one clears what it updates");
    EXPECT_EQ(refused([](Pass& p) { p.colours = {{"a@far"}}; }), "pass one draws into a version");
}

TEST(Graph, BarriersStandBeforeWhatUsesAComputePass) {
    FrameGraph graph{{texture("a"), texture("b"), texture("end", true)},
                     {pass("compute", {}, {"a"}), pass("other", {}, {"b"}),
                      pass("first", {"a", "b"}, {"end"}), pass("second", {"a"}, {}, {"end"})}};
    graph.passes[0].kind = PassKind::Compute;
    graph.passes[0].program = "compute";
    graph.passes[0].body = {};
    graph.passes[0].dispatch = Dispatch{};
    std::vector<bool> barriers;
    for (const Plan::Step& step : plan(graph).steps)
        barriers.push_back(step.barrier);
    // Before its own writes, for readers in the frame before; then once for both readers.
    EXPECT_EQ(barriers, (std::vector<bool>{true, false, true, false}));
}

TEST(Graph, WorkGroupsAreWhole) {
    using Counts = std::array<int, 3>;
    const ResourceSize half{.share = 0.5}, box{.share = 0, .width = 9, .height = 8, .depth = 3};
    EXPECT_EQ((Dispatch{.over = half, .local_size = {16, 16, 1}}.groups(131, 64)),
              (Counts{5, 2, 1}));
    EXPECT_EQ((Dispatch{.over = box, .local_size = {4, 4, 4}}.groups(131, 64)), (Counts{3, 2, 1}));
    EXPECT_EQ(
        (Dispatch{.over = box, .local_size = {4, 4, 4}, .work_groups = {7, 1, 2}}.groups(131, 64)),
        (Counts{7, 1, 2}));
}

/// What executing a graph leaves in a memory, as one number for a texture.
class Machine {
  public:
    explicit Machine(const FrameGraph& graph) : graph_(graph) {}

    /// The contents of the outputs; each resource has its own memory without a plan.
    std::map<std::string, double> run(const std::vector<int>& passes, const Plan* plan) {
        std::map<int, double> memory;
        const auto cell = [&](const std::string& name) -> double& {
            const auto r =
                static_cast<int>(std::ranges::find(graph_.resources, name, &Resource::name) -
                                 graph_.resources.begin());
            return memory[plan ? plan->memory_of[static_cast<std::size_t>(r)] : r];
        };
        for (std::size_t i = 0; i < passes.size(); ++i) {
            if (plan)
                for (const int begun : plan->steps[i].begins)
                    cell(graph_.resources[static_cast<std::size_t>(begun)].name) =
                        std::numeric_limits<double>::quiet_NaN();
            execute(passes[i], cell);
        }
        std::map<std::string, double> outputs;
        for (const Resource& resource : graph_.resources)
            if (resource.output) outputs[resource.name] = cell(resource.name);
        return outputs;
    }

  private:
    template <typename Cell>
    void execute(int index, const Cell& cell) {
        const Pass& executed = graph_.passes[static_cast<std::size_t>(index)];
        double value = index + 1;
        for (const Access& access : accesses(executed))
            if (access.mode == Access::Mode::Read)
                value = std::fmod(7.0 * value + 3.0 * cell(access.version.resource), 1009.0);
        for (const Access& access : accesses(executed)) {
            double& out = cell(access.version.resource);
            if (access.mode == Access::Mode::Write) out = value;
            if (access.mode == Access::Mode::Update) out = std::fmod(11.0 * out + value, 1013.0);
        }
    }

    const FrameGraph& graph_;
};

/// A graph that some order can execute: passes read what earlier ones of a secret order have left.
/// Declared in another order.
FrameGraph random_graph(std::mt19937& random, int passes) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    FrameGraph graph;
    std::map<std::string, std::string> last;  // of each resource: the pass that drew into it last
    std::vector<Pass> secret;
    for (int p = 0; p < passes; ++p) {
        Pass made = pass(fmt::format("p{}", p), {}, {});
        const std::string own = fmt::format("r{}", p);
        std::set<std::string> used{own};
        for (int i = below(3); i > 0 && !last.empty(); --i) {
            const auto which = std::next(last.begin(), below(static_cast<int>(last.size())));
            if (!used.insert(which->first).second) continue;
            if (below(3) == 0) {
                made.updates.push_back(which->first);
                made.after.push_back(which->second);
                which->second = made.name;
            } else {
                made.reads.push_back(which->first + "@" + which->second);
            }
        }
        made.writes = {own};
        last[own] = made.name;
        graph.resources.push_back(texture(own, p == passes - 1 || below(6) == 0));
        secret.push_back(std::move(made));
    }
    std::ranges::shuffle(secret, random);
    graph.passes = std::move(secret);
    return graph;
}

TEST(Graph, RandomGraphsGiveWhatTheirSecretOrderGives) {
    std::mt19937 random(1);
    int shared = 0, culled = 0;
    for (int round = 0; round < 3000; ++round) {
        const FrameGraph graph = random_graph(random, 2 + round % 9);
        std::vector<int> secret(graph.passes.size());
        std::iota(secret.begin(), secret.end(), 0);
        std::ranges::sort(secret, {}, [&](int p) {
            return std::stoi(graph.passes[static_cast<std::size_t>(p)].name.substr(1));
        });
        const Plan planned = plan(graph);
        std::vector<int> steps;
        for (const Plan::Step& step : planned.steps)
            steps.push_back(step.pass);
        Machine machine(graph);
        EXPECT_EQ(machine.run(steps, &planned), machine.run(secret, nullptr)) << round;
        for (const Plan::Memory& memory : planned.memory)
            shared += static_cast<int>(memory.resources.size()) - 1;
        culled += static_cast<int>(graph.passes.size() - steps.size());
    }
    fmt::print("[ graph ] 3000 graphs: {} resources share memory, {} passes culled\n", shared,
               culled);
    EXPECT_GT(shared, 500);
    EXPECT_GT(culled, 500);
}

/// Whether an order of all passes gives every reader the version that it names.
bool is_valid(const FrameGraph& graph, const std::vector<int>& passes) {
    std::map<std::string, std::string> last;
    std::set<std::string> seen;
    for (const int p : passes) {
        const Pass& executed = graph.passes[static_cast<std::size_t>(p)];
        for (const std::string& name : executed.after)
            if (!seen.contains(name)) return false;
        for (const std::string& text : executed.reads) {
            const Version version = Version::of(text);
            if (last[version.resource] != version.pass) return false;
        }
        for (const std::string& name : executed.updates)
            if (last[name].empty()) return false;
        for (const auto& names : {executed.updates, executed.writes})
            for (const std::string& name : names)
                last[name] = executed.name;
        seen.insert(executed.name);
    }
    return true;
}

TEST(Graph, IsRefusedExactlyWhereNoOrderIsValid) {
    std::mt19937 random(2);
    int refused = 0, planned = 0;
    for (int round = 0; round < 1500; ++round) {
        FrameGraph graph = random_graph(random, 2 + round % 5);
        for (Resource& resource : graph.resources)
            resource.output = true;  // every pass is executed
        // One more condition, which may contradict the others.
        const auto any = [&]() -> Pass& { return graph.passes[random() % graph.passes.size()]; };
        Pass &late = any(), &early = any();
        if (&late == &early) continue;
        late.after.push_back(early.name);
        std::vector<int> permutation(graph.passes.size());
        std::iota(permutation.begin(), permutation.end(), 0);
        bool possible = false;
        do
            possible = is_valid(graph, permutation);
        while (!possible && std::ranges::next_permutation(permutation).found);
        std::string error;
        try {
            std::vector<int> steps;
            for (const Plan::Step& step : plan(graph).steps)
                steps.push_back(step.pass);
            EXPECT_TRUE(is_valid(graph, steps)) << round;
        } catch (const Error& thrown) {
            error = thrown.what();
        }
        EXPECT_EQ(error.empty(), possible) << round << ": " << error;
        ++(possible ? planned : refused);
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(planned, 300);
}

TEST(Graph, SharesOfTheFrameAreRoundedUp) {
    using Sides = std::array<int, 2>;
    EXPECT_EQ((ResourceSize{.share = 1}.sides_px(1281, 719)), (Sides{1281, 719}));
    EXPECT_EQ((ResourceSize{.share = 0.5}.sides_px(1281, 719)), (Sides{641, 360}));
    EXPECT_EQ((ResourceSize{.share = 0.25}.sides_px(3, 1)), (Sides{1, 1}));
    EXPECT_EQ((ResourceSize{.share = 0, .width = 256, .height = 64}.sides_px(8, 8)),
              (Sides{256, 64}));
}

TEST(Graph, OutputsAndWhatIsKeptShareNoMemory) {
    FrameGraph graph{{texture("a"),
                      texture("b"),
                      texture("c"),
                      {.name = "kept", .lifetime = Lifetime::Kept},
                      texture("end", true)},
                     {pass("1", {"kept@before"}, {"a"}), pass("2", {"a"}, {"b"}),
                      pass("3", {"b"}, {"c", "kept"}), pass("4", {"c"}, {"end"})}};
    const std::vector<int> memory = plan(graph).memory_of;
    EXPECT_EQ(memory[0], memory[2]);  // a has been read when c begins
    EXPECT_NE(memory[0], memory[1]);
    for (const int other : {0, 1, 2, 4})
        EXPECT_NE(memory[3], memory[static_cast<std::size_t>(other)]);
    for (const int other : {0, 1, 2, 3})
        EXPECT_NE(memory[4], memory[static_cast<std::size_t>(other)]);
    graph.resources[2].format = PixelFormat::RGBA16F;
    EXPECT_NE(plan(graph).memory_of[0], plan(graph).memory_of[2]);
}

TEST(CorePasses, AreAGraphWhateverAFrameHas) {
    for (int bits = 0; bits < 1 << 10; ++bits) {
        const auto is = [&](int bit) { return (bits >> bit & 1) != 0; };
        FrameFacts facts{.outside = is(0),
                         .radiance = is(1),
                         .antialias = is(2),
                         .overlays = is(3),
                         .surface = is(9),
                         .audited = is(4),
                         .displaced = is(5),
                         .height_steps = is(6),
                         .varying_targets = is(7) ? 3 : 0};
        if (is(8)) facts.natives = {"moth", "owl"};
        const FrameGraph graph = core_frame(facts).graph;
        const Names names = order(graph);
        Names expected{"select", "geometry", "terrain"};
        if (facts.outside) expected.push_back("side");
        expected.push_back("background");
        if (facts.radiance) expected.push_back("post");
        if (facts.antialias) expected.insert(expected.end(), {"copy", "edges", "antialias"});
        // Of these passes, whatever others there are.
        Names found = names;
        std::erase_if(found, [&](const std::string& name) {
            return std::ranges::find(expected, name) == expected.end();
        });
        EXPECT_EQ(found, expected) << bits;
    }
}

TEST(CorePasses, AreShownWithTheirOrderAndMemory) {
    const FrameGraph graph = core_frame({.radiance = true}).graph;
    const std::string text = dot_text(graph, plan(graph), "frame");
    EXPECT_NE(text.find("\"pass geometry\" -> \"gbuffer\";"), std::string::npos) << text;
    EXPECT_NE(text.find("\"depth\" -> \"pass terrain\" [label=\"@geometry\", fontsize=8];"),
              std::string::npos);
    EXPECT_NE(text.find("label=\"light\\nhost, unused\""), std::string::npos);
    EXPECT_NE(text.find("radiance\\n4 x 16-bit float, frame\\nmemory"), std::string::npos);
}

}  // namespace
}  // namespace relevo::render::test_graph

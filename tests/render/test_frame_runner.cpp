// How often passes are executed, and what their bodies may use.
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dem/load.h"
#include "gl/context.h"
#include "render/frame_runner.h"
#include "render/ground.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_frame_runner {
namespace {

Resource kept(const std::string& name, double share) {
    return {.name = name, .size = {.share = share}, .lifetime = Lifetime::Kept, .output = true};
}

/// A renderer without effects of which nothing is asked.
struct NoServices : FrameServices {
    void upload_blocks(const FrameBlock&) override {}
    void make_footprint(const Footprint&) override {}
    Instances& instances() override { throw std::logic_error("there are no instances"); }
    void prepare_native(const std::string&, PassContext&) override {}
};

/// Passes of the host that count how often they are executed.
class FrameRunnerTest : public testing::Test {
  protected:
    void add(When when, const Resource& target) {
        Pass pass{.name = "makes " + target.name,
                  .kind = PassKind::Host,
                  .when = when,
                  .parameters = {"terrain.normal"},
                  .writes = {target.name}};
        pass.body = [this, name = target.name](PassContext& frame) {
            if (body) body(frame);
            ++executed[name];
        };
        frames.within.resources.push_back(target);
        frames.within.passes.push_back(std::move(pass));
    }

    void draw() {
        PassContext frame{.terrain = terrain,
                          .ground = ground,
                          .inputs = inputs,
                          .block = block,
                          .tiles = tiles,
                          .width_px = 60,
                          .height_px = 41,
                          .plan = runner.plan(),
                          .targets = runner.targets(),
                          .services = services};
        runner.run(frame, /*night=*/false, nullptr);
    }

    gl::Context context{{.device = test::gl_device(), .debug = true}};
    dem::Heightfield dem = dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    Ground ground = make_ground(dem);
    Terrain terrain{dem, ground.frame, {.max_array_layers = context.info().max_array_layers}};
    FrameInputs inputs;
    FrameBlock block{};
    TileSelection tiles;
    NoServices services;
    shader::ParamStore values = [] {
        shader::ParamStore store;
        shader::Param param;
        param.name = "terrain_normal";
        param.address = "terrain.normal";
        param.type = shader::ParamType::Float;
        store.declare({param});
        return store;
    }();
    StitchedFrames frames;
    ProgramCache cache;
    WatchedPrograms programs{frames, cache, {}};
    TexturePool pool;
    FrameRunner runner{
        context, frames, programs, pool, [](const auto&, const Terrain&) { return nullptr; },
        values};
    std::map<std::string, int> executed;
    std::function<void(PassContext&)> body;
};

TEST_F(FrameRunnerTest, ExecutesAPassWhenWhatItDependsOnHasChanged) {
    using Counts = std::map<std::string, int>;
    add(When::Frame, kept("frame", 1));
    add(When::Sun, kept("sun", 1));
    add(When::Parameters, kept("parameters", 1));
    add(When::Dem, kept("dem", 1));
    add(When::Dem, {.name = "outside", .lifetime = Lifetime::Provided, .output = true});
    runner.arrange(false, 60, 41);
    draw();
    draw();
    EXPECT_EQ(executed,
              (Counts{{"frame", 2}, {"sun", 1}, {"parameters", 1}, {"dem", 1}, {"outside", 1}}));
    inputs.sun.direction = {0, 1, 0};
    draw();
    EXPECT_EQ(executed["sun"], 2);
    EXPECT_EQ(executed["dem"], 1);
    values.set("terrain.normal", shader::ParamValue{0.5});
    draw();
    EXPECT_EQ(executed["parameters"], 2);
    EXPECT_EQ(executed["sun"], 2);
    terrain.displace({.down_m = 1, .up_m = 2});  // another ground
    draw();
    EXPECT_EQ(executed,
              (Counts{{"frame", 5}, {"sun", 3}, {"parameters", 3}, {"dem", 2}, {"outside", 2}}));
    // Memory of another size is empty. What the pass has made itself is not.
    runner.arrange(false, 80, 40);
    draw();
    EXPECT_EQ(executed,
              (Counts{{"frame", 6}, {"sun", 4}, {"parameters", 4}, {"dem", 3}, {"outside", 2}}));
}

TEST_F(FrameRunnerTest, ARarePassFollowsTheOneThatItReads) {
    add(When::Sun, kept("light", 1));
    add(When::Dem, kept("blurred", 1));
    frames.within.passes[1].reads = {"light"};
    runner.arrange(false, 60, 41);
    draw();
    inputs.sun.direction = {0, 1, 0};
    draw();
    draw();
    EXPECT_EQ(executed["light"], 2);
    EXPECT_EQ(executed["blurred"], 2);
}

TEST_F(FrameRunnerTest, WhatIsKeptIsNothingAtFirst) {
    add(When::Frame, {.name = "kept",
                      .format = PixelFormat::RGBA32F,
                      .lifetime = Lifetime::Kept,
                      .output = true});
    runner.arrange(false, 60, 41);
    std::vector<float> texels(60 * 41 * 4, 1);
    body = [&](PassContext& frame) { frame.texture("kept").read_floats(texels); };
    draw();
    EXPECT_EQ(texels, std::vector<float>(texels.size(), 0));
}

TEST_F(FrameRunnerTest, APassThatFailsIsExecutedAgain) {
    add(When::Dem, kept("dem", 1));
    runner.arrange(false, 60, 41);
    body = [](PassContext&) { failed("no luck"); };
    EXPECT_EQ(test::error_of([&] { draw(); }), "exit 1: no luck");
    body = nullptr;
    draw();
    EXPECT_EQ(executed["dem"], 1);
}

TEST_F(FrameRunnerTest, ABodyHasWhatItsPassDeclares) {
    add(When::Frame, kept("half", 0.5));
    add(When::Frame,
        {.name = "numbers", .kind = ResourceKind::Buffer, .size = {.bytes = 24}, .output = true});
    runner.arrange(false, 60, 41);
    std::vector<std::string> seen;
    body = [&](PassContext& frame) {
        if (frame.pass->name == "makes numbers") {
            EXPECT_EQ(frame.buffer("numbers").size(), 24u);
            seen.push_back(test::error_of([&] { frame.texture("half"); }));
            seen.push_back(test::error_of([&] { frame.texture("numbers"); }));
        } else {
            EXPECT_EQ(frame.texture("half").extent().width, 30);
            EXPECT_EQ(frame.texture("half").extent().height, 21);
        }
    };
    draw();
    EXPECT_EQ(seen, (std::vector<std::string>{
                        "exit 1: render: graph: pass makes numbers uses half, which it does not "
                        "declare",
                        "exit 1: render: graph: pass makes numbers uses numbers, which is not of "
                        "that kind"}));
}

TEST_F(FrameRunnerTest, ASizeThatTheDeviceRefusesLeavesTheOldOne) {
    add(When::Frame, kept("picture", 1));
    runner.arrange(false, 60, 41);
    const int too_large = 2 * context.info().max_texture_size;
    EXPECT_NE(test::error_of([&] { runner.arrange(false, too_large, 8); }), "no error");
    EXPECT_EQ(runner.texture("picture").extent().width, 60);
    draw();
    EXPECT_EQ(executed["picture"], 1);
}

}  // namespace
}  // namespace relevo::render::test_frame_runner

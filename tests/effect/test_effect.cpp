// Manifest and GLSL of a plugin together.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effect/effect.h"
#include "effect/plugins.h"

namespace relevo::effect::test::test_effect {
namespace {

using relevo::test::error_of;

const std::string kHook = "void haze_on_albedo(inout Surface s) {}\n";

struct Mismatch {
    const char* name;
    const char* members;
    std::string glsl;
    const char* message;  ///< behind "exit 3: "
};

class EffectError : public testing::TestWithParam<Mismatch> {};

TEST_P(EffectError, NamesFileAndLine) {
    const Plugins plugins;
    plugins.add("haze", GetParam().members, GetParam().glsl);
    plugins.write("plugins/haze/a.png", "");
    plugins.write("plugins/haze/more.glsl", kHook);
    EXPECT_EQ(plugins.relative(
                  error_of([&] { load_effect(plugins.plugins() / "haze", plugins.data()); })),
              std::string("exit 3: ") + GetParam().message);
}

constexpr const char* kNoise =
    R"("textures": {"noise": {"kind": "3d", "file": "a.png", "encoding": "linear"}})";

INSTANTIATE_TEST_SUITE_P(
    All, EffectError,
    testing::Values(
        Mismatch{"Glsl", "", "\nvoid haze_on_albedo(Surface s) {}",
                 "shader: plugins/haze/haze.glsl:2: haze_on_albedo: wrong signature, expected "
                 "void haze_on_albedo(inout Surface) but got void haze_on_albedo(in Surface)"},
        Mismatch{
            "DoesNothing", "", "float haze_f() { return 1.0; }",
            "plugin: plugins/haze/plugin.json: no hook, module, marks or instances, so it does "
            "nothing; define a function such as haze_on_albedo"},
        Mismatch{"NotWanted", R"("wants": ["shadow"])",
                 "void haze_on_albedo(inout Surface s) {\n#if HAS_sky\n#endif\n}",
                 "plugin: plugins/haze/haze.glsl:2: HAS_sky: plugins/haze/plugin.json does "
                 "not want it; add \"sky\" to its \"wants\""},
        Mismatch{"NoTexture", kNoise, "uniform sampler3D haze_nois;\n" + kHook,
                 "plugin: plugins/haze/haze.glsl:1: haze_nois: plugins/haze/plugin.json has "
                 "no texture nois; did you mean noise?"},
        Mismatch{"WrongSampler", kNoise, "\nuniform sampler2D haze_noise;\n" + kHook,
                 "plugin: plugins/haze/haze.glsl:2: haze_noise: expected a sampler3D for the "
                 "texture noise of plugins/haze/plugin.json:1 but got a sampler2D"},
        Mismatch{"DisplacesWithoutABound", "",
                 "\nvoid haze_on_displace(in VertexFrame v, inout vec3 p) { p += v.up; }",
                 "plugin: plugins/haze/haze.glsl:2: haze_on_displace: "
                 "plugins/haze/plugin.json does not say how far it moves the ground; add "
                 "\"displaces\": {\"down_m\": D, \"up_m\": U} with the most metres down and up, or "
                 "\"displaces\": {\"to_m\": H} where ground ends between its own height and H"},
        Mismatch{"DisplacesByAWord", R"("displaces": {"up_m": "haze.tall_m"})",
                 "uniform int haze_tall_m = 9; //@ range(0, 50)\n"
                 "void haze_on_displace(in VertexFrame v, inout vec3 p) { p += v.up; }",
                 "plugin: plugins/haze/plugin.json:1: displaces: expected a parameter of "
                 "type float, not host, but got \"haze.tall_m\", which is of type int"},
        Mismatch{"DisplacesByAHostsValue", R"("displaces": {"up_m": "haze.tall_m"})",
                 "uniform float haze_tall_m = 9.0; //@ host\n"
                 "void haze_on_displace(in VertexFrame v, inout vec3 p) { p += v.up; }",
                 "plugin: plugins/haze/plugin.json:1: displaces: expected a parameter of "
                 "type float, not host, but got \"haze.tall_m\", which is host"},
        Mismatch{"PassWithoutAFunction", R"("passes": {"blur": {}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur: expected one function vec4 "
                 "haze_pass_blur(in Texel t) in the plugin's GLSL but got 0"},
        Mismatch{"FunctionWithoutAPass", "",
                 "\nvec4 haze_pass_blur(in Texel t) { return vec4(0.0); }\n" + kHook,
                 "plugin: plugins/haze/haze.glsl:2: haze_pass_blur: plugins/haze/plugin.json has "
                 "no pass blur; add \"passes\": {\"blur\": {}}"},
        Mismatch{"PassOfAnotherSignature", R"("passes": {"blur": {}})",
                 "vec4 haze_pass_blur(in vec2 at) { return vec4(0.0); }\n" + kHook,
                 "shader: plugins/haze/haze.glsl:1: haze_pass_blur: wrong signature, expected "
                 "vec4 haze_pass_blur(in Texel), or of kind 3d vec4 haze_pass_blur(in Voxel), or "
                 "of kind compute void haze_pass_blur(in Invocation) but got vec4 "
                 "haze_pass_blur(in vec2)"},
        Mismatch{"PassOfAnotherKind", R"("passes": {"blur": {"kind": "3d", "size": [4, 4, 4]}})",
                 "\nvec4 haze_pass_blur(in Texel t) { return vec4(0.0); }\n" + kHook,
                 "plugin: plugins/haze/haze.glsl:2: haze_pass_blur: it is the function of a pass "
                 "of kind full, but the kind in plugins/haze/plugin.json:1 is 3d; expected vec4 "
                 "haze_pass_blur(in Voxel v)"},
        Mismatch{"PassOfNoKind", R"("passes": {"blur": {"kind": "cube"}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.kind: expected one of full, 3d, "
                 "compute but got \"cube\""},
        Mismatch{"FullPassWithWorkGroups", R"("passes": {"blur": {"local_size": [8, 8]}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.local_size: only passes of kind "
                 "compute have this, but the kind is full"},
        Mismatch{"VolumeOfAScale", R"("passes": {"blur": {"kind": "3d", "scale": 0.5}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.scale: only passes of kind full "
                 "or compute have this, but the kind is 3d"},
        Mismatch{"VolumeWithoutASize", R"("passes": {"blur": {"kind": "3d"}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur: expected a member \"size\""},
        Mismatch{"VolumeOfNothing", R"("passes": {"blur": {"kind": "3d", "size": [4, 0, 4]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.size: expected 3 whole numbers "
                 "from 1 to 2048, 2048 and 2048"},
        Mismatch{"VolumeOfTooMuchMemory",
                 R"("passes": {"blur": {"kind": "3d", "size": [2048, 2048, 2048]}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes: expected at most 32 passes and 256 "
                 "MiB of fixed size but got 1 and 65536"},
        Mismatch{"ABillionWorkGroups",
                 R"("passes": {"sum": {"kind": "compute", "writes": "uints", "count": 4,
                               "local_size": [64], "work_groups": [1000000000]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:2: passes.sum.work_groups: expected 1 to 3 "
                 "whole numbers from 1 to 65535, 65535 and 65535"},
        Mismatch{"ABillionWorkGroupsOverThreeAxes",
                 R"("passes": {"sum": {"kind": "compute", "writes": "uints", "count": 4,
                               "local_size": [64], "work_groups": [1000, 1000, 1000]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:2: passes.sum.work_groups: expected at most "
                 "134.217728 million invocations but got 64000 million"},
        Mismatch{"WorkGroupsTooLarge",
                 R"("passes": {"sum": {"kind": "compute", "local_size": [64, 32]}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.sum.local_size: expected at most 1024 "
                 "invocations in a work group, which every device has, but got 64 x 32 x 1"},
        Mismatch{"WorkGroupsWithoutALocalSize", R"("passes": {"sum": {"kind": "compute"}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.sum: expected a member "
                 "\"local_size\""},
        Mismatch{"WorkGroupsOfTwoNumbers",
                 R"("passes": {"sum": {"kind": "compute", "local_size": [8], "over": "frame",
                               "work_groups": [8]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.sum.over: expected this or "
                 "\"work_groups\", not both"},
        Mismatch{"OverNothing",
                 R"("passes": {"sum": {"kind": "compute", "local_size": [8], "over": "scene"}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.sum.over: expected \"frame\" or the "
                 "name of a pass but got \"scene\""},
        Mismatch{"BufferWithAFormat",
                 R"("passes": {"sum": {"kind": "compute", "writes": "floats", "count": 9,
                               "format": "r32f", "local_size": [8]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:2: passes.sum.format: a buffer has no such key; "
                 "its length is \"count\""},
        Mismatch{"BufferTooLong",
                 R"("passes": {"sum": {"kind": "compute", "writes": "floats", "count": 65537,
                               "local_size": [8]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.sum.count: expected a whole number in "
                 "[1, 65536] but got 65537"},
        Mismatch{"SamplerOfABuffer",
                 R"("passes": {"sum": {"kind": "compute", "writes": "uints", "count": 9,
                               "local_size": [8]}})",
                 "uniform sampler2D haze_sum;\n"
                 "void haze_pass_sum(in Invocation i) {}\n" +
                     kHook,
                 "plugin: plugins/haze/haze.glsl:1: haze_sum: expected a usamplerBuffer for the "
                 "pass sum of plugins/haze/plugin.json:1 but got a sampler2D"},
        Mismatch{"InstancesWithoutAFunction",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9,
                    "levels": [{"meshes": ["haze.glsl"]}]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: instances.oak: expected one function void "
                 "haze_place_oak(in InstanceSite at, inout Instance it) in the plugin's GLSL but "
                 "got 0"},
        Mismatch{
            "InstancesOfNoName", "",
            "void haze_place_oak(in InstanceSite at, inout Instance it) {}\n" + kHook,
            "plugin: plugins/haze/haze.glsl:1: haze_place_oak: plugins/haze/plugin.json has no "
            "instances oak; add \"instances\": {\"oak\": {...}}"},
        Mismatch{"InstancesWithoutAMesh",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9, "levels": [{}]}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: instances.oak.levels.meshes: expected a mesh "
                 "of each kind, 1 to 8 at every level, or none at the last level, for sprites"},
        Mismatch{"InstancesOfAMeshThatIsNotThere",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9,
                    "levels": [{"meshes": ["oak.obj"]}]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:2: instances.oak.levels.meshes: "
                 "plugins/haze/oak.obj: no such file"},
        Mismatch{
            "InstancesTooClose",
            R"("instances": {"oak": {"spacing_m": 1e-9, "height_m": 9, "levels": [{}]}})", kHook,
            "plugin: plugins/haze/plugin.json:1: instances.oak.spacing_m: expected a number in "
            "[0.5, 100000] but got 1e-09"},
        Mismatch{"InstancesThatLetTooMuchLightThrough",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9, "light_through": 1.5,
                    "levels": [{"meshes": ["haze.glsl"]}]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: instances.oak.light_through: expected a "
                 "number in [0, 1] but got 1.5"},
        Mismatch{"InstancesWithoutAShadowThatLetLightThrough",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9, "casts_shadow": false,
                    "light_through": 0.5, "levels": [{"meshes": ["haze.glsl"]}]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:2: instances.oak.light_through: expected none "
                 "where casts_shadow is false"},
        Mismatch{"InstancesWhoseShadowIsANumber",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9, "casts_shadow": 1,
                    "levels": [{"meshes": ["haze.glsl"]}]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: instances.oak.casts_shadow: expected true or "
                 "false but got 1"},
        Mismatch{"InstancesOfAMeshOutside",
                 R"("instances": {"oak": {"spacing_m": 5, "height_m": 9,
                    "levels": [{"meshes": ["../oak.obj"]}]}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:2: instances.oak.levels.meshes: expected a file "
                 "of the plugin's own folder but got ../oak.obj"},
        Mismatch{"PassOfTwoSizes", R"("passes": {"blur": {"scale": 0.5, "width": 4, "height": 4}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.scale: expected a scale of the "
                 "frame's size, or width and height, not both"},
        Mismatch{"PassOfAThird", R"("passes": {"blur": {"scale": 0.3}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.scale: expected 1, 0.5, 0.25 or "
                 "another half of these down to 0.015625 but got 0.3"},
        Mismatch{"PassTooLarge", R"("passes": {"blur": {"width": 1000000000, "height": 4}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.width: expected a whole number "
                 "in [1, 4096] but got 1000000000"},
        Mismatch{"PassesOfTooMuchMemory",
                 R"("passes": {"a": {"width": 4096, "height": 4096, "format": "rgba32f"},)"
                 R"("b": {"width": 64, "height": 64}})",
                 kHook,
                 "plugin: plugins/haze/plugin.json:1: passes: expected at most 32 passes and 256 "
                 "MiB of fixed size but got 2 and 257"},
        Mismatch{"PassChangedByNothing", R"("passes": {"blur": {"when": "changed"}})", kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur.parameters: expected the "
                 "parameters that change it with \"when\": \"changed\", and only then"},
        Mismatch{"PassChangedByAnothers",
                 R"("passes": {"blur": {"when": "changed", "parameters": ["width"]}})",
                 "vec4 haze_pass_blur(in Texel t) { return vec4(0.0); }\n" + kHook,
                 "plugin: plugins/haze/plugin.json:1: passes.blur: parameters: the plugin has no "
                 "haze.width"},
        Mismatch{"SamplerOfAPass", R"("passes": {"blur": {}})",
                 "uniform sampler3D haze_blur;\n"
                 "vec4 haze_pass_blur(in Texel t) { return vec4(0.0); }\n" +
                     kHook,
                 "plugin: plugins/haze/haze.glsl:1: haze_blur: expected a sampler2D for the pass "
                 "blur of plugins/haze/plugin.json:1 but got a sampler3D"},
        Mismatch{"NothingOfCores", "",
                 "uniform sampler2D haze_map; //@ from(core.colour)\n" + kHook,
                 "plugin: plugins/haze/haze.glsl:1: haze_map: expected one of core.radiance, "
                 "core.depth, core.ground_depth, core.normal, core.shadow but got core.colour"},
        Mismatch{"HookInTwoFiles", R"("glsl": ["more.glsl", "haze.glsl"])", "\n" + kHook,
                 "plugin: plugins/haze/haze.glsl:2: haze_on_albedo: defined already in "
                 "plugins/haze/more.glsl:1"}),
    [](const auto& test) { return test.param.name; });

TEST(Effect, AnotherPluginsTextureNeedsNoEntry) {
    const Plugins plugins;
    plugins.add("haze", "", "uniform sampler2D haze_map; //@ from(vsm.moments)\n" + kHook);
    EXPECT_EQ(load_effect(plugins.plugins() / "haze", plugins.data()).snippets.size(), 1u);
}

}  // namespace
}  // namespace relevo::effect::test::test_effect

// Passes of the kinds 3d and compute: what they leave for hooks, against the same on the processor.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "dem/load.h"
#include "drawn.h"
#include "effect/effect.h"

namespace relevo::render::test_compute_passes {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth_px = 64, kHeight_px = 48;

dem::Heightfield bundled() {
    return dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
}

/// An effect with passes, whose pixels are numbers of 12 bits, four a channel.
/// @param number  GLSL for the number of the pixel n, as uint
effect::Effect written(const std::string& passes, const std::string& glsl,
                       const std::string& number) {
    const std::filesystem::path folder = test::scratch_dir("compute") / "probe";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json") << fmt::format(
        R"({{"format": 1, "id": "probe", "name": "P", "version": "1", "passes": {}}})", passes);
    std::ofstream(folder / "probe.glsl") << fmt::format(
        "{}\n"
        "uint probe_number(in int n) {{ return {}; }}\n"
        "void probe_on_overlay(in Pixel p, inout vec4 over) {{\n"
        "    uint v = probe_number(int(p.at_px.x) + {} * int(p.at_px.y));\n"
        "    over = vec4(vec3(uvec3(v, v >> 4u, v >> 8u) & 15u) / 15.0, 1.0);\n"
        "}}\n",
        glsl, number, kWidth_px);
    return effect::load_effect(folder, test::source_dir() / "data");
}

/// A drawn frame with such an effect: half ground, half sky.
class Frame {
  public:
    explicit Frame(const effect::Effect& effect)
        : drawn(bundled(), {}, kWidth_px, kHeight_px, 0, {effect}) {
        drawn.stand(0.5, 0.5, 2500, 300, -4);
    }

    /// The numbers of the first pixels, in rows from below.
    std::vector<int> numbers(int count) {
        drawn.radiance();
        const image::Image8 picture = drawn.renderer().read_output();
        std::vector<int> result;
        for (int n = 0; n < count; ++n) {
            int number = 0;
            for (int c = 0; c < 3; ++c) {
                const int value = picture.at(n % kWidth_px, kHeight_px - 1 - n / kWidth_px, c);
                number |= static_cast<int>(std::lround(value / 17.0)) << (4 * c);
            }
            result.push_back(number);
        }
        return result;
    }

    test::Drawn drawn;
};

constexpr int kBins = 32;

/// A histogram of luminance: each work group counts in shared memory, then adds its counts.
effect::Effect histogram() {
    return written(
        R"({"histogram": {"kind": "compute", "writes": "uints", "count": 32,
                          "local_size": [16, 16], "over": "frame"}})",
        "uniform sampler2D probe_scene; //@ from(core.radiance)\n"
        "uniform usamplerBuffer probe_histogram;\n"
        "shared uint probe_counts[32];\n"
        "void probe_pass_histogram(in Invocation i) {\n"
        "    if (gl_LocalInvocationIndex < 32u) probe_counts[gl_LocalInvocationIndex] = 0u;\n"
        "    barrier();\n"
        "    if (all(lessThan(i.at.xy, i.size.xy))) {\n"
        "        vec3 light = texelFetch(probe_scene, i.at.xy, 0).rgb / frame.exposure;\n"
        "        float luminance = dot(light, vec3(0.25, 0.5, 0.25));\n"
        "        atomicAdd(probe_counts[int(clamp(luminance * 100.0, 0.0, 31.0))], 1u);\n"
        "    }\n"
        "    barrier();\n"
        "    if (gl_LocalInvocationIndex < 32u)\n"
        "        atomicAdd(probe_histogram_out[gl_LocalInvocationIndex],\n"
        "                  probe_counts[gl_LocalInvocationIndex]);\n"
        "}\n",
        "n < 32 ? texelFetch(probe_histogram, n).r : 0u");
}

/// The same on the processor. @param edge  receives how many pixels are within 1e-4 of a bin's edge
std::vector<int> counted(const image::ImageF& radiance, int& edge) {
    std::vector<int> bins(kBins, 0);
    edge = 0;
    for (int y = 0; y < radiance.height; ++y)
        for (int x = 0; x < radiance.width; ++x) {
            const double luminance = 0.25 * radiance.at(x, y, 0) + 0.5 * radiance.at(x, y, 1) +
                                     0.25 * radiance.at(x, y, 2);
            const double bin = std::clamp(100 * luminance, 0.0, kBins - 1.0);
            ++bins[static_cast<std::size_t>(bin)];
            edge += std::abs(bin - std::round(bin)) < 1e-4 ? 1 : 0;
        }
    return bins;
}

TEST(ComputePass, AHistogramIsThatOfTheProcessor) {
    Frame frame(histogram());
    for (const char* utc : {"2026-06-21T15:00Z", "2026-06-21T19:00Z"}) {
        frame.drawn.shine(utc);
        const std::vector<int> found = frame.numbers(kBins);
        const image::ImageF radiance = frame.drawn.renderer().read_radiance();
        int edge = 0;
        const std::vector<int> expected = counted(radiance, edge);
        int sum = 0, off = 0, used = 0;
        for (std::size_t i = 0; i < kBins; ++i) {
            sum += found[i];
            off += std::abs(found[i] - expected[i]);
            used += found[i] > 0 ? 1 : 0;
        }
        EXPECT_EQ(sum, kWidth_px * kHeight_px);
        EXPECT_LE(off, 2 * edge) << utc;
        EXPECT_LT(edge, 20) << utc;
        EXPECT_GT(used, 4) << utc;
        EXPECT_EQ(frame.numbers(kBins), found) << "counts of the frame before remain";
    }
}

TEST(VolumePass, EachTexelIsComputedAndReadByASampler3D) {
    Frame frame(written(
        R"({"block": {"kind": "3d", "size": [7, 5, 3], "format": "r32f"}})",
        "uniform sampler3D probe_block;\n"
        "vec4 probe_pass_block(in Voxel v) {\n"
        "    vec3 cell = v.at * v.size_px - 0.5;\n"
        "    return vec4(dot(cell, vec3(1.0, 10.0, 100.0)) + v.at_px.x - cell.x - 0.5);\n"
        "}\n",
        // Texels, then a point halfway between eight.
        "n < 105 ? uint(texelFetch(probe_block, ivec3(n % 7, n / 7 % 5, n / 35), 0).r + 0.5)\n"
        "        : uint(2.0 * texture(probe_block, vec3(3.0 / 7.0, 2.0 / 5.0, 1.0 / 3.0)).r + "
        "0.5)"));
    const std::vector<int> found = frame.numbers(106);
    for (int n = 0; n < 105; ++n)
        EXPECT_EQ(found[static_cast<std::size_t>(n)], n % 7 + 10 * (n / 7 % 5) + 100 * (n / 35));
    EXPECT_EQ(found[105], 2 * 2.5 + 2 * 15 + 2 * 50);
}

TEST(ComputePass, ATextureIsStoredAndZeroWhereNothingIs) {
    Frame frame(written(
        R"({"sums": {"kind": "compute", "width": 20, "height": 3, "local_size": [8],
                     "format": "r32f", "filter": "nearest"}})",
        "uniform sampler2D probe_sums;\n"
        "shared int probe_each[8];\n"
        // Sums within work groups of eight. The last one is half beyond the texture.
        "void probe_pass_sums(in Invocation i) {\n"
        "    int own = int(gl_LocalInvocationID.x);\n"
        "    probe_each[own] = i.at.x < i.size.x ? i.at.x + 100 * i.at.y : 0;\n"
        "    barrier();\n"
        "    int sum = 0;\n"
        "    for (int k = 0; k < 8; ++k) sum += probe_each[k];\n"
        "    if (i.at.x % 2 == 0 && i.at.x < i.size.x)\n"
        "        imageStore(probe_sums_out, i.at.xy, vec4(sum));\n"
        "}\n",
        "uint(texelFetch(probe_sums, ivec2(n % 20, min(n / 20, 2)), 0).r)"));
    const std::vector<int> found = frame.numbers(60);
    for (int n = 0; n < 60; ++n) {
        const int x = n % 20, y = n / 20, group = x / 8, members = group < 2 ? 8 : 4;
        int sum = 0;
        for (int k = 0; k < members; ++k)
            sum += 8 * group + k + 100 * y;
        EXPECT_EQ(found[static_cast<std::size_t>(n)], x % 2 == 0 ? sum : 0) << x << ' ' << y;
    }
}

TEST(ComputePass, AVolumeAndFloatsAreStoredToo) {
    Frame frame(written(
        R"({"cells": {"kind": "compute", "size": [4, 3, 2], "local_size": [2, 2, 2],
                      "format": "r32f"},
            "lengths": {"kind": "compute", "writes": "floats", "count": 24, "local_size": [32]}})",
        "uniform sampler3D probe_cells;\n"
        "uniform samplerBuffer probe_lengths;\n"
        "void probe_pass_cells(in Invocation i) {\n"
        "    if (all(lessThan(i.at, i.size)))\n"
        "        imageStore(probe_cells_out, i.at, vec4(i.at.x + 4 * i.at.y + 12 * i.at.z));\n"
        "}\n"
        "void probe_pass_lengths(in Invocation i) {\n"
        "    if (i.at.x >= i.size.x) return;\n"
        "    int n = i.at.x;\n"
        "    probe_lengths_out[n] =\n"
        "        2.0 * texelFetch(probe_cells, ivec3(n % 4, n / 4 % 3, n / 12), 0).r;\n"
        "}\n",
        "n < 24 ? uint(texelFetch(probe_lengths, n).r) : 0u"));
    const std::vector<int> found = frame.numbers(24);
    for (int n = 0; n < 24; ++n)
        EXPECT_EQ(found[static_cast<std::size_t>(n)], 2 * n);
}

TEST(ComputePass, ManyInvocationsRunOnceEach) {
    // More than are run at once under a watch.
    Frame frame(written(R"({"count": {"kind": "compute", "writes": "uints", "count": 1,
                              "local_size": [256], "work_groups": [12000]}})",
                        "uniform usamplerBuffer probe_count;\n"
                        "void probe_pass_count(in Invocation i) {\n"
                        "    if (i.at.x < i.size.x && i.size.x == 3072000)\n"
                        "        atomicAdd(probe_count_out[0], 1u);\n"
                        "}\n",
                        "texelFetch(probe_count, 0).r >> uint(12 * min(n, 1))"));
    const std::vector<int> found = frame.numbers(2);
    EXPECT_EQ(found[0] + 4096 * found[1], 12000 * 256);
}

TEST(ComputePass, RunsWhenWhatItDependsOnHasChanged) {
    for (const auto& [when, follows_sun, follows_eye] :
         {std::tuple("frame", true, true), {"sun", true, false}, {"dem", false, false}}) {
        const std::string common = fmt::format(R"("when": "{}"}})", when);
        Frame frame(written(
            fmt::format(R"({{"table": {{"kind": "compute", "writes": "floats", "count": 2,
                                        "local_size": [2], {},
                             "block": {{"kind": "3d", "size": [1, 1, 2], "format": "r32f", {}}})",
                        common, common),
            "uniform samplerBuffer probe_table;\n"
            "uniform sampler3D probe_block;\n"
            "float probe_input(in int n) {\n"
            "    return n == 0 ? abs(frame.sun_direction.x) * 4000.0 : frame.eye_m.z;\n"
            "}\n"
            "void probe_pass_table(in Invocation i) {\n"
            "    probe_table_out[i.at.x] = probe_input(i.at.x);\n"
            "}\n"
            "vec4 probe_pass_block(in Voxel v) { return vec4(probe_input(int(v.at_px.z))); }\n",
            "uint(n < 2 ? texelFetch(probe_table, n).r\n"
            "           : texelFetch(probe_block, ivec3(0, 0, n & 1), 0).r)"));
        const std::vector<int> before = frame.numbers(4);
        EXPECT_EQ(before[2], before[0]);
        EXPECT_EQ(before[3], before[1]);
        frame.drawn.stand(0.5, 0.5, 3500, 300, -10);
        const std::vector<int> moved = frame.numbers(4);
        frame.drawn.shine("2026-06-21T19:00Z");
        const std::vector<int> later = frame.numbers(4);
        for (const std::size_t k : {0U, 2U}) {
            EXPECT_EQ(moved[k + 1] != before[k + 1], follows_eye) << when;
            EXPECT_EQ(later[k] != before[k], follows_sun) << when;
        }
    }
}

struct Refused {
    const char* name;
    const char* passes;
    const char* glsl;
    const char* message;
};

class ComputePassError : public testing::TestWithParam<Refused> {};

TEST_P(ComputePassError, NamesTheCause) {
    const effect::Effect effect =
        written(GetParam().passes, GetParam().glsl, "texelFetch(probe_a, 0).r");
    EXPECT_THAT(test::error_of([&] { Frame frame(effect); }), HasSubstr(GetParam().message));
}

constexpr const char* kUints =
    R"({"a": {"kind": "compute", "writes": "uints", "count": 4, "local_size": [4]}})";

INSTANTIATE_TEST_SUITE_P(
    , ComputePassError,
    testing::Values(
        Refused{"ItsOwn", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = texelFetch(probe_a, 0).r;\n"
                "}\n",
                "render: graph: pass probe.a both reads probe.a and draws into it"},
        Refused{"OutputInAHook", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "void probe_pass_a(in Invocation i) { probe_a_out[i.at.x] = 1u; }\n"
                "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                "    radiance *= float(probe_a_out[0]);\n"
                "}\n",
                "probe.glsl:3: probe_on_lit uses probe_a_out, which only the pass a writes; others "
                "read it by uniform usamplerBuffer probe_a"},
        Refused{"SharedInAHook", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "shared float probe_s[4];\n"
                "void probe_pass_a(in Invocation i) { probe_a_out[i.at.x] = 1u; }\n"
                "void probe_on_lit(in Surface s, inout vec3 radiance) {\n"
                "    radiance *= probe_s[0];\n"
                "}\n",
                "probe.glsl:2: probe_s is shared memory, which only compute passes have, but the "
                "fragment stage reaches it (main -> hook_lit -> probe_on_lit)"},
        Refused{"BarrierInAHook", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "void probe_pass_a(in Invocation i) { probe_a_out[i.at.x] = 1u; }\n"
                "void probe_on_lit(in Surface s, inout vec3 radiance) { barrier(); }\n",
                "probe.glsl:3: probe_on_lit uses barrier, which only the compute stage has, but "
                "the fragment stage reaches it (main -> hook_lit)"},
        Refused{"DerivativesInAPass", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = uint(dFdx(1.0));\n"
                "}\n",
                "probe.glsl:2: probe_pass_a uses dFdx, which only the fragment stage has, but the "
                "compute stage reaches it (main)"},
        Refused{"TwoSharedVariablesInOne", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "const int probe_n = 1024;\n"
                "shared vec3 probe_s[probe_n * 2], probe_t;\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = uint(probe_s[0].x);\n"
                "}\n",
                "probe.glsl:3: probe_s: expected one variable without an initial value"},
        Refused{"SharedMemoryOfUnknownLength", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "shared vec3 probe_s[2 + probe_n];\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = uint(probe_s[0].x);\n"
                "}\n"
                "const int probe_n = int(sqrt(4.0));\n",
                "probe.glsl:2: probe_s: expected a length of numbers and constants of this file "
                "but got 2 + probe_n"},
        Refused{"MoreSharedMemoryThanDevicesHave", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "const int probe_n = 1024;\n"
                "shared float probe_r[16];\n"
                "shared vec3 probe_s[probe_n + 1024];\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = uint(probe_r[0] + probe_s[0].x);\n"
                "}\n",
                "probe.glsl:4: probe_s: expected at most 32768 bytes of shared memory in a pass, "
                "which every device has, but got 32832 up to here"},
        Refused{"TheDriversError", kUints,
                "uniform usamplerBuffer probe_a;\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = vec3(1.0);\n"
                "}\n",
                "probe.glsl:3"},
        Refused{"SeldomOfAFrame",
                R"({"a": {"kind": "compute", "writes": "uints", "count": 4, "local_size": [4],
                          "when": "sun"}})",
                "uniform sampler2D probe_depth; //@ from(core.depth)\n"
                "uniform usamplerBuffer probe_a;\n"
                "void probe_pass_a(in Invocation i) {\n"
                "    probe_a_out[i.at.x] = uint(texelFetch(probe_depth, i.at.xy, 0).r);\n"
                "}\n",
                "pass probe.a is not executed in every frame but uses depth, which lasts for one "
                "frame"}),
    [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace relevo::render::test_compute_passes

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/paths.h"
#include "base/text.h"
#include "cli/program.h"
#include "effect/preset.h"
#include "effect/registry.h"
#include "effect/selection.h"
#include "golden/reference_compiler.h"
#include "golden/shipped.h"
#include "render/native_host.h"
#include "render/programs.h"
#include "render/renderer.h"
#include "support/support.h"

// Mesa forgives what other drivers refuse; Khronos' own compiler forgives nothing. No device is
// needed: programs are stitched here as a renderer would.

namespace relevo::test::test_reference_compiler {
namespace {

/// With any native effect there is the program "depth".
const std::vector<std::string> kNatives{"native"};

/// What makes the text of a program another one, but for effects and their values.
const std::map<std::string, render::ProgramOptions> kOptions = {
    {"picture", {.shown = true, .natives = kNatives}},
    {"picture of a software device", {.shown = true, .software = true, .natives = kNatives}},
    {"radiance", {.natives = kNatives}},
    {"radiance and overlay", {.overlay_raster = true, .natives = kNatives}},
    {"overlay", {.overlay_raster = true, .shown = true, .natives = kNatives}},
    {"audit", {.shown = true, .audited = true, .natives = kNatives}},
    {"audit of radiance and overlay", {.overlay_raster = true, .audited = true}},
    {"vertex normals", {.vertex_normals = true, .shown = true, .natives = kNatives}},
    {"radiance, vertex normals", {.vertex_normals = true}},
    {"map", {.shown = true, .orthographic = true, .natives = kNatives}},
    {"map, vertex normals", {.vertex_normals = true, .orthographic = true}},
};

/// Programs without those of equal text.
class Programs {
  public:
    struct Program {
        std::string name;  ///< of the first with this text, with what it is drawn for
        std::string vertex, fragment;
        std::string compute{};  ///< instead of both

        ReferenceProgram compiled() const {
            return compute.empty() ? reference_compile(vertex, fragment)
                                   : reference_compile_compute(compute);
        }
    };

    void add(Program program) {
        std::string key = program.vertex + '\0' + program.fragment + program.compute;
        programs_.emplace(std::move(key), std::move(program));
    }
    /// All programs that a selection is drawn with.
    void add(const effect::Selection& selection, const shader::ParamStore& values,
             const std::string& what, const std::string& with,
             const render::ProgramOptions& options, bool constants = false) {
        for (render::ProgramText& text : stitched(selection, values, options, constants).programs)
            add({fmt::format("{} of {}, {}", text.name, what, with), text.stitched.vertex.text,
                 text.stitched.fragment.text, text.stitched.compute.text});
    }

    bool has(const std::string& vertex, const std::string& fragment) const {
        return programs_.contains(vertex + '\0' + fragment);
    }
    std::vector<Program> all() const {
        std::vector<Program> result;
        for (const auto& [key, program] : programs_)
            result.push_back(program);
        return result;
    }

  private:
    std::map<std::string, Program> programs_;
};

/// What the reference compiler does not take, each text once.
std::string refusals(const std::vector<Programs::Program>& programs) {
    std::string refused;
    for (const Programs::Program& program : programs) {
        const std::string why = program.compiled().refused;
        if (!why.empty()) refused += fmt::format("{}:\n{}", program.name, why);
    }
    return refused;
}

TEST(ReferenceCompiler, RefusesWhatIsNoGlsl) {
    const std::string head = "#version 450 core\n";
    const std::string vertex =
        head + "out vec2 at;\nvoid main() { at = vec2(0); gl_Position = vec4(0); }\n";
    const auto refused = [&](const std::string& fragment) {
        return reference_compile(vertex, head + "layout(location = 0) out vec4 light;\n" + fragment)
            .refused;
    };
    EXPECT_EQ(refused("in vec2 at;\nvoid main() { light = at.xyxy; }\n"), "");
    const std::string compiled = refused("void main() { light = vec3(1); }\n");
    EXPECT_NE(compiled.find("cannot convert"), std::string::npos) << compiled;
    const std::string linked = refused("in vec3 at;\nvoid main() { light = at.xyzz; }\n");
    EXPECT_NE(linked.find("Types must match"), std::string::npos) << linked;
}

TEST(ReferenceCompiler, TakesTheProgramsOfEverySelection) {
    const Shipped shipped;
    const shader::ParamStore values = shipped.values();
    Programs programs;
    for (const auto& [what, switches] : shipped.selections()) {
        const effect::Selection selection = effect::select(shipped.registry, {}, switches);
        for (const auto& [with, options] : kOptions) {
            if (with == "picture")
                programs.add(selection, values, what, with, options, /*constants=*/true);
            if (switches.disable.empty() || with == "picture")
                programs.add(selection, values, what, with, options);
        }
    }
    EXPECT_GE(programs.all().size(), 20 * shipped.registry.effects().size());
    EXPECT_EQ(refusals(programs.all()), "");
}

/// What is stitched here is what a renderer links.
TEST(ReferenceCompiler, SeesTheProgramsOfACapture) {
    const Shipped shipped;
    const Ids ids = *shipped.everything().begin();
    Programs programs;
    programs.add(effect::select(shipped.registry, {}, {.only = ids}), shipped.values(), "all", "",
                 {.shown = true, .software = true, .natives = kNatives}, /*constants=*/true);
    const std::filesystem::path dir = scratch_dir(), dump = dir / "shaders";
    const Result taken =
        relevo({"-q", "capture", bundled_dem(), "-o", (dir / "a.png").string(), "--size", "64x48",
                "--dump-shaders", dump.string(), "--only", fmt::format("{}", fmt::join(ids, ","))});
    ASSERT_EQ(taken.status, 0) << taken.err;
    EXPECT_TRUE(read_text(dump / "frame.dot", "test").starts_with("digraph \"frame\" {\n"));
    int compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(dump)) {
        const std::string file = entry.path().string();
        const std::size_t stage = file.find(".frag.glsl");
        if (stage == std::string::npos) continue;
        ++compared;
        EXPECT_TRUE(programs.has(read_text(file.substr(0, stage) + ".vert.glsl", "test"),
                                 read_text(file, "test")))
            << file;
    }
    EXPECT_GE(compared, 5);  // geometry, terrain, background, edges, antialias
}

/// Whether a text has a word, not as the end of a longer one.
bool has_word(const std::string& text, const std::string& word) {
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1))
        if (at == 0 ||
            (std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0 && text[at - 1] != '_'))
            return true;
    return false;
}

/// Neither a disabled effect's file nor anything that it declares is in the programs.
TEST(ReferenceCompiler, FindsNothingOfADisabledEffectInTheText) {
    const Shipped shipped;
    const shader::ParamStore values = shipped.values();
    const auto programs_with = [&](const effect::Switches& switches) {
        Programs programs;
        programs.add(effect::select(shipped.registry, {}, switches), values, "all", "",
                     {.shown = true, .software = true, .natives = kNatives});
        return programs.all();
    };
    const auto names = [](const std::vector<Programs::Program>& programs, const std::string& id) {
        return std::ranges::any_of(programs, [&](const Programs::Program& program) {
            const std::string text = program.vertex + program.fragment + program.compute;
            return has_word(text, id + ".glsl") || has_word(text, id + "_on_");
        });
    };
    std::size_t named = 0;
    std::set<std::string> tried;
    for (const Ids& ids : shipped.everything()) {
        const std::vector<Programs::Program> all = programs_with({.only = ids});
        for (const std::string& id : ids) {
            if (!tried.insert(id).second) continue;
            Ids others = ids;
            std::erase(others, id);
            EXPECT_FALSE(names(programs_with({.only = others, .disable = {id}}), id)) << id;
            named += names(all, id) ? 1 : 0;
        }
    }
    EXPECT_EQ(tried.size(), shipped.registry.effects().size());
    EXPECT_GT(2 * named, tried.size());  // names are found where they are; of some all is native
}

/// Values that are constants in the text decide what a compiler sees of it.
TEST(ReferenceCompiler, TakesEveryValueOfStaticParameters) {
    const Shipped shipped;
    Programs programs;
    int tried = 0;
    for (const shader::Param& param : shipped.registry.params()) {
        if (!param.is_static) continue;
        const effect::Selection selection = effect::select(
            shipped.registry, {}, {.only = Ids{param.address.substr(0, param.address.find('.'))}});
        ASSERT_TRUE(param.type == shader::ParamType::Bool || !param.words.empty()) << param.address;
        for (std::size_t i = 0; i < std::max<std::size_t>(param.words.size(), 2); ++i, ++tried) {
            shader::ParamStore values = shipped.values();
            values.set(param.address, shader::ParamValue{static_cast<double>(i)});
            programs.add(selection, values, fmt::format("{} = {}", param.address, i), "picture",
                         {.shown = true});
        }
    }
    EXPECT_GE(tried, 2);
    EXPECT_EQ(refusals(programs.all()), "");
}

TEST(ReferenceCompiler, TakesTheProgramsOfNativeModules) {
    const Shipped shipped;
    Programs programs;
    for (const effect::Effect& effect : shipped.registry.effects()) {
        if (effect.manifest.module.empty()) continue;
        for (const auto& entry : std::filesystem::directory_iterator(effect.manifest.folder)) {
            const std::filesystem::path& file = entry.path();
            if (!file.string().ends_with(".glsl") || contains(effect.manifest.glsl, file)) continue;
            const render::NativeProgramText text =
                render::native_program_text(read_text(file, "test"));
            programs.add({file.string(), text.vertex, text.fragment});
        }
    }
    if (programs.all().empty()) GTEST_SKIP() << "no plugin with a native module is there";
    EXPECT_EQ(refusals(programs.all()), "");
}

/// The programs of pictures with all effects that go together.
Programs programs_of_everything(const Shipped& shipped) {
    const shader::ParamStore values = shipped.values();
    Programs programs;
    for (const Ids& ids : shipped.everything())
        programs.add(effect::select(shipped.registry, {}, {.only = ids}), values, "all", "picture",
                     {.shown = true, .natives = kNatives});
    return programs;
}

/// What a vertex is placed by must not be fused or reordered in one program and not in another:
/// walls meet the ground to the bit.
TEST(ReferenceCompiler, SeesThatVerticesOfTheGroundAndItsWallsAreInvariant) {
    constexpr std::uint32_t kInvariant = 18, kNoContraction = 42;  // of SPIR-V
    const Shipped shipped;
    const Programs programs = programs_of_everything(shipped);
    std::set<std::string> seen;
    for (const Programs::Program& program : programs.all()) {
        const std::string name = program.name.substr(0, program.name.find(' '));
        if (name != "geometry" && name != "geometry_outside" && name != "depth" && name != "side")
            continue;
        seen.insert(name);
        const ReferenceProgram compiled = reference_compile(program.vertex, program.fragment);
        EXPECT_EQ(count_decorations(compiled.vertex, kInvariant), 1) << name;
        // Products and sums of placed(), and of the matrix.
        EXPECT_GE(count_decorations(compiled.vertex, kNoContraction), 24) << name;
    }
    EXPECT_TRUE(seen.contains("geometry") && seen.contains("depth"));
}

TEST(ReferenceCompiler, TakesAComputeProgram) {
    EXPECT_NE(reference_compile_compute("#version 450 core\nvoid main() { discard; }\n").refused,
              "");
    const Shipped shipped;
    const Programs programs = programs_of_everything(shipped);
    int computes = 0;
    for (const Programs::Program& program : programs.all())
        if (!program.compute.empty()) {
            EXPECT_FALSE(program.compiled().compute.empty()) << program.name;
            ++computes;
        }
    const auto computes_by = [](const effect::Effect& effect) {
        return std::ranges::any_of(effect.manifest.passes, [](const shader::PluginPass& pass) {
            return pass.kind != shader::PluginPass::Kind::Full;
        });
    };
    // Any plugin may be deleted.
    EXPECT_EQ(computes > 0, std::ranges::any_of(shipped.registry.effects(), computes_by));
}

/// A discard costs a GPU the early depth test.
TEST(ReferenceCompiler, SeesADiscardInTheGeometryOfSoftwareDevicesAlone) {
    const Shipped shipped;
    const shader::ParamStore values = shipped.values();
    constexpr std::uint32_t kKill = 252;  // of SPIR-V
    for (const bool software : {false, true}) {
        Programs programs;
        for (const Ids& ids : shipped.everything())
            programs.add(effect::select(shipped.registry, {}, {.only = ids}), values, "all", "",
                         {.shown = true, .software = software});
        for (const Programs::Program& program : programs.all()) {
            if (!program.name.starts_with("geometry")) continue;
            const ReferenceProgram compiled = reference_compile(program.vertex, program.fragment);
            EXPECT_EQ(count_operations(compiled.fragment, kKill), software) << program.name;
        }
    }
}

}  // namespace
}  // namespace relevo::test::test_reference_compiler

// The examples of docs/library.md, built against what is installed alone.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "cli/program.h"
#include "support/support.h"

namespace relevo::test {
namespace {

namespace fs = std::filesystem;

class Installed : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        dir_ = scratch_dir("installed");
        const Result install = run(RELEVO_CMAKE, {"--install", build_dir().string(), "--prefix",
                                                  (dir_ / "first").string()});
        ASSERT_EQ(install.status, 0) << install.err;
        fs::rename(dir_ / "first", prefix());
        fs::copy(source_dir() / "examples/library", dir_ / "examples");
    }
    static void TearDownTestSuite() { fs::remove_all(prefix()); }  // 100 MB

    static fs::path prefix() { return dir_ / "moved"; }
    static std::string dem() { return (prefix() / "share/relevo/data/dem/jacksboro.tif").string(); }
    static std::string environment(const char* name, const fs::path& folder) {
        return std::string(name) + "=" + (prefix() / "lib" / folder).string();
    }

    static inline fs::path dir_;
};

TEST_F(Installed, ExamplesByCMake) {
    const fs::path build = dir_ / "build";
    const Result configured =
        run(RELEVO_CMAKE, {"-S", (dir_ / "examples").string(), "-B", build.string(),
                           "-DCMAKE_PREFIX_PATH=" + prefix().string()});
    ASSERT_EQ(configured.status, 0) << configured.out << configured.err;
    const Result built = run(RELEVO_CMAKE, {"--build", build.string()});
    ASSERT_EQ(built.status, 0) << built.out << built.err;
    const fs::path picture = dir_ / "picture.ppm";
    const Result drawn = run(build / "picture", {dem(), "2026-06-21T20:00Z", picture.string()});
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(drawn.err, "");
    EXPECT_EQ(fs::file_size(picture), 640U * 400 * 3 + 15);
    const Result hours = run(build / "sun_hours", {dem(), "2026-06-21"});
    EXPECT_EQ(hours.status, 0) << hours.err;
    EXPECT_EQ(hours.out, "13.16 h\n");  // relevo sun hours: mean 13.16
    const Result bad = run(build / "sun_hours", {"/nowhere.tif", "2026-06-21"});
    EXPECT_EQ(bad.status, 1);
    EXPECT_EQ(bad.err, "/nowhere.tif: no such file\n");
}

TEST_F(Installed, ByPkgConfig) {
    const fs::path program = dir_ / "hours_by_pkg_config";
    const std::string command =
        "c++ -std=c++17 " + (dir_ / "examples/sun_hours.cpp").string() + " -o " + program.string() +
        " $(pkg-config --cflags --libs relevo) && pkg-config --cflags relevo-plugin";
    const Result built =
        run("/bin/sh", {"-c", command}, {environment("PKG_CONFIG_PATH", "pkgconfig")});
    ASSERT_EQ(built.status, 0) << built.err;
    EXPECT_NE(built.out.find("-I" + prefix().string()), std::string::npos) << built.out;
    const Result hours = run(program, {dem(), "2026-06-21"}, {environment("LD_LIBRARY_PATH", "")});
    EXPECT_EQ(hours.out, "13.16 h\n") << hours.err;
}

TEST_F(Installed, ThePythonPackage) {
    const fs::path packages = prefix() / RELEVO_PYTHON_DIR;
    const std::string script =
        "import importlib.metadata, relevo, sys, warnings\n"
        "warnings.simplefilter('ignore')\n"
        "dem = relevo.open(sys.argv[1])\n"
        "print(relevo.__file__, importlib.metadata.version('relevo') == relevo.__version__)\n"
        "print(round(float(dem.sun.hours('2026-06-21').values.mean()), 2))\n"
        "print(dem.capture(size=(64, 48), device='software').shape)\n"
        "print([line.split()[-1] for line in open('/proc/self/maps') if 'librelevo.so' in "
        "line][0])\n";
    const Result ran = run(RELEVO_PYTHON_PROGRAM, {"-B", "-c", script, dem()},
                           {"PYTHONPATH=" + packages.string()});
    // Its library is the one that is installed with it.
    const fs::path library = fs::canonical(prefix() / "lib/librelevo.so.0");
    EXPECT_EQ(ran.out, (packages / "relevo/__init__.py").string() + " True\n13.16\n(48, 64, 4)\n" +
                           library.string() + "\n")
        << ran.err;
}

TEST_F(Installed, APluginByCMake) {
    const fs::path sources = dir_ / "plugin";
    fs::create_directories(sources);
    std::ofstream(sources / "CMakeLists.txt")
        << "cmake_minimum_required(VERSION 3.16)\nproject(quiet C)\nfind_package(Relevo REQUIRED)\n"
           "add_library(quiet MODULE quiet.c)\ntarget_link_libraries(quiet PRIVATE "
           "Relevo::plugin)\n";
    std::ofstream(sources / "quiet.c")
        << "#include <relevo/plugin.h>\n"
           "RELEVO_PLUGIN_EXPORT const uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;\n"
           "relevo_status relevo_plugin_register(const relevo_host* host, relevo_module* module) "
           "{\n"
           "    (void)host;\n    module->id = \"quiet\";\n    return RELEVO_OK;\n}\n";
    const fs::path build = dir_ / "plugin_build";
    const Result configured = run(RELEVO_CMAKE, {"-S", sources.string(), "-B", build.string(),
                                                 "-DCMAKE_PREFIX_PATH=" + prefix().string()});
    ASSERT_EQ(configured.status, 0) << configured.out << configured.err;
    const Result built = run(RELEVO_CMAKE, {"--build", build.string()});
    EXPECT_EQ(built.status, 0) << built.out << built.err;
}

}  // namespace
}  // namespace relevo::test

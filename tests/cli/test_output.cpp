#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include <fcntl.h>
#include <gdal.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_output {
namespace {

using namespace std::chrono_literals;

const std::string kProgram = (build_dir() / "bin/relevo").string();
const std::vector<std::string> kWithoutCache{"MESA_SHADER_CACHE_DISABLE=true"};

/// A line of the shell; $0 is the program.
Result shell(const std::string& line, const std::vector<std::string>& arguments = {},
             const std::vector<std::string>& environment = {}) {
    std::vector<std::string> words{"-c", line, kProgram};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run("/bin/sh", words, environment);
}

std::vector<std::string> shim(const std::string& what) {
    return {std::string("LD_PRELOAD=") + RELEVO_TEST_SHIM, "RELEVO_SHIM=" + what,
            "ASAN_OPTIONS=verify_asan_link_order=0:alloc_dealloc_mismatch=0"};
}

/// A virtual raster that shows another.
void virtual_copy(const std::string& source, const std::string& vrt) {
    GDALAllRegister();
    const GDALDatasetH from = GDALOpen(source.c_str(), GA_ReadOnly);
    GDALClose(GDALCreateCopy(GDALGetDriverByName("VRT"), vrt.c_str(), from, FALSE, nullptr, nullptr,
                             nullptr));
    GDALClose(from);
}

class Output : public testing::Test {
  protected:
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(dir_))
            found.push_back(entry.path().filename().string());
        std::sort(found.begin(), found.end());
        return found;
    }
    std::string path(const std::string& name) const { return (dir_ / name).string(); }

    /// The quickest picture there is.
    static std::vector<std::string> capture(const std::string& output) {
        return {"-q", "capture", bundled_dem(), "-o", output, "--size", "64x48", "--only", ""};
    }

    /// The program, started and not waited for, with nothing on its standard streams.
    static pid_t start(const std::vector<std::string>& arguments,
                       const std::vector<std::string>& environment = {}) {
        const pid_t child = fork();
        if (child != 0) return child;
        for (const std::string& variable : environment)
            putenv(const_cast<char*>(variable.c_str()));
        const int null = open("/dev/null", O_RDWR);
        dup2(null, STDOUT_FILENO);
        dup2(null, STDERR_FILENO);
        std::vector<char*> words{const_cast<char*>(kProgram.c_str())};
        for (const std::string& argument : arguments)
            words.push_back(const_cast<char*>(argument.c_str()));
        words.push_back(nullptr);
        execv(words[0], words.data());
        _exit(127);
    }
    static int status_of(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return status;
    }

    std::filesystem::path dir_ = scratch_dir("cli_output");
};

TEST_F(Output, OnAFullDiskIsAnErrorInEveryFormat) {
    for (const char* ending : {"png", "jpg", "webp", "tif", "exr"}) {
        const std::string output = path(std::string("a.") + ending);
        std::vector<std::string> arguments = capture(output);
        arguments[6] = "320x256";
        const Result run = shell("ulimit -f 2; exec \"$0\" \"$@\"", arguments, kWithoutCache);
        EXPECT_EQ(run.status, 1) << ending;
        EXPECT_EQ(run.err,
                  "relevo: error: image: " + output + ": cannot be written, File too large\n");
    }
    for (const char* ending : {"svg", "png", "csv", "json"}) {
        const std::string output = path(std::string("a.") + ending);
        const Result run = shell(
            "ulimit -f 2; exec \"$0\" \"$@\"",
            {"sun", "day", "--at", "46.9,7.4", "--year", "2026", "--tz", "UTC", "-o", output});
        EXPECT_EQ(run.status, 1) << ending;
        EXPECT_EQ(run.err,
                  "relevo: error: -o: " + output + ": cannot be written, File too large\n");
    }
    EXPECT_TRUE(names().empty()) << names().front();
}

TEST_F(Output, AnEncoderThatEndsTheProcessIsAnError) {
    for (const char* refused : {"jpeg", "jpeg,unnamed"}) {
        const Result run = relevo(capture(path("a.jpg")), shim(refused));
        EXPECT_EQ(run.status, 1);
        EXPECT_EQ(run.err, "relevo: error: image: " + path("a.jpg") +
                               ": the encoder gave up, most likely for want of memory; use a "
                               "smaller --size, or name a .png\n");
        EXPECT_TRUE(names().empty());
    }
}

TEST_F(Output, AFormatWithoutRoomForTheSizeIsRefused) {
    std::vector<std::string> arguments = capture(path("a.webp"));
    arguments[6] = "16384x48";
    expect_failure(arguments, 3,
                   "image: " + path("a.webp") +
                       ": webp has sides of at most 16383 px, but this picture is 16384x48; name "
                       "another format");
}

TEST_F(Output, WithoutTheModuleOfFormatsOnlyPngIsWritten) {
    std::filesystem::create_directories(dir_ / "bin");
    std::error_code error;
    std::filesystem::create_hard_link(kProgram, dir_ / "bin/relevo", error);
    ASSERT_FALSE(error) << error.message();
    std::filesystem::create_directories(dir_ / "lib/relevo");
    std::filesystem::create_symlink(build_dir() / "lib/relevo/gdal.so",
                                    dir_ / "lib/relevo/gdal.so");
    const std::vector<std::string> share{"RELEVO_SHARE=" + (build_dir() / "share/relevo").string()};
    const std::string module = path("lib/relevo/image_formats.so");
    const Result jpg = run(dir_ / "bin/relevo", capture(path("a.jpg")), share);
    EXPECT_EQ(jpg.status, 1);
    EXPECT_EQ(jpg.err, "relevo: error: image: " + path("a.jpg") +
                           ": the module for pictures other than PNG cannot be loaded, " + module +
                           ": cannot open shared object file: No such file or directory; this "
                           "package has none: name a .png\n");
    const Result doctor = run(dir_ / "bin/relevo", {"doctor"}, share);
    EXPECT_NE(doctor.out.find("\npictures   png alone, " + module + ": cannot open"),
              std::string::npos)
        << doctor.out;
    EXPECT_EQ(run(dir_ / "bin/relevo", capture(path("a.png")), share).status, 0);
    EXPECT_EQ(names(), (std::vector<std::string>{"a.png", "bin", "lib"}));
}

TEST_F(Output, StandardOutputThatIsLostIsAnErrorOfEveryVerb) {
    const std::string dem = bundled_dem(), at = "36.3,-84.2";
    const std::vector<std::vector<std::string>> verbs{
        {"--help"},
        {"--help-all"},
        {"--version"},
        {"sun", "day", "--help"},
        {"info", dem},
        {"info", dem, "--json"},
        {"plugins"},
        {"plugins", "--json"},
        {"sun", "position", "--at", at, "--time", "2026-06-21T12:00Z"},
        {"sun", "position", "--at", at, "--time", "2026-06-21T12:00Z", "--json"},
        {"sun", "day", "--at", at, "--year", "2026", "--tz", "UTC", "--json"},
        {"sun", "day", "--at", at, "--date", "2026-06-21", "--tz", "UTC", "--csv"}};
    for (const std::vector<std::string>& verb : verbs) {
        const Result full = shell("exec \"$0\" -q \"$@\" >/dev/full", verb);
        EXPECT_EQ(full.status, 1) << verb.front();
        EXPECT_EQ(full.err,
                  "relevo: error: standard output: cannot be written, No space left on device\n");
        const Result closed = shell("exec \"$0\" -q \"$@\" >&-", verb);
        EXPECT_EQ(closed.status, 1) << verb.front();
        EXPECT_EQ(closed.err,
                  "relevo: error: standard output: cannot be written, Bad file descriptor\n");
    }
    const Result doctor = shell("exec \"$0\" doctor >/dev/full");
    EXPECT_EQ(doctor.status, 1);
}

TEST_F(Output, GoesToItsFileWhenTheStandardStreamsAreClosed) {
    const std::string csv = path("a.csv");
    EXPECT_EQ(
        shell("exec \"$0\" \"$@\" <&- >&- 2>&-", {"sun", "day", "--at", "1,1", "--date",
                                                  "2026-06-21", "--tz", "UTC", "-o", csv, "--json"})
            .status,
        1);
    EXPECT_TRUE(read_text(csv, "test").starts_with("# ")) << read_text(csv, "test");
    EXPECT_EQ(shell("exec \"$0\" \"$@\" <&- >&- 2>&-", capture(path("a.png"))).status, 0);
    EXPECT_EQ(image::read(path("a.png")).width, 64);
}

TEST_F(Output, ToAPipeThatNobodyReadsEndsQuietly) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    close(ends[0]);
    const std::string redirected = ">&" + std::to_string(ends[1]);
    const Result run = shell("\"$0\" --help-all " + redirected + "; echo $?");
    EXPECT_EQ(run.out, std::to_string(128 + SIGPIPE) + "\n");
    EXPECT_EQ(run.err, "");
    const Result ignored = shell("trap '' PIPE; exec \"$0\" --help-all " + redirected);
    close(ends[1]);
    EXPECT_EQ(ignored.status, 1);
    EXPECT_EQ(ignored.err, "relevo: error: standard output: cannot be written, Broken pipe\n");
}

TEST_F(Output, IsNeverTheDemOrWhatBelongsToIt) {
    const std::string dem = path("dem.tif"), link = path("link.tif"), vrt = path("all.vrt");
    std::filesystem::copy_file(bundled_dem(), dem);
    std::filesystem::create_symlink("dem.tif", link);
    std::ofstream(path("dem.tif.aux.xml")) << "<PAMDataset></PAMDataset>";
    virtual_copy(dem, vrt);
    virtual_copy(vrt, path("outer.vrt"));
    const std::string before = read_text(dem, "test");
    struct Case {
        std::string input, option, output, what;
    };
    const std::string lost = ", which would be overwritten; give the result another name";
    const std::string of_dem = "is a file that the DEM is read from, ";
    for (const Case& c :
         {Case{dem, "-o", dem, "is the DEM " + dem}, Case{dem, "-o", link, "is the DEM " + dem},
          Case{link, "-o", dem, "is the DEM " + link},
          Case{dem, "--timings", dem, "is the DEM " + dem},
          Case{dem, "--timings", path("dem.tif.aux.xml"), of_dem + path("dem.tif.aux.xml")},
          Case{vrt, "-o", dem, of_dem + dem}, Case{path("outer.vrt"), "-o", dem, of_dem + dem}}) {
        std::vector<std::string> arguments{"-q",          "capture", c.input,
                                           "--overwrite", c.option,  c.output};
        if (c.option != "-o") arguments.insert(arguments.end(), {"-o", path("a.png")});
        expect_failure(
            arguments, 3,
            (c.option == "-o" ? "image: " : c.option + ": ") + c.output + ": " + c.what + lost);
    }
    const std::string csv = path("dem.csv");
    std::filesystem::copy_file(dem, csv);
    for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
             {"sun", "day", "--date", "2026-06-21", "--tz", "UTC"},
             {"sun", "horizon"},
             {"sun", "carpet", "--year", "2026", "--tz", "UTC"},
             {"sun", "when", "--over", "36.3,-84.2", "--year", "2026", "--tz", "UTC"}}) {
        std::vector<std::string> arguments = verb;
        arguments.insert(arguments.end(), {csv, "--at", "36.3,-84.2", "-o", csv, "--overwrite"});
        expect_failure(arguments, 3, "-o: " + csv + ": is the DEM " + csv + lost);
    }
    EXPECT_EQ(read_text(dem, "test"), before);
    EXPECT_EQ(read_text(csv, "test"), before);
    EXPECT_EQ(read_text(path("dem.tif.aux.xml"), "test"), "<PAMDataset></PAMDataset>");
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

TEST_F(Output, IsNeverAPresetOrAPluginsFile) {
    const std::filesystem::path folder = dir_ / "tide";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.json")
        << R"({"format": 1, "id": "tide", "name": "Tide", "version": "1"})";
    std::ofstream(folder / "tide.glsl") << "void tide_on_albedo(inout Surface s) {}\n";
    std::ofstream(dir_ / "my.json") << R"({"only": []})";
    struct Case {
        std::filesystem::path file;
        std::string what;
    };
    for (const Case& c : {Case{dir_ / "my.json", "is the preset "},
                          Case{folder / "plugin.json", "is a file of the plugin tide, "},
                          Case{folder / "tide.glsl", "is a file of the plugin tide, "}}) {
        const std::string before = read_text(c.file, "test");
        expect_failure(
            {"-q", "capture", bundled_dem(), "-o", path("a.png"), "--overwrite", "--plugin-path",
             folder.string(), "--preset", path("my.json"), "--timings", c.file.string()},
            3,
            "--timings: " + c.file.string() + ": " + c.what + c.file.string() +
                ", which would be overwritten; give the result another name");
        EXPECT_EQ(read_text(c.file, "test"), before);
    }
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

TEST_F(Output, TimingsAreAnOutputLikeAnyOther) {
    std::vector<std::string> arguments = capture(path("a.png"));
    arguments.insert(arguments.end(), {"--timings", path("t.json")});
    std::ofstream(path("t.json")) << "precious";
    expect_failure(arguments, 3,
                   "--timings: " + path("t.json") + ": exists; pass --overwrite to replace it");
    EXPECT_EQ(read_text(path("t.json"), "test"), "precious");
    EXPECT_EQ(names(), std::vector<std::string>{"t.json"});
    arguments.back() = path("none/t.json");
    expect_failure(arguments, 3,
                   "--timings: " + path("none/t.json") + ": the folder " + path("none") +
                       " does not exist; create it first");
    arguments.back() = path("./a.png");
    expect_failure(
        arguments, 2,
        "--timings: " + path("./a.png") + ": another result has this name; give each its own file");
    arguments.back() = "/dev/stdout";
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(nlohmann::json::parse(run.out)["stages_ms"].contains("load"));
    EXPECT_EQ(names(), (std::vector<std::string>{"a.png", "t.json"}));
}

TEST_F(Output, OfOneRunIsThereTogetherOrNotAtAll) {
    const auto arguments = [&](const std::string& scene, const std::string& timings) {
        std::vector<std::string> all = capture(path("a.png"));
        all.insert(all.end(), {"--save-scene", scene, "--timings", timings});
        return all;
    };
    const std::string full = ": /dev/full: cannot be written, No space left on device";
    expect_failure(arguments("/dev/full", path("t.json")), 1, "--save-scene" + full);
    EXPECT_TRUE(names().empty()) << names().front();
    expect_failure(arguments(path("s.json"), "/dev/full"), 1, "--timings" + full);
    EXPECT_TRUE(names().empty()) << names().front();
    EXPECT_EQ(relevo(arguments(path("s.json"), path("t.json"))).status, 0);
    EXPECT_EQ(names(), (std::vector<std::string>{"a.png", "s.json", "t.json"}));
}

TEST_F(Output, DumpedShadersReplaceNothingUnasked) {
    std::vector<std::string> arguments = capture(path("a.png"));
    arguments.insert(arguments.end(), {"--dump-shaders", path("s")});
    std::filesystem::create_directory(dir_ / "s");
    std::ofstream(path("s/terrain.frag.glsl")) << "mine";
    const Result run = relevo(arguments);
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.err, "relevo: error: --dump-shaders: " + path("s/terrain.frag.glsl") +
                           ": exists; pass --overwrite to replace it\n");
    EXPECT_EQ(read_text(path("s/terrain.frag.glsl"), "test"), "mine");
    arguments.emplace_back("--overwrite");
    EXPECT_EQ(relevo(arguments).status, 0);
    EXPECT_TRUE(read_text(path("s/terrain.frag.glsl"), "test").starts_with("#version"));
    const std::string own = (build_dir() / "share/relevo/shaders").string();
    arguments[arguments.size() - 2] = own;
    const std::string before = read_text(own + "/terrain.frag.glsl", "test");
    const Result refused = relevo(arguments);
    EXPECT_EQ(refused.err, "relevo: error: --dump-shaders: " + own +
                               ": is Relevo's own shader folder; name another one\n");
    EXPECT_EQ(read_text(own + "/terrain.frag.glsl", "test"), before);
}

TEST_F(Output, OfTwoAtOnceOneIsThereAndWhole) {
    const pid_t first = start(capture(path("a.png"))), second = start(capture(path("a.png")));
    const int one = WEXITSTATUS(status_of(first)), other = WEXITSTATUS(status_of(second));
    EXPECT_EQ(std::min(one, other), 0);
    EXPECT_TRUE(std::max(one, other) == 1 || std::max(one, other) == 3) << one << " " << other;
    const image::Image8 picture = image::read(path("a.png"));
    std::vector<std::string> replacing = capture(path("a.png"));
    replacing.emplace_back("--overwrite");
    const pid_t third = start(replacing), fourth = start(replacing);
    EXPECT_EQ(status_of(third), 0);
    EXPECT_EQ(status_of(fourth), 0);
    EXPECT_EQ(image::read(path("a.png")).values, picture.values);
    EXPECT_EQ(names(), std::vector<std::string>{"a.png"});
}

TEST_F(Output, OfAProgramThatASignalEndsIsNotThere) {
    const std::filesystem::path fifo = scratch_dir("cli_output_fifo") / "scene";
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    for (const std::string& refused : {std::string("nothing"), std::string("unnamed")}) {
        std::chrono::milliseconds lives = 0ms;
        for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
            // Only one who is killed without a word leaves what has a name.
            if (number == SIGKILL && refused == "unnamed") continue;
            std::vector<std::string> arguments = capture(path("a.png"));
            // Long enough that it does not end before it is ended.
            arguments.insert(arguments.end(), {"--timings", path("t.json"), "--repeat", "100000",
                                               "--save-scene", fifo.string()});
            const pid_t child = start(arguments, shim(refused));
            // It opens when the program opens it, which is after the others.
            const int scene = open(fifo.c_str(), O_RDONLY | O_CLOEXEC);
            EXPECT_EQ(names().size(), refused == "unnamed" ? 2U : 0U);
            std::this_thread::sleep_for(lives += 100ms);
            kill(child, number);
            const int status = status_of(child);
            EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == number) << number;
            close(scene);
            EXPECT_TRUE(names().empty()) << names().front();
        }
    }
}

TEST_F(Output, OfAProgramThatIsKilledAtAnyMomentIsWholeOrNotThere) {
    for (int i = 0; i < 8; ++i) {
        const pid_t child = start(capture(path("a.png")));
        std::this_thread::sleep_for(100ms * i);
        kill(child, SIGKILL);
        status_of(child);
        if (!names().empty()) {
            EXPECT_EQ(names(), std::vector<std::string>{"a.png"});
            EXPECT_EQ(image::read(path("a.png")).width, 64);
        }
        std::filesystem::remove(path("a.png"));
    }
}

TEST_F(Output, NamesThatAreNoTextBreakNeitherJsonNorMessages) {
    const std::string odd = path("a\xff\x1b\nb.tif");
    std::filesystem::copy_file(bundled_dem(), odd);
    const Result info = relevo({"info", odd, "--json"});
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_EQ(nlohmann::json::parse(info.out)["path"], path("a\xef\xbf\xbd\x1b\nb.tif"));
    const std::string forged = path("none\nrelevo: error: /etc/passwd: all is well");
    expect_failure({"info", forged}, 3,
                   path("none\\nrelevo: error: /etc/passwd: all is well") +
                       ": no such file; there is no folder " + path("none\\nrelevo: error: /etc"));
    expect_failure({"capture", bundled_dem(), "-o", path("a\x1b[2J\nrelevo: done.gif")}, 3,
                   "image: " + path("a\\x1b[2J\\nrelevo: done.gif") +
                       ": unknown picture format; use png, jpg, webp, avif, tif or exr");
}

TEST_F(Output, WithoutMemoryIsAnErrorThatSaysSo) {
    const Result picture = relevo(capture(path("a.png")), shim("memory"));
    EXPECT_EQ(picture.status, 1);
    EXPECT_EQ(
        picture.err,
        "relevo: error: capture: --size 64x48: not enough memory for the picture and the DEM; "
        "use a smaller --size or --memory\n");
    EXPECT_TRUE(names().empty());
    const Result info = relevo({"info", bundled_dem()}, shim("memory"));
    EXPECT_EQ(info.status, 1);
    EXPECT_EQ(info.err,
              "relevo: error: out of memory; use a smaller --size, a smaller --memory, or fewer "
              "DEMs, or raise ulimit -v\n");
}

TEST_F(Output, WithoutAWorkingFolderIsAnErrorThatSaysSo) {
    std::filesystem::create_directory(dir_ / "gone");
    const Result run =
        shell("cd " + path("gone") + " && rmdir " + path("gone") + " && exec \"$0\" -q \"$@\"",
              capture("a.png"));
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, testing::StartsWith(
                             "relevo: error: image: a.png: the folder . cannot be written to, "));
}

}  // namespace
}  // namespace relevo::test::test_output

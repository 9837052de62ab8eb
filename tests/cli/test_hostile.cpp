// What lies in folders that others write to, and limits of the system: nothing waits for ever, and
// nothing ends without a word.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gdal.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "cli/program.h"
#include "dem/fixture.h"
#include "support/support.h"

namespace relevo::test::test_hostile {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A run that is ended where it waits for ever; status 124 then.
Result in_time(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"30", (build_dir() / "bin/relevo").string()});
    return run("/usr/bin/timeout", arguments);
}

class Pipes : public testing::Test {
  protected:
    Pipes() {
        Raster raster;
        raster.columns = raster.rows = 40;
        dem_ = write_raster(dir_ / "a.tif", raster);
    }
    std::string pipe(const std::string& name) const {
        const std::string path = (dir_ / name).string();
        EXPECT_EQ(mkfifo(path.c_str(), 0600), 0) << path;
        return path;
    }
    std::vector<std::string> capture(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{
            "-q",       "capture", dem_,    "-o",     out("out.png"),     "--device",
            "software", "--size",  "64x48", "--time", "2026-06-21T12:00Z"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    std::string out(const char* name) const { return (dir_ / name).string(); }

    fs::path dir_ = scratch_dir("pipes");
    std::string dem_;
};

TEST_F(Pipes, BesideADemAreNotRead) {
    std::string warnings;
    for (const char* ending : {".tif.aux.xml", ".tif.ovr", ".tif.msk", "_rpc.txt", "_RPC.TXT",
                               ".tfw", ".tab", ".prj", ".IMD", ".aux"})
        pipe(std::string("a") + ending);
    const Result info = in_time({"info", dem_});
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_THAT(info.err, HasSubstr(fmt::format("relevo: warning: {}.aux.xml: a pipe or "
                                                "a device, expected a file; not read\n",
                                                dem_)));
    EXPECT_EQ(in_time(capture({})).status, 0);
    EXPECT_TRUE(fs::exists(out("out.png")));
}

TEST_F(Pipes, InsideOfAVirtualRasterAreRefused) {
    pipe("b.tif.ovr");
    Raster raster;
    raster.columns = raster.rows = 40;
    write_raster(dir_ / "b.tif", raster);
    std::ofstream(dir_ / "b.vrt")
        << "<VRTDataset rasterXSize=\"40\" rasterYSize=\"40\"><SRS>EPSG:32632</SRS><GeoTransform>"
           "500000,30,0,5200000,0,-30</GeoTransform><VRTRasterBand dataType=\"Float32\" "
           "band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"1\">b.tif</SourceFilename>"
           "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    EXPECT_EQ(in_time({"info", out("b.vrt")}).status, 0);
    // A name that is itself the text of one.
    const std::string fifo = pipe("c.tif");
    const Result inline_text = in_time(
        {"info",
         "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><SRS>EPSG:32632</SRS><VRTRasterBand "
         "dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename>" +
             fifo + "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>"});
    EXPECT_EQ(inline_text.status, 3) << inline_text.err;
}

TEST_F(Pipes, AsGridsOfACrsAreNotRead) {
    const std::string grid = pipe("grid.gsb");
    const Result run = in_time({"info", dem_, "--crs", "+proj=utm +zone=32 +nadgrids=" + grid});
    EXPECT_NE(run.status, 124);
    EXPECT_NE(run.err + run.out, "");
}

TEST_F(Pipes, AsASidecarAreRefused) {
    const std::string sidecar = pipe("out.png.json");
    const Result run = in_time(capture({"--sidecar"}));
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.err, fmt::format("relevo: error: --sidecar: {}: is not a regular file; remove "
                                   "it, or give the picture another name\n",
                                   sidecar));
    EXPECT_FALSE(fs::exists(out("out.png")));
    std::ofstream(dir_ / "job.json")
        << R"({"format": 1, "dem": {"files": ["a.tif"]}, "time": {"at": "2026-06-21T12:00Z"},
               "picture": {"size": [64, 48]}, "output": "out.png"})";
    const auto job = [&](const char* option) {
        return in_time({"-q", "run", "--device", "software", out("job.json"), "--sidecar", option});
    };
    const Result replaced = job("--overwrite");
    EXPECT_EQ(replaced.status, 5) << replaced.err;
    EXPECT_THAT(replaced.err, HasSubstr(sidecar + ": is not a regular file"));
    const Result resumed = job("--resume");
    EXPECT_EQ(resumed.status, 3) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr(out("out.png") + ": its sidecar is not a file"));
}

TEST(Names, OfBandsHaveNoControlCharacters) {
    const fs::path dir = scratch_dir("names");
    Raster raster;
    raster.columns = raster.rows = 40;
    const std::string dem = write_raster(dir / "a.tif", raster);
    std::ofstream(dir / "times.csv") << "time,name\n2026-06-21T12:00Z,\"red\x1b[31m\"\n";
    const std::string mask = (dir / "mask.tif").string();
    const Result run =
        relevo({"-q", "sun", "shadow", dem, "--times", (dir / "times.csv").string(), "-o", mask});
    ASSERT_EQ(run.status, 0) << run.err;
    GDALAllRegister();
    const GDALDatasetH dataset = GDALOpen(mask.c_str(), GA_ReadOnly);
    EXPECT_THAT(GDALGetDescription(GDALGetRasterBand(dataset, 1)), HasSubstr("red\\x1b[31m"));
    GDALClose(dataset);
}

TEST_F(Pipes, GdalsReasonIsGivenWhereItRefusesAnOption) {
    const Result run =
        relevo({"-q", "sun", "sky-view", dem_, "-o", out("view.tif"), "--co", "BIGTIFF=MAGIC"});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr("--co: GDAL's COG driver says: 'MAGIC' is an unexpected value "
                                   "for BIGTIFF"));
}

/// A run under a limit of the shell's, "-v 600000".
Result limited(const std::string& limit, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"-c", "ulimit " + limit + " && exec \"$0\" \"$@\"",
                                         (build_dir() / "bin/relevo").string()});
    return run("/bin/bash", arguments);
}

TEST_F(Pipes, ASmallStackIsEnough) {
    // In KiB. Below 24 the loader already fails, which only maps the libraries.
    const Result run = limited("-s 32", capture({}));
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(fs::exists(out("out.png")));
}

TEST_F(Pipes, ADriverThatLacksMemoryEndsWithAMessage) {
    const Result run = limited("-v 550000", capture({}));
    // Where the memory ends first, is by chance: as soon as the driver is loaded, or later.
    EXPECT_THAT(run.status, testing::AnyOf(1, 4)) << run.err;
    EXPECT_THAT(run.err, HasSubstr("relevo: error: "));
    EXPECT_FALSE(fs::exists(out("out.png")));
}

}  // namespace
}  // namespace relevo::test::test_hostile

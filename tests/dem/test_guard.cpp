#include <chrono>
#include <cstdlib>
#include <fstream>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/allowed_name.h"
#include "dem/fixture.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/load.h"
#include "dem/remote.h"
#include "support/support.h"

// What a file from others must not make the program do.

namespace relevo::dem::test_guard {
namespace {

using test::Raster;
using test::write_raster;

using test::folder;

/// The message without its beginning, "exit 3: PATH: ", which is checked.
std::string refusal(const std::string& path, const LoadOptions& options = {}) {
    const std::string message = test::error_of([&] { load(path, options); });
    const std::string begin = "exit 3: " + path + ": ";
    return message.starts_with(begin) ? message.substr(begin.size()) : "!" + message;
}

/// A virtual raster of 6 x 4 posts with something in its band.
std::string vrt(const char* name, const std::string& band, const char* band_attributes = "") {
    const std::filesystem::path path = folder() / name;
    std::ofstream(path) << "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><SRS>EPSG:32632</SRS>"
                           "<GeoTransform>500000,30,0,5200000,0,-30</GeoTransform>"
                           "<VRTRasterBand dataType=\"Float32\" band=\"1\" "
                        << band_attributes << ">" << band << "</VRTRasterBand></VRTDataset>";
    return path;
}

std::string source_of(const std::string& name, const std::string& more = "") {
    return "<SimpleSource><SourceFilename relativeToVRT=\"0\">" + name + "</SourceFilename>" +
           more + "<SourceBand>1</SourceBand></SimpleSource>";
}

std::string memory_at(const void* address) {
    return fmt::format("MEM:::DATAPOINTER={},PIXELS=6,LINES=4,DATATYPE=Float32", address);
}

TEST(Guard, NoFileReadsTheProgramsMemory) {
    const std::vector<float> secret(24, 4711.0f);
    const std::string name = memory_at(secret.data());
    EXPECT_THAT(refusal(name), testing::HasSubstr("is not a file of this machine"));
    allow_name(name);  // as one of the command line
    EXPECT_EQ(refusal(name), "names the program's own memory, expected a file");
    const std::string what =
        "a virtual raster of the program's own memory ('" + name + "'), expected files";
    EXPECT_EQ(refusal(vrt("memory.vrt", source_of(name))), what);
    // By way of another one, of one in an archive, and of one written into the first.
    EXPECT_EQ(refusal(vrt("nested.vrt", source_of((folder() / "memory.vrt").string()))), what);
    ASSERT_EQ(
        std::system(
            ("cd " + folder().string() + " && python3 -m zipfile -c m.zip memory.vrt").c_str()),
        0);
    EXPECT_EQ(test::error_of([&] { load((folder() / "m.zip").string()); }),
              "exit 3: /vsizip/" + (folder() / "m.zip/memory.vrt").string() + ": " + what);
    std::string inner;
    for (const char c :
         "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><VRTRasterBand "
         "dataType=\"Float32\" band=\"1\">" +
             source_of(name) + "</VRTRasterBand></VRTDataset>")
        inner += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
    EXPECT_EQ(refusal(vrt("inline.vrt", source_of(inner))), what);
    // And whatever way was not thought of here: GDAL itself opens none.
    prepare_gdal();
    const GdalMessages messages;
    EXPECT_EQ(GDALOpen(name.c_str(), GA_ReadOnly), nullptr);
}

TEST(Guard, NoFileRunsCode) {
    EXPECT_EQ(refusal(vrt("python.vrt",
                          "<PixelFunctionType>f</PixelFunctionType>"
                          "<PixelFunctionLanguage>Python</PixelFunctionLanguage>"
                          "<PixelFunctionCode>def f(a, o, *r, **k): pass</PixelFunctionCode>" +
                              source_of(write_raster(folder() / "tile.tif", {})),
                          "subClass=\"VRTDerivedRasterBand\"")),
              "a virtual raster with Python code, which is not run");
    EXPECT_STREQ(CPLGetConfigOption("GDAL_VRT_ENABLE_PYTHON", ""), "NO");

    Raster tiles;
    tiles.driver = "GPKG";
    tiles.type = "Byte";
    tiles.columns = tiles.rows = 256;
    const std::string package = write_raster(folder() / "tiles.gpkg", tiles);
    const std::string made = (folder() / "made.db").string();
    const std::string statement = "ATTACH DATABASE '" + made + "' AS x; CREATE TABLE x.t(a)";
    EXPECT_EQ(refusal(vrt("sql.vrt", source_of(package,
                                               "<OpenOptions><OOI key=\"PRELUDE_"
                                               "STATEMENTS\">" +
                                                   statement + "</OOI></OpenOptions>"))),
              "a virtual raster with SQL statements, which are not run");
    CPLStringList options;
    options.SetNameValue("PRELUDE_STATEMENTS", statement.c_str());
    const GdalMessages messages;
    EXPECT_EQ(GDALOpenEx(package.c_str(), GDAL_OF_RASTER, nullptr, options.List(), nullptr),
              nullptr);
    EXPECT_FALSE(std::filesystem::exists(made));
}

/// A description of what is on the net.
std::filesystem::path service() {
    const std::filesystem::path file = folder() / "service.xml";
    std::ofstream(file)
        << "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://127.0.0.1:9/${z}/${x}/${y}.png"
           "</ServerUrl></Service><DataWindow><UpperLeftX>-20037508.34</UpperLeftX><UpperLeftY>"
           "20037508.34</UpperLeftY><LowerRightX>20037508.34</LowerRightX><LowerRightY>-20037508.34"
           "</LowerRightY><TileLevel>3</TileLevel></DataWindow><BandsCount>3</BandsCount>"
           "</GDAL_WMS>";
    return file;
}
constexpr const char* kService =
    "a description (WMS) of what is on the net, which is asked only by a name on the command line; "
    "make a file of it with gdal_translate";

TEST(Guard, NoFileGoesToTheNet) {
    for (const char* name :
         {"http://127.0.0.1:9/a.tif", "/vsicurl/http://127.0.0.1:9/a.tif", "/vsis3/bucket/a.tif",
          "/vsizip//vsicurl/http://127.0.0.1:9/a.zip/a.tif", "/vsistdin/",
          "NETCDF:\"http://127.0.0.1:9/a.nc\":z", "WMTS:http://127.0.0.1:9/", "PG:host=127.0.0.1",
          "vrt://http://127.0.0.1:9/a.tif?bands=1"}) {
        EXPECT_EQ(refusal(vrt("net.vrt", source_of(name))),
                  fmt::format("a virtual raster of '{}', expected files of this machine; the net "
                              "is asked only by a name on the command line",
                              name));
        EXPECT_TRUE(is_remote(name));
    }
    for (const char* name : {"alps.tif", "/vsizip/a.zip/b.tif", "NETCDF:a.nc:z", "/data/vsix/a.tif",
                             "vrt://a.tif?bands=1", "/vsitar/{/x/a.tar}/b.tif"})
        EXPECT_FALSE(is_remote(name)) << name;
    EXPECT_EQ(refusal(service()), kService);
    const GdalMessages messages;
    EXPECT_EQ(VSIFOpenL("/vsicurl/http://127.0.0.1:9/a.tif", "rb"), nullptr);
}

TEST(Guard, VirtualRastersOfThemselvesEnd) {
    const std::string self = (folder() / "self.vrt").string();
    EXPECT_EQ(refusal(vrt("self.vrt", source_of(self))),
              "a virtual raster that is made of itself, by way of '" + self + "'");
    const std::string one = (folder() / "one.vrt").string(), two = vrt("two.vrt", source_of(one));
    EXPECT_EQ(refusal(vrt("one.vrt", source_of(two))),
              "a virtual raster that is made of itself, by way of '" + one + "'");
}

TEST(Guard, VirtualRastersOfEndlesslyManySourcesAreNotGoneThrough) {
    std::string sources;
    for (int i = 0; i <= 200'000; ++i)
        sources += "<SimpleSource><SourceFilename>a</SourceFilename></SimpleSource>";
    EXPECT_EQ(refusal(vrt("many.vrt", sources)),
              "a virtual raster of more than 200000 sources; cut it up");
    const std::string large = vrt("large.vrt", source_of("a"));
    std::filesystem::resize_file(large, std::uintmax_t{257} << 20);
    EXPECT_EQ(refusal(large),
              "a virtual raster of 257 MiB ('" + large + "'), expected at most 256");
}

TEST(Guard, PipesAndDevicesAreNotWaitedFor) {
    const std::string pipe = (folder() / "pipe.tif").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    constexpr const char* kRemedy =
        ", expected a file or a folder; write what it gives to a file first";
    EXPECT_EQ(refusal(pipe), std::string("a pipe") + kRemedy);
    EXPECT_EQ(refusal("/dev/zero"), std::string("a device") + kRemedy);
    EXPECT_EQ(refusal("/vsigzip/" + pipe), std::string("a pipe") + kRemedy);
    EXPECT_EQ(refusal("/vsizip/" + pipe + "/a.tif"), std::string("a pipe") + kRemedy);
    EXPECT_EQ(refusal("NETCDF:\"" + pipe + "\":z"), std::string("a pipe") + kRemedy);
    EXPECT_EQ(refusal(vrt("of_pipe.vrt", source_of(pipe))),
              "a virtual raster of '" + pipe + "', a pipe, expected files");
    // Names of file systems that GDAL might have end the search.
    for (const char* name : {"/vsi", "/vsinowhere", "/vsinowhere/", "NETCDF:\"/vsix"})
        EXPECT_NO_THROW(refuse_unreadable(name)) << name;
    std::filesystem::create_symlink("/dev/zero", folder() / "zero.tif");
    EXPECT_EQ(refusal((folder() / "zero.tif").string()), std::string("a device") + kRemedy);
}

TEST(Guard, AnArchiveBesideItsHeaderIsAnArchive) {
    // A header makes cells of whatever has its name before the dot.
    Raster raster;
    raster.driver = "EHdr";
    raster.columns = raster.rows = 60;
    const std::string cells = write_raster(folder() / "taken.bil", raster);
    EXPECT_NO_THROW(load(cells));
    ASSERT_EQ(std::system(("cd " + folder().string() +
                           " && python3 -m zipfile -c taken.zip taken.bil taken.hdr taken.prj && "
                           "cp taken.zip both.zip && head -c 20000 /dev/zero > zeros && "
                           "python3 -m zipfile -c none.zip zeros && "
                           "cp none.zip other.bil && cp taken.hdr other.hdr && "
                           "cp taken.prj other.prj && cp none.zip other.zip && "
                           "printf '\\037\\213\\010\\000' > gz.bil && "
                           "head -c 30000 /dev/zero >> gz.bil && cp taken.hdr gz.hdr && "
                           "cp taken.prj gz.prj")
                              .c_str()),
              0);
    const std::string archive =
        "an archive or a compressed file, expected a raster, or a .zip, .tar or .gz of one; unpack "
        "it first";
    EXPECT_EQ(refusal((folder() / "other.bil").string()), archive);
    EXPECT_EQ(refusal((folder() / "other.zip").string()), archive);
    EXPECT_EQ(refusal((folder() / "gz.bil").string()), archive);
    // Beside the header of what is in it: what is in it.
    EXPECT_EQ(load((folder() / "taken.zip").string()).height_m, load(cells).height_m);
    // Heights may begin like one.
    raster.type = "Byte";
    raster.value = [](int column, int row, int) { return row > 0 ? 7 : "PK\3\5"[column % 4]; };
    EXPECT_EQ(load(write_raster(folder() / "pk.bil", raster)).about.statistics.valid, 3600);
}

TEST(Guard, TheSystemsReasonIsSaid) {
    const std::string loop = (folder() / "loop.tif").string();
    std::filesystem::create_symlink("loop.tif", loop);
    EXPECT_EQ(refusal(loop), "cannot be read, Too many levels of symbolic links");
    const std::string longest = (folder() / std::string(300, 'a')).string();
    EXPECT_EQ(refusal(longest), "cannot be read, File name too long");
    const std::string dangling = (folder() / "dangling.tif").string();
    std::filesystem::create_symlink("nowhere.tif", dangling);
    EXPECT_EQ(refusal(dangling), "no such file; it is a link to nowhere.tif, which is not there");

    const std::string path = write_raster(folder() / "closed.tif", {});
    ASSERT_EQ(chmod(path.c_str(), 0), 0);
    // Whoever runs this as root is nobody for a moment.
    const bool root = geteuid() == 0;
    if (!root || seteuid(65534) == 0) {
        const std::string message = refusal(path);
        ASSERT_TRUE(!root || seteuid(0) == 0);
        EXPECT_EQ(message, "cannot be read, Permission denied");
    }
}

TEST(Guard, AProcessWithoutFilesLeftSaysSo) {
    const std::string path = write_raster(folder() / "one_of_many.tif", {});
    EXPECT_NO_THROW(load(path));
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    const int lowest_free = dup(0);
    close(lowest_free);
    rlimit none = before;
    none.rlim_cur = static_cast<rlim_t>(lowest_free);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
    const std::string message = refusal(path);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_EQ(message, "cannot be read, Too many open files; allow more of them with ulimit -n");
}

/// The last: the net is open from here on.
TEST(Guard, TheNetOfOneNameIsNotThatOfAFile) {
    const std::string remote = "/vsicurl/http://127.0.0.1:9/a.tif";
    EXPECT_FALSE(is_remote_allowed());
    EXPECT_THAT(refusal(remote), testing::HasSubstr("is not a file of this machine"));
    EXPECT_FALSE(is_remote_allowed());
    allow_name(remote);
    EXPECT_NE(test::error_of([&] { load(remote); }), "no error");
    EXPECT_TRUE(is_remote_allowed());
    EXPECT_EQ(refusal(service()), kService);
    const std::string other = "/vsicurl/http://127.0.0.1:9/b.tif";
    EXPECT_EQ(refusal(vrt("late.vrt", source_of(other))),
              fmt::format("a virtual raster of '{}', expected files of this machine; the net is "
                          "asked only by a name on the command line",
                          other));
    // As the text of a name, too.
    const std::string text =
        "<VRTDataset rasterXSize=\"6\" rasterYSize=\"4\"><VRTRasterBand dataType=\"Float32\" "
        "band=\"1\">" +
        source_of("WMTS:here") + "</VRTRasterBand></VRTDataset>";
    allow_name(text);
    EXPECT_EQ(refusal(text),
              "a virtual raster of 'WMTS:here', expected files of this machine; the net is asked "
              "only by a name on the command line");
}

}  // namespace
}  // namespace relevo::dem::test_guard

// `relevo capture --sheet`: files of map sheets.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gdal_priv.h>
#include <gmock/gmock.h>

#include "base/text.h"
#include "cli/program.h"
#include "image/image.h"
#include "support/support.h"

namespace relevo::test::test_map_sheet {
namespace {

using testing::HasSubstr;

class PaperSheet : public testing::Test {
  protected:
    std::filesystem::path draw(const std::string& name, std::vector<std::string> more) {
        const std::filesystem::path path = dir_ / name;
        std::vector<std::string> arguments{"-q",    "capture",     bundled_dem(),
                                           "-o",    path.string(), "--preset",
                                           "swiss", "--time",      "2026-06-21T10:00Z"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Result made = relevo(arguments);
        EXPECT_EQ(made.status, 0) << made.err;
        return path;
    }

    /// Big-endian number.
    static unsigned number_at(const std::string& bytes, std::size_t at) {
        unsigned value = 0;
        for (std::size_t i = at; i < at + 4; ++i)
            value = value << 8 | static_cast<unsigned char>(bytes[i]);
        return value;
    }

    std::filesystem::path dir_ = scratch_dir("cli_map_sheet");
};

TEST_F(PaperSheet, PicturesSayTheirDpi) {
    const std::filesystem::path png = draw("sheet.png", {"--sheet", "a4", "--dpi", "100"});
    const image::Image8 picture = image::read(png);
    EXPECT_EQ(picture.width, 827);  // which stands, as the DEM does
    EXPECT_EQ(picture.height, 1169);
    const std::string bytes = read_text(png, "test");
    const std::size_t at = bytes.find("pHYs");
    ASSERT_NE(at, std::string::npos);
    EXPECT_EQ(number_at(bytes, at + 4), 3937U);  // a metre
    EXPECT_EQ(number_at(bytes, at + 8), 3937U);

    GDALAllRegister();
    const std::filesystem::path tif = draw("sheet.tif", {"--sheet", "a4-portrait", "--dpi", "72"});
    const std::unique_ptr<GDALDataset> map(GDALDataset::Open(tif.c_str()));
    ASSERT_NE(map, nullptr);
    EXPECT_EQ(map->GetRasterXSize(), 595);
    EXPECT_EQ(std::stod(map->GetMetadataItem("TIFFTAG_XRESOLUTION")), 72);
    EXPECT_THAT(map->GetMetadataItem("TIFFTAG_RESOLUTIONUNIT"), HasSubstr("2"));
    ASSERT_NE(map->GetSpatialRef(), nullptr);
}

TEST_F(PaperSheet, APdfIsMadeAgainFromItself) {
    const std::vector<std::string> how{"--sheet", "a3",     "--dpi", "60",      "--map-scale",
                                       "100000",  "--view", "top",   "--stamp", "all"};
    const std::filesystem::path first = draw("first.pdf", how), again = dir_ / "again.pdf";
    const Result made = relevo({"-q", "capture", "--from", first.string(), "-o", again.string()});
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(read_text(first, "test"), read_text(again, "test"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "first.pfw"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "first.pdf.aux.xml"));
}

TEST_F(PaperSheet, AJobMakesThem) {
    const std::filesystem::path job = dir_ / "job.json";
    std::ofstream(job) << R"({"format": 1, "dem": {"files": [")" << bundled_dem()
                       << R"("]}, "picture": {"sheet": "a4", "map_scale": 250000, "dpi": 50},
                       "stamps": {"show": ["title", "scale"]},
                       "time": {"at": "10:00", "date": "2026-06-21"}, "effects": {"only": []},
                       "sweep": [{"times": {"from": "10:00", "to": "14:00", "step": "4h"}}],
                       "output": "map_{n}.pdf"})";
    const Result made = relevo({"run", job.string()});
    EXPECT_EQ(made.status, 0) << made.err;
    for (const char* name : {"map_1.pdf", "map_2.pdf"})
        EXPECT_THAT(read_text(dir_ / name, "test"), testing::StartsWith("%PDF-1.")) << name;
    const Result again = relevo({"run", job.string(), "--resume"});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_THAT(again.err, HasSubstr("0 pictures in"));
}

TEST_F(PaperSheet, RefusesWhatItCannotBe) {
    const auto expect = [&](const char* name, std::vector<std::string> more, int status,
                            const std::string& message) {
        more.insert(more.begin(), {"-q", "capture", bundled_dem(), "-o", (dir_ / name).string()});
        expect_failure(more, status, message);
        EXPECT_FALSE(std::filesystem::exists(dir_ / name));
    };
    const std::string pdf = (dir_ / "a.pdf").string();
    expect("a.pdf", {"--view", "north"}, 3,
           pdf + ": only map sheets can be pdf; add --sheet a4, or name a png");
    expect("a.pdf", {"--sheet", "a4", "--view", "north"}, 2,
           "--sheet: a map is seen from straight above; use --view top, or none");
    expect("a.png", {"--sheet", "a4", "--size", "9x9"}, 2,
           "--sheet and --size exclude each other; --dpi sets the pixels of a sheet");
    expect("a.png", {"--sheet", "a4", "--resolution", "9"}, 3,
           "--sheet and --resolution exclude each other; use --map-scale and --dpi");
    expect("a.png", {"--map-scale", "9"}, 3, "--map-scale: needs --sheet, such as --sheet a3");
    expect("a.png", {"--dpi", "99"}, 3, "--dpi: needs --sheet, such as --sheet a3");
    expect("a.exr", {"--sheet", "a4"}, 3,
           "--sheet: exr has linear light without stamps; name a png, tif, jpg or pdf");
    expect("a.pdf", {"--sheet", "a4", "--transparent"}, 3,
           "--transparent: not in a pdf; name a png or tif");
    expect("a.pdf", {"--sheet", "a0", "--dpi", "2400"}, 3,
           "--dpi: 2400 dpi make 79465 x 112346 px, more than 1 GiB; use at most 480");
    expect("a.pdf", {"--sheet", "a4", "--map-scale", "1"}, 3,
           "--map-scale: 1 : 1 shows less than a post of the DEM; use 426 or more");
    expect("a.pdf", {"--sheet", "a4", "--map-scale", "1e9"}, 3,
           "--map-scale: 1 : 1 000 000 000 makes a map of 0 x 0 px; 1 : 200 000 fills the sheet");
}

}  // namespace
}  // namespace relevo::test::test_map_sheet

// Sheets as PDF. What is in a file is read by its operators.
#include <regex>

#include <gmock/gmock.h>
#include <zlib.h>

#include "base/output_file.h"
#include "base/text.h"
#include "chart/stamps.h"
#include "support/support.h"

namespace relevo::chart::test_pdf {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A grey JPEG of 8 x 8 pixels.
std::vector<std::byte> jpeg() {
    return image::encoded("grey.jpg", {image::Image8(8, 8, 3)}, {}, {});
}

PaperSheet sheet() {
    Stamps stamps;
    stamps.title = "Inn valley";
    stamps.scale = Stamps::Scale{0.05, "WGS 84 / UTM zone 32N", "1 : 25 000"};
    stamps.north = glm::dvec2(0, -1);
    PaperSheet sheet{.size_mm = {210, 297},
                     .dpi = 100,
                     .picture = {50, 100, 600, 800},
                     .line_px = 1,
                     .title = "Inn valley",
                     .author = "JAXA",
                     .creator = "Relevo"};
    sheet.drawings = lay_out(stamps, {827, 1169}, 1, sheet.picture).drawings;
    return sheet;
}

std::string written(const std::filesystem::path& path) {
    OutputFile file(path, /*overwrite=*/true, "test");
    write_pdf(sheet(), jpeg(), file);
    file.finish();
    return read_text(path, "test");
}

/// All streams that zlib has deflated.
std::string streams(const std::string& pdf) {
    std::string all;
    for (std::size_t at = 0; (at = pdf.find("stream\n", at)) != std::string::npos; at += 7) {
        std::vector<char> text(1 << 16);
        uLongf size = text.size();
        const auto* const from = reinterpret_cast<const Bytef*>(pdf.data() + at + 7);
        z_stream stream{};
        inflateInit(&stream);
        stream.next_in = const_cast<Bytef*>(from);
        stream.avail_in = static_cast<uInt>(pdf.size() - at - 7);
        stream.next_out = reinterpret_cast<Bytef*>(text.data());
        stream.avail_out = static_cast<uInt>(size);
        if (inflate(&stream, Z_FINISH) == Z_STREAM_END) all.append(text.data(), stream.total_out);
        inflateEnd(&stream);
    }
    return all;
}

TEST(Pdf, HasItsSizeItsMetadataAndNoDate) {
    const std::string pdf = written(test::scratch_dir() / "sheet.pdf");
    EXPECT_THAT(pdf, testing::StartsWith("%PDF-1."));
    const std::string all = pdf + streams(pdf);
    std::smatch box;
    ASSERT_TRUE(std::regex_search(all, box, std::regex(R"(MediaBox \[ 0 0 ([0-9.]+) ([0-9.]+))")));
    EXPECT_NEAR(std::stod(box[1]), 210 / 25.4 * 72, 1e-3);
    EXPECT_NEAR(std::stod(box[2]), 297 / 25.4 * 72, 1e-3);
    EXPECT_THAT(all, HasSubstr("/Title (Inn valley)"));
    EXPECT_THAT(all, HasSubstr("/Author (JAXA)"));
    EXPECT_THAT(all, Not(HasSubstr("Date")));
    EXPECT_EQ(pdf, written(test::scratch_dir("again") / "sheet.pdf"));
}

TEST(Pdf, TextIsText) {
    const std::string all = streams(written(test::scratch_dir() / "sheet.pdf"));
    // In WinAnsi letters stand as they are, in pieces between kerns: [(Inn v)-1(alley)]TJ.
    std::string letters;
    const std::regex piece(R"(\(((?:[^()\\]|\\.)*)\))");
    for (auto at = std::sregex_iterator(all.begin(), all.end(), piece);
         at != std::sregex_iterator(); ++at)
        letters += (*at)[1];
    EXPECT_THAT(letters, HasSubstr("Inn valley"));
    EXPECT_THAT(letters, HasSubstr("1 : 25 000"));
    EXPECT_THAT(letters, HasSubstr("WGS 84 / UTM zone 32N"));
    EXPECT_THAT(all, HasSubstr("BT\n"));
}

TEST(Pdf, ThePictureIsTheGivenJpegAtItsPlace) {
    const std::string pdf = written(test::scratch_dir() / "sheet.pdf");
    const std::vector<std::byte> bytes = jpeg();
    EXPECT_THAT(pdf,
                HasSubstr(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())));
    // 600 x 800 px at 100 dpi, as the matrix before the image.
    EXPECT_THAT(streams(pdf), testing::ContainsRegex("432 0 0 -?576 36 "));
}

TEST(Pdf, AFullDiskLeavesAnError) {
    EXPECT_THAT(test::error_of([] {
                    OutputFile file("/dev/full", /*overwrite=*/true, "test");
                    write_pdf(sheet(), jpeg(), file);
                    file.finish();
                }),
                HasSubstr("No space left on device"));
}

}  // namespace
}  // namespace relevo::chart::test_pdf

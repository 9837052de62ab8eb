// Where a photograph was taken: JPEGs whose Exif data are written here, byte by byte.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gdal.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "base/units.h"
#include "dem/gdal_support.h"
#include "overlay/camera_photo.h"
#include "support/support.h"

namespace relevo::overlay::test_camera_photo {
namespace {

/// A field of Exif: text (type 2), a short (3), rationals (5) in millionths.
struct Field {
    std::uint16_t tag;
    std::uint16_t type;
    std::string text;
    std::vector<double> numbers;
};

void put(std::string& to, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        to += static_cast<char>(value >> (8 * i));
}

std::string bytes_of(const Field& field) {
    if (field.type == 2) return field.text + '\0';
    std::string bytes;
    for (const double number : field.numbers) {
        if (field.type == 3) {
            put(bytes, static_cast<std::uint32_t>(number), 2);
        } else {
            put(bytes, static_cast<std::uint32_t>(std::lround(number * 1e6)), 4);
            put(bytes, 1'000'000, 4);
        }
    }
    return bytes;
}

/// A directory at `offset` of the Exif block, little endian; what does not fit follows it.
std::string directory(const std::vector<Field>& fields, std::size_t offset) {
    std::string head, tail;
    put(head, static_cast<std::uint32_t>(fields.size()), 2);
    const std::size_t end = offset + 2 + 12 * fields.size() + 4;
    for (const Field& field : fields) {
        std::string bytes = bytes_of(field);
        put(head, field.tag, 2);
        put(head, field.type, 2);
        put(head, static_cast<std::uint32_t>(field.type == 2 ? bytes.size() : field.numbers.size()),
            4);
        if (bytes.size() <= 4) {
            bytes.resize(4);
            head += bytes;
        } else {
            put(head, static_cast<std::uint32_t>(end + tail.size()), 4);
            tail += bytes;
        }
    }
    put(head, 0, 4);
    return head + tail;
}

/// A picture of 60 x 40 with those fields.
std::string jpeg_with(std::vector<Field> first, const std::vector<Field>& camera,
                      const std::vector<Field>& gps) {
    // A long (type 4) is written as two shorts.
    const std::size_t at = 8, camera_at = 512, gps_at = 1024;
    first.push_back({0x8769, 4, "", {}});
    first.push_back({0x8825, 4, "", {}});
    std::string tiff = std::string("II\x2a\0", 4);
    put(tiff, 8, 4);
    std::string head = directory(first, at);
    const auto set_long = [&](std::size_t entry, std::uint32_t value) {
        std::string bytes;
        put(bytes, 1, 4);
        put(bytes, value, 4);
        head.replace(2 + 12 * entry + 4, 8, bytes);
    };
    set_long(first.size() - 2, camera_at);
    set_long(first.size() - 1, gps_at);
    tiff += head;
    tiff.resize(camera_at);
    tiff += directory(camera, camera_at);
    tiff.resize(gps_at);
    tiff += directory(gps, gps_at);

    dem::prepare_gdal();
    const auto path = (test::scratch_dir() / "camera.jpg").string();
    GDALDatasetH memory = GDALCreate(GDALGetDriverByName("MEM"), "", 60, 40, 3, GDT_Byte, nullptr);
    GDALClose(GDALCreateCopy(GDALGetDriverByName("JPEG"), path.c_str(), memory, 0, nullptr, nullptr,
                             nullptr));
    GDALClose(memory);
    std::string file = read_text(path, "test"), app = "\xff\xe1";
    const std::size_t length = 2 + 6 + tiff.size();
    app += static_cast<char>(length >> 8);
    app += static_cast<char>(length & 0xff);
    app += std::string("Exif\0\0", 6) + tiff;
    std::ofstream(path, std::ios::binary) << file.insert(2, app);
    return path;
}

const std::vector<Field> kGps = {
    {1, 2, "S", {}},        {2, 5, "", {46, 33, 12.5}}, {3, 2, "W", {}},
    {4, 5, "", {8, 30, 0}}, {6, 5, "", {1234.5}},       {7, 5, "", {10, 12, 30}},
    {16, 2, "M", {}},       {17, 5, "", {278.25}},      {29, 2, "2026:06:21", {}}};

TEST(CameraPhoto, HasPlaceHeadingLensAndTime) {
    const std::string path = jpeg_with(
        {{0x112, 3, "", {6}}},
        {{0x9003, 2, "2026:06:21 12:12:30", {}}, {0x9011, 2, "+02:00", {}}, {0xa405, 3, "", {28}}},
        kGps);
    const CameraPhoto photo = camera_photo(path).value();
    ASSERT_TRUE(photo.place);
    EXPECT_NEAR(degrees(photo.place->lat_rad), -(46 + 33 / 60.0 + 12.5 / 3600), 1e-7);
    EXPECT_NEAR(degrees(photo.place->lon_rad), -8.5, 1e-7);
    EXPECT_NEAR(photo.place->height_m, 1234.5, 1e-3);
    EXPECT_NEAR(photo.heading_deg.value(), 278.25, 1e-3);
    EXPECT_TRUE(photo.is_magnetic);
    EXPECT_EQ(photo.focal_length_mm, 28);
    EXPECT_EQ(photo.width_px, 40);  // held upright
    EXPECT_EQ(photo.height_px, 60);
    EXPECT_EQ(photo.time, "2026-06-21T12:12:30+02:00");
}

TEST(CameraPhoto, TakesTheTimeOfTheGpsWhereTheCameraHasNoOffset) {
    const auto local = Field{0x9003, 2, "2026:06:21 12:12:30", {}};
    EXPECT_EQ(camera_photo(jpeg_with({}, {local}, kGps))->time, "2026-06-21T10:12:30Z");
    EXPECT_EQ(camera_photo(jpeg_with({}, {local}, {}))->time, "2026-06-21T12:12:30");
    EXPECT_FALSE(camera_photo(jpeg_with({}, {local}, {}))->place);
}

TEST(CameraPhoto, WhatCannotBeIsMissing) {
    const auto local = Field{0x9003, 2, "2026:06:21 12:12:30", {}};
    std::vector<Field> gps = kGps;
    gps[1].numbers = {146, 0, 0};
    gps[7].numbers = {400};
    const CameraPhoto photo = camera_photo(jpeg_with({}, {local}, gps)).value();
    EXPECT_FALSE(photo.place);
    EXPECT_FALSE(photo.heading_deg);
    EXPECT_FALSE(camera_photo(jpeg_with({}, {}, {})));
    EXPECT_FALSE(camera_photo((test::scratch_dir() / "missing.jpg").string()));
    EXPECT_FALSE(camera_photo((test::source_dir() / "README.md").string()));
}

}  // namespace
}  // namespace relevo::overlay::test_camera_photo

#include <fstream>

#include "dem/fixture.h"
#include "dem/whole_file.h"
#include "support/support.h"

namespace relevo::dem::test_whole_file {
namespace {

using test::folder;

/// Bytes of a netCDF classic header, built by hand from the format's specification.
class Bytes {
  public:
    explicit Bytes(char version) : wide_(version == 5), version_(version) {
        text_ = std::string("CDF") + version;
    }
    Bytes& tag(unsigned value) { return put(value, 4); }
    Bytes& count(std::uint64_t value) { return put(value, wide_ ? 8 : 4); }
    Bytes& offset(std::uint64_t value) { return put(value, version_ == 1 ? 4 : 8); }
    Bytes& name(const std::string& name) {
        count(name.size());
        text_ += name;
        while (text_.size() % 4 != 0)
            text_ += '\0';
        return *this;
    }
    std::filesystem::path write(const char* file) const {
        std::ofstream(folder() / file, std::ios::binary) << text_;
        return folder() / file;
    }

  private:
    Bytes& put(std::uint64_t value, int bytes) {
        for (int i = bytes - 1; i >= 0; --i)
            text_ += static_cast<char>(value >> (8 * i) & 0xFF);
        return *this;
    }
    bool wide_;
    char version_;
    std::string text_;
};

constexpr unsigned kDimension = 10;
constexpr unsigned kVariable = 11;
constexpr unsigned kAttribute = 12;
constexpr unsigned kShort = 3;
constexpr unsigned kFloat = 5;

TEST(ClassicNetcdf, SizeOfFixedVariablesIsTheEndOfTheLast) {
    for (const char version : {1, 2, 5}) {
        Bytes b(version);
        b.count(0);
        b.tag(kDimension).count(2).name("lat").count(7).name("lon").count(9);
        b.tag(kAttribute).count(1).name("title").tag(kShort).count(3).tag(0).tag(0);
        b.tag(kVariable).count(2);
        b.name("z").count(2).count(0).count(1);  // 7 x 9 shorts
        b.tag(0).count(0).tag(kShort).count(128).offset(1000);
        b.name("lon").count(1).count(1);  // 9 floats
        b.tag(0).count(0).tag(kFloat).count(36).offset(900);
        EXPECT_EQ(classic_netcdf_size(b.write("fixed.nc")), 1000u + 7 * 9 * 2) << int{version};
    }
}

Bytes growing(int variables, unsigned records) {
    Bytes b(1);
    b.count(records);
    b.tag(kDimension).count(2).name("time").count(0).name("x").count(3);
    b.tag(0).count(0).tag(kVariable).count(static_cast<unsigned>(variables));
    for (int i = 0; i < variables; ++i) {
        b.name("v").count(2).count(0).count(1);  // 3 shorts a record: 6 bytes, 8 with padding
        b.tag(0).count(0).tag(kShort).count(8).offset(500 + 8 * static_cast<unsigned>(i));
    }
    return b;
}

TEST(ClassicNetcdf, RecordsAreCounted) {
    EXPECT_EQ(classic_netcdf_size(growing(1, 4).write("one.nc")), 500u + 4 * 6);
    EXPECT_EQ(classic_netcdf_size(growing(2, 4).write("two.nc")), 500u + 4 * 16);
    EXPECT_EQ(classic_netcdf_size(growing(1, 0xFFFFFFFF).write("stream.nc")), 0u);
}

TEST(ClassicNetcdf, WhatGdalWritesIsWhole) {
    for (const char* format : {"NC", "NC2"}) {
        test::Raster raster;
        raster.driver = "netCDF";
        raster.options = {std::string("FORMAT=") + format};
        const std::string path = test::write_raster(folder() / "gdal.nc", raster);
        EXPECT_EQ(classic_netcdf_size(path), std::filesystem::file_size(path)) << format;
    }
}

TEST(ClassicNetcdf, OtherFilesAreNotJudged) {
    test::Raster raster;
    raster.driver = "netCDF";
    raster.options = {"FORMAT=NC4"};
    EXPECT_EQ(classic_netcdf_size(test::write_raster(folder() / "hdf5.nc", raster)), 0u);
    EXPECT_EQ(classic_netcdf_size("/nowhere/a.nc"), 0u);
    const std::filesystem::path text = folder() / "text";
    std::ofstream(text) << "CDF without a version";
    EXPECT_EQ(classic_netcdf_size(text), 0u);
}

TEST(ClassicNetcdf, CutOrSpoiledHeadersDoNoHarm) {
    const std::filesystem::path whole = growing(3, 4).write("spoiled.nc");
    const auto size = std::filesystem::file_size(whole);
    std::ifstream in(whole, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    const std::filesystem::path file = folder() / "harm.nc";
    for (std::uintmax_t keep = 0; keep < size; ++keep) {
        std::ofstream(file, std::ios::binary) << bytes.substr(0, keep);
        EXPECT_EQ(classic_netcdf_size(file), 0u) << keep;
    }
    for (std::uintmax_t at = 4; at < size; ++at) {
        std::string spoiled = bytes;
        spoiled[at] = '\xFF';
        std::ofstream(file, std::ios::binary) << spoiled;
        classic_netcdf_size(file);  // any answer, in a moment
    }
}

}  // namespace
}  // namespace relevo::dem::test_whole_file

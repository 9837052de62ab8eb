// What file managers read.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_desktop {
namespace {

namespace fs = std::filesystem;

fs::path desktop() {
    return source_dir() / "packaging/desktop";
}

bool is_there(const std::string& program) {
    return run("/bin/sh", {"-c", "command -v " + program}).status == 0;
}

TEST(Desktop, FilesAreValid) {
    if (!is_there("desktop-file-validate") || !is_there("appstreamcli"))
        GTEST_SKIP() << "not run: needs desktop-file-utils and appstream";
    const Result entry =
        run("/usr/bin/desktop-file-validate", {desktop() / "org.relevo.Relevo.desktop"});
    EXPECT_EQ(entry.status, 0) << entry.out;
    const Result about =
        run("/usr/bin/appstreamcli",
            {"validate", "--no-net", build_dir() / "packaging/org.relevo.Relevo.metainfo.xml"});
    EXPECT_EQ(about.status, 0) << about.out;
}

/// The type of files that GIO finds with ours among the types.
class FileTypes : public testing::Test {
  protected:
    void SetUp() override {
        if (!is_there("gio") || !is_there("update-mime-database"))
            GTEST_SKIP() << "not run: needs libglib2.0-bin and shared-mime-info";
        dir_ = scratch_dir();
        fs::create_directories(dir_ / "data/mime/packages");
        fs::copy("/usr/share/mime/packages/freedesktop.org.xml", dir_ / "data/mime/packages");
        fs::copy(desktop() / "org.relevo.Relevo.xml", dir_ / "data/mime/packages");
        ASSERT_EQ(run("/usr/bin/update-mime-database", {(dir_ / "data/mime").string()}).status, 0);
    }

    std::string type_of(const std::string& name, const std::string& content) const {
        std::ofstream(dir_ / name, std::ios::binary) << content;
        const Result info =
            run("/usr/bin/gio", {"info", "-a", "standard::content-type", (dir_ / name).string()},
                {"XDG_DATA_DIRS=" + (dir_ / "data").string(), "XDG_DATA_HOME=/nowhere",
                 "GIO_USE_VFS=local"});
        const std::string key = "standard::content-type: ";
        const std::size_t at = info.out.find(key);
        if (at == std::string::npos) return info.out + info.err;
        return std::string(trimmed(split(info.out.substr(at + key.size()), '\n').front()));
    }

    fs::path dir_;
};

TEST_F(FileTypes, AreFoundByContentWhereEndingsAreShared) {
    EXPECT_EQ(type_of("grid.asc", "ncols 2\nnrows 2\n"), "application/x-esri-ascii-grid");
    EXPECT_EQ(type_of("GRID2.asc", "NCOLS 2\nNROWS 2\n"), "application/x-esri-ascii-grid");
    EXPECT_EQ(type_of("key.asc", "-----BEGIN PGP MESSAGE-----\n"), "application/pgp-encrypted");
    EXPECT_EQ(type_of("sea.bag", "\x89HDF\r\n\x1a\n"), "application/x-bag");
    EXPECT_EQ(type_of("robot.bag", "#ROSBAG V2.0\n"), "application/x-rosbag");
    EXPECT_EQ(type_of("N47E011.hgt", "\1\2"), "application/x-srtm-hgt");
    EXPECT_EQ(type_of("n43.dt1", "UHL1"), "application/x-dted");
    EXPECT_EQ(type_of("quad.dem", "MOUNT ST HELENS"), "application/x-usgs-dem");
}

}  // namespace
}  // namespace relevo::test::test_desktop

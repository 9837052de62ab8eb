// Indexes of tiles that are read from an object store.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cli/object_store.h"
#include "cli/program.h"
#include "dem/fixture.h"
#include "dem/index_fixture.h"
#include "support/support.h"

namespace relevo::test::test_remote_index {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Fault = ObjectStoreServer::Fault;
using Request = ObjectStoreServer::Request;

const std::string kIndex = "/vsis3/bucket/index.fgb";
constexpr int kSide = 128, kTiles = 4;

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Tiles from west to east, that no compression makes short.
class RemoteIndex : public testing::Test {
  protected:
    RemoteIndex() {
        std::vector<IndexRow> rows;
        for (int i = 0; i < kTiles; ++i) {
            Raster raster;
            raster.columns = raster.rows = kSide;
            raster.geotransform = {{500000 + 30.0 * kSide * i, 30, 0, 5200000, 0, -30}};
            raster.value = [i](int column, int row, int) {
                return 900 + 200 * std::sin(0.01 * (kSide * i + column) * row);
            };
            names_.push_back(fmt::format("t{}.tif", i));
            rows.push_back(row_of(write_raster(dir_ / names_.back(), raster)));
            rows.back().location = names_.back();
        }
        write_index(dir_ / "index.fgb", "FlatGeobuf", rows);
    }
    void fill(ObjectStoreServer& store) const {
        for (const std::string& name : names_)
            store.put("/bucket/" + name, bytes_of(dir_ / name));
        store.put("/bucket/index.fgb", bytes_of(dir_ / "index.fgb"));
    }
    /// With less patience than without being told.
    Result shadow(const ObjectStoreServer& store) const {
        std::vector<std::string> all = store.environment();
        all.insert(all.end(), {"GDAL_HTTP_LOW_SPEED_TIME=2", "GDAL_HTTP_MAX_RETRY=1"});
        return relevo({"sun", "shadow", kIndex, "--sun", "100,10", "-o", result_.string()}, all);
    }

    std::filesystem::path dir_ = scratch_dir("remote"), result_ = dir_ / "shadow.tif";
    std::vector<std::string> names_;
};

TEST_F(RemoteIndex, AMissingTileIsAVoid) {
    ObjectStoreServer store;
    fill(store);
    const Result whole = shadow(store);
    ASSERT_EQ(whole.status, 0) << whole.err;
    EXPECT_EQ(whole.err.find("missing"), std::string::npos) << whole.err;
    ObjectStoreServer less([](const Request& request, int) {
        return request.path == "/bucket/t2.tif" ? ObjectStoreServer::status(404) : Fault{};
    });
    fill(less);
    std::filesystem::remove(result_);
    const Result run = shadow(less);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(": 1 (t2) of 4 tiles are missing: their posts are voids"));
}

// Each is a request, and of a million that takes a day.
TEST_F(RemoteIndex, AStoreWithoutTheTilesIsNotAskedForAllOfThem) {
    std::vector<IndexRow> rows;
    for (int i = 0; i < 3000; ++i)
        rows.push_back({fmt::format("gone/{}.tif", i),
                        {500000 + 30.0 * i, 5199000, 500030 + 30.0 * i, 5200000}});
    ObjectStoreServer store;
    store.put("/bucket/index.fgb", bytes_of(write_index(dir_ / "gone.fgb", "FlatGeobuf", rows)));
    const Result run = shadow(store);
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, StartsWith("relevo: error: " + kIndex +
                                    ": none of 100 tiles that were asked for, of 3000, is in "
                                    "/vsis3/bucket, the first is /vsis3/bucket/gone/"));
    const auto requests = store.requests();
    EXPECT_LT(requests.size(), 250u);
    EXPECT_FALSE(std::filesystem::exists(result_));
}

// GDAL does not say why it cannot look into an archive.
TEST_F(RemoteIndex, ATileInAnArchiveThatTheStoreDoesNotGiveIsNotMissing) {
    const std::string archive = "/vsis3/bucket/t.zip";
    const std::string index =
        write_index(dir_ / "zip.fgb", "FlatGeobuf",
                    {{"/vsizip/" + archive + "/t.tif", {500000, 5199000, 501000, 5200000}}});
    for (const int code : {404, 403, 500}) {
        ObjectStoreServer store([code](const Request& request, int) {
            return request.path == "/bucket/t.zip" ? ObjectStoreServer::status(code) : Fault{};
        });
        store.put("/bucket/index.fgb", bytes_of(index));
        const Result run = shadow(store);
        EXPECT_EQ(run.status, 3);
        EXPECT_THAT(run.err, HasSubstr(code == 404   ? "none of its 1 tiles is there"
                                       : code == 403 ? "t.zip/t.tif: may not be read"
                                                     : "t.zip: cannot be asked for"));
    }
}

class BadRemoteTile : public RemoteIndex, public testing::WithParamInterface<BadAnswer> {};

// It may have heights, so it is no void.
TEST_P(BadRemoteTile, IsNamedAndNothingIsWritten) {
    ObjectStoreServer store([](const Request& request, int) {
        const auto range = request.headers.find("range");
        const bool is_head =
            range == request.headers.end() || range->second.starts_with("bytes=0-");
        return request.path == "/bucket/t2.tif" && !is_head ? GetParam().fault : Fault{};
    });
    fill(store);
    const auto began = std::chrono::steady_clock::now();
    const Result run = shadow(store);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    EXPECT_EQ(run.status, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("/vsis3/bucket/t2.tif: "));
    EXPECT_THAT(run.err, HasSubstr("try again"));
    EXPECT_LT(took.count(), 20);
    EXPECT_FALSE(std::filesystem::exists(result_));
}

INSTANTIATE_TEST_SUITE_P(RemoteIndex, BadRemoteTile, testing::ValuesIn(bad_answers()),
                         [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace relevo::test::test_remote_index

// DEMs that are read from an object store, and results that are written to one.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "cli/object_store.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test::test_object_store {
namespace {

using testing::HasSubstr;
using Fault = ObjectStoreServer::Fault;
using Request = ObjectStoreServer::Request;

const std::string kDem = "/vsis3/bucket/dem.tif", kResult = "/vsis3/bucket/shadow.tif";

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class ObjectStore : public testing::Test {
  protected:
    ObjectStore() { std::filesystem::create_directories(dir_ / "tmp"); }

    std::vector<std::string> environment(const ObjectStoreServer& store) const {
        std::vector<std::string> all = store.environment();
        all.push_back("TMPDIR=" + (dir_ / "tmp").string());
        return all;
    }
    Result shadow(const ObjectStoreServer& store, const std::string& dem, const std::string& result,
                  const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"sun", "shadow", dem, "--time", "2026-12-21T15:00Z",
                                       "-o",  result};
        words.insert(words.end(), more.begin(), more.end());
        return relevo(words, environment(store));
    }
    std::vector<std::string> left() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(dir_ / "tmp"))
            names.push_back(entry.path().filename().string());
        return names;
    }

    std::filesystem::path dir_ = scratch_dir();
    std::string content_ = read_text(bundled_dem());
};

TEST_F(ObjectStore, ADemIsReadThereAndNothingTwice) {
    ObjectStoreServer store;
    store.put("/bucket/dem.tif", content_);
    const Result there = relevo({"info", kDem, "--json"}, environment(store));
    ASSERT_EQ(there.status, 0) << there.err;
    std::string here = relevo({"info", bundled_dem(), "--json"}).out;
    const auto of_file = [](const std::string& text) {  // without its name, and without the sun now
        const std::size_t first = text.find("\"driver\"");
        return text.substr(first, text.find("\"sun\"") - first);
    };
    EXPECT_EQ(of_file(there.out), of_file(here));
    EXPECT_LE(store.bytes_sent(), content_.size() + 16 * 1024);
    EXPECT_LE(store.requests().size(), 20u);
}

TEST_F(ObjectStore, AResultIsPutWhole) {
    ObjectStoreServer store;
    store.put("/bucket/dem.tif", content_);
    const Result there = shadow(store, kDem, kResult);
    ASSERT_EQ(there.status, 0) << there.err;
    const std::string here = (dir_ / "shadow.tif").string();
    ASSERT_EQ(shadow(store, kDem, here).status, 0);
    EXPECT_EQ(store.objects().at("/bucket/shadow.tif"), read_text(here));
    EXPECT_THAT(left(), testing::IsEmpty());
}

TEST_F(ObjectStore, APictureIsTheSameBytes) {
    ObjectStoreServer store;
    const auto capture = [&](const std::string& name) {
        return relevo({"capture", bundled_dem(), "-o", name, "--size", "64x48"},
                      environment(store));
    };
    const std::string here = (dir_ / "a.png").string();
    ASSERT_EQ(capture(here).status, 0);
    const Result there = capture("/vsis3/bucket/a.png");
    ASSERT_EQ(there.status, 0) << there.err;
    EXPECT_EQ(store.objects().at("/bucket/a.png"), read_text(here));
}

TEST_F(ObjectStore, AnObjectIsReplacedWhenAskedFor) {
    ObjectStoreServer store;
    store.put("/bucket/shadow.tif", "old");
    const Result refused = shadow(store, bundled_dem(), kResult);
    EXPECT_EQ(refused.status, 3);
    EXPECT_EQ(refused.err,
              "relevo: error: -o: " + kResult + ": exists; pass --overwrite to replace it\n");
    EXPECT_EQ(store.objects().at("/bucket/shadow.tif"), "old");
    EXPECT_EQ(shadow(store, bundled_dem(), kResult, {"--overwrite"}).status, 0);
    EXPECT_GT(store.objects().at("/bucket/shadow.tif").size(), 1000u);
}

// Stores say 403 of what is not there to whoever may not list it: of what is there, too.
TEST_F(ObjectStore, NothingIsReplacedUnaskedWhereTheStoreDoesNotSayWhatExists) {
    ObjectStoreServer store([](const Request& request, int) {
        return request.method == "PUT" ? Fault{} : ObjectStoreServer::status(403);
    });
    store.put("/bucket/shadow.tif", "old");
    const Result refused = shadow(store, bundled_dem(), kResult);
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr(kResult + ": the store does not say whether it exists"));
    EXPECT_EQ(store.objects().at("/bucket/shadow.tif"), "old");
    EXPECT_EQ(shadow(store, bundled_dem(), kResult, {"--overwrite"}).status, 0);
    EXPECT_NE(store.objects().at("/bucket/shadow.tif"), "old");
}

TEST_F(ObjectStore, TheDemIsNotReplaced) {
    ObjectStoreServer store;
    store.put("/bucket/dem.tif", content_);
    const Result refused = shadow(store, kDem, kDem, {"--overwrite"});
    EXPECT_EQ(refused.status, 3) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("would be overwritten"));
    EXPECT_EQ(store.objects().at("/bucket/dem.tif"), content_);
}

TEST_F(ObjectStore, WhatOnlyReadsIsNotWrittenTo) {
    ObjectStoreServer store;
    const std::string name = "/vsicurl/http://" + store.address() + "/a.tif";
    const Result refused = shadow(store, bundled_dem(), name);
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr("GDAL only reads there"));
    EXPECT_THAT(store.requests(), testing::IsEmpty());
}

// What a long computation has found is not lost where the store refuses it.
TEST_F(ObjectStore, AResultThatIsRefusedIsKept) {
    for (const int code : {403, 503}) {
        const ObjectStoreServer store([code](const Request& request, int) {
            return request.method == "PUT" ? ObjectStoreServer::status(code) : Fault{};
        });
        const Result refused = shadow(store, bundled_dem(), kResult);
        EXPECT_EQ(refused.status, 1);
        EXPECT_THAT(refused.err,
                    HasSubstr("-o: " + kResult + ": cannot be written, the store or the net "));
        ASSERT_EQ(left().size(), 1u);
        const std::filesystem::path kept = dir_ / "tmp" / left().front();
        EXPECT_THAT(refused.err, HasSubstr("; the result is kept as " + kept.string() + "\n"));
        const std::string here = (dir_ / "shadow.tif").string();
        ASSERT_EQ(shadow(store, bundled_dem(), here, {"--overwrite"}).status, 0);
        EXPECT_EQ(read_text(kept), read_text(here));
        EXPECT_THAT(store.objects(), testing::IsEmpty());
        std::filesystem::remove(kept);
    }
}

// Also where parts of it are on their way.
TEST_F(ObjectStore, NoObjectIsMadeOfAResultThatTheDiskDoesNotLetRead) {
    for (const std::string bytes : {"50000000", "5000"}) {
        ObjectStoreServer store;
        store.put("/bucket/shadow.tif", "old");
        std::vector<std::string> broken = environment(store);
        broken.insert(broken.end(), {std::string("LD_PRELOAD=") + RELEVO_TEST_SHIM,
                                     "RELEVO_SHIM=pread", "VSIS3_CHUNK_SIZE_BYTES=" + bytes});
        const Result refused = relevo({"sun", "shadow", bundled_dem(), "--time",
                                       "2026-12-21T15:00Z", "-o", kResult, "--overwrite"},
                                      broken);
        EXPECT_EQ(refused.status, 1);
        EXPECT_THAT(refused.err, HasSubstr("cannot be written, Input/output error"));
        EXPECT_EQ(store.objects().at("/bucket/shadow.tif"), "old");
        const auto sent = [&](const char* method) {
            return std::ranges::count(store.requests(), method, &Request::method);
        };
        EXPECT_EQ(sent("PUT") > 0, bytes == "5000");
        EXPECT_EQ(sent("DELETE"), bytes == "5000" ? 1 : 0);  // of the parts
    }
}

TEST_F(ObjectStore, AStoreThatIsBusyIsAskedAgain) {
    std::atomic<int> refused = 0;
    ObjectStoreServer store([&](const Request&, int number) {
        if (number % 3 == 0) return Fault{};
        ++refused;
        return ObjectStoreServer::status(503);
    });
    store.put("/bucket/dem.tif", content_);
    const Result there = shadow(store, kDem, kResult);
    EXPECT_EQ(there.status, 0) << there.err;
    EXPECT_GT(refused, 2);
    EXPECT_EQ(store.objects().count("/bucket/shadow.tif"), 1u);
}

TEST_F(ObjectStore, AJobWritesItsPicturesThere) {
    ObjectStoreServer store;
    std::ofstream(dir_ / "job.json") << R"({"format": 1, "dem": {"files": [")" << bundled_dem()
                                     << R"("]}, "picture": {"size": [64, 48]},
        "time": {"at": "12:00", "date": "2026-06-21"},
        "sweep": [{"times": {"from": "10:00", "to": "12:00", "step": "1h"}}],
        "output": "/vsis3/bucket/day/{time:%H%M}.png"})";
    const std::string job = (dir_ / "job.json").string();
    const Result refused = relevo({"run", job}, environment(store));
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr("which is not below the job's own folder"));
    EXPECT_TRUE(store.requests().empty());
    const Result made = relevo({"run", job, "--trust"}, environment(store));
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(store.objects().size(), 3u);
    EXPECT_EQ(store.objects().count("/bucket/day/1100.png"), 1u);
    EXPECT_FALSE(std::filesystem::exists("/vsis3"));
    const std::string there = "/vsis3/bucket/day/{time:%H%M}.png";
    const Result again = relevo({"run", job, "-o", there}, environment(store));
    EXPECT_EQ(again.status, 3);
    EXPECT_THAT(again.err, HasSubstr("/vsis3/bucket/day/1000.png: exists, the first of 3"));
    EXPECT_EQ(relevo({"run", job, "-o", there, "--overwrite"}, environment(store)).status, 0);
}

TEST_F(ObjectStore, TimingsCountWhatTheNetWasAsked) {
    ObjectStoreServer store;
    store.put("/bucket/dem.tif", content_);
    const std::string timings = (dir_ / "t.json").string();
    const Result made = relevo(
        {"capture", kDem, "-o", (dir_ / "a.png").string(), "--size", "64x48", "--timings", timings},
        environment(store));
    ASSERT_EQ(made.status, 0) << made.err;
    const nlohmann::json net = nlohmann::json::parse(read_text(timings)).at("net");
    EXPECT_EQ(net.at("requests"), store.requests().size());
    EXPECT_NEAR(net.at("read_bytes").get<double>(), double(content_.size()), 16 * 1024);
}

// Without its mask a DEM would be another.
TEST_F(ObjectStore, NoDemIsOpenedWithoutTheAnswerWhetherItHasAMask) {
    ObjectStoreServer store([](const Request& request, int) {
        return request.path.ends_with(".msk") ? ObjectStoreServer::status(500) : Fault{};
    });
    store.put("/bucket/dem.tif", content_);
    const Result result = relevo({"info", kDem}, environment(store));
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(result.err, "relevo: error: " + kDem +
                              ".msk: cannot be asked for, HTTP response code: 500; try again\n");
}

// Each wait for an answer is as long as the other, and there were several.
TEST_F(ObjectStore, AStoreThatSaysNothingIsWaitedForOnce) {
    for (const std::string name : {"dem.tif", "index.gpkg"}) {
        ObjectStoreServer store([](const Request&, int) { return Fault{" ", 1}; });
        std::vector<std::string> impatient = environment(store);
        impatient.emplace_back("GDAL_HTTP_LOW_SPEED_TIME=2");
        const auto began = std::chrono::steady_clock::now();
        const Result result = relevo({"info", "/vsis3/bucket/" + name}, impatient);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
        EXPECT_EQ(result.status, 3);
        EXPECT_THAT(result.err, HasSubstr("/vsis3/bucket/" + name + ": cannot be asked for, "));
        EXPECT_LT(took.count(), 4);
    }
}

class BadStore : public ObjectStore, public testing::WithParamInterface<BadAnswer> {};

TEST_P(BadStore, IsNamedAndNothingIsWritten) {
    // The head of the file comes: what is lost is lost halfway.
    ObjectStoreServer store([](const Request& request, int) {
        const auto range = request.headers.find("range");
        const bool is_head =
            range == request.headers.end() || range->second.starts_with("bytes=0-");
        return request.path == "/bucket/dem.tif" && !is_head ? GetParam().fault : Fault{};
    });
    store.put("/bucket/dem.tif", content_);
    const auto began = std::chrono::steady_clock::now();
    std::vector<std::string> words{
        "sun", "shadow", kDem, "--time", "2026-12-21T15:00Z", "-o", (dir_ / "a.tif").string()};
    std::vector<std::string> impatient = environment(store);
    impatient.insert(impatient.end(), {"GDAL_HTTP_LOW_SPEED_TIME=2", "GDAL_HTTP_MAX_RETRY=1"});
    const Result result = relevo(words, impatient);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_THAT(result.err, HasSubstr(kDem + ": "));
    EXPECT_THAT(result.err, HasSubstr("; the net or the store may have failed, try again"));
    EXPECT_LT(took.count(), 20);
    EXPECT_FALSE(std::filesystem::exists(dir_ / "a.tif"));
}

INSTANTIATE_TEST_SUITE_P(ObjectStore, BadStore, testing::ValuesIn(bad_answers()),
                         [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace relevo::test::test_object_store

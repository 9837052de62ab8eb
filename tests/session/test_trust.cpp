// No field of a scene, a job or a picture's record asks the net, however its name is written.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "effect/preset.h"
#include "scene/job.h"
#include "scene/options.h"
#include "session/active_effects.h"
#include "session/session.h"
#include "session/trust.h"
#include "support/change.h"
#include "support/counting_server.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::session::test_trust {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::array<std::string, 10> spellings(const std::string& address) {
    const std::string host = address.substr(address.find("//") + 2);
    return {address + "/x.tif",
            "/vsicurl/" + address + "/x.tif",
            "/vsicurl?url=" + address + "/x.tif",
            "/vsizip//vsicurl/" + address + "/x.zip/x.tif",
            "/vsizip/vsicurl/" + address + "/x.zip/x.tif",
            "/vsigzip/{/vsicurl/" + address + "/x.gz}",
            "/vsisubfile/0_9,/vsicurl/" + address + "/x.tif",
            "vrt://" + address + "/x.tif",
            "WMTS:" + address,
            fmt::format("NETCDF:\"{}/x.nc\":z", address)};
}

const std::filesystem::path& own() {
    static const std::filesystem::path folder = test::source_dir() / "tests/data/own";
    return folder;
}

json scene_json() {
    return {{"format", 1},
            {"dem", {{"files", {"d.tif"}}}},
            {"time", {{"at", "2026-06-21T14:00Z"}}},
            {"effects", {{"only", json::array()}}},
            {"picture", {{"size", {32, 32}}}}};
}

/// Reads a scene and opens what it names, as `capture --scene` does.
std::string error_of(const json& text, Session& session) {
    return test::error_of([&] {
        const scene::Scene scene = scene::read_scene_text(text.dump(), "s.json", own());
        Trust({}, "s.json", NamedBy::File).check_names(scene);
        test::set_effects(session, scene.effects);
    });
}

class Names : public testing::Test {
  protected:
    void expect_refused(const json& text, const std::string& what) {
        EXPECT_THAT(error_of(text, session_), HasSubstr("is not a file of this machine")) << what;
        ++generated_;
    }
    /// Refused, or no name of a file: then nothing is asked for.
    void expect_nothing_asked(const json& text) {
        error_of(text, session_);
        ++generated_;
    }

    const test::CountingServer server_;
    FilesInUse files_;
    Session session_{scene::read_scene_text(scene_json().dump(), "s.json", own()),
                     {.device = test::gl_device()},
                     files_};
    int generated_ = 0;
};

TEST_F(Names, OfFilesAskNoNet) {
    for (const std::string& name : spellings(server_.address())) {
        json text = scene_json();
        text["dem"]["files"] = {"d.tif", name};
        expect_refused(text, "dem.files");
        text = scene_json();
        text["overlay"] = {{"file", name}};
        expect_refused(text, "overlay.file");
        text["overlay"] = {{"file", "slope.tif"}, {"colours", name}};
        expect_refused(text, "overlay.colours");
        text = scene_json();
        text["effects"]["presets"] = {name.find('/') == name.npos ? name + "/a.json" : name};
        expect_refused(text, "effects.presets");
        text = scene_json();
        text["effects"]["plugin_path"] = {name};
        expect_nothing_asked(text);
        for (const scene::Option& option : scene::options()) {
            if (option.kind != scene::Option::Kind::Text) continue;
            text = scene_json();
            const std::string key(option.key), object(option.object);
            (object.empty() ? text : text[object])[key] = name;
            if (key == "land_cover" || key == "land_cover_classes")
                expect_refused(text, key);
            else
                expect_nothing_asked(text);
        }
    }
    EXPECT_GE(generated_, 90);
    EXPECT_EQ(server_.asked(), 0);
}

TEST_F(Names, OfEveryFileParameterAskNoNet) {
    const std::vector<const shader::TextParam*> texts = session_.effects().values.texts();
    for (const shader::TextParam* text : texts) {
        if (!text->is_file) continue;
        const std::string id = text->address.substr(0, text->address.find('.'));
        for (const std::string& name : spellings(server_.address())) {
            json scene = scene_json();
            scene["effects"] = {{"only", {id}}, {"set", {{text->address, name}}}};
            const std::string error = error_of(scene, session_);
            EXPECT_NE(error, "") << text->address << " " << name;
            ++generated_;
        }
    }
    EXPECT_GE(generated_, 100);
    EXPECT_EQ(server_.asked(), 0);
}

TEST_F(Names, OfAPresetAskNoNet) {
    const std::filesystem::path preset = test::scratch_dir("trust") / "p.json";
    for (const std::string& name : spellings(server_.address())) {
        std::ofstream(preset) << json{{"enable", {"drape"}}, {"set", {{"drape.file", name}}}};
        json scene = scene_json();
        scene["effects"] = {{"presets", {preset.string()}}};
        EXPECT_NE(error_of(scene, session_), "") << name;
    }
    EXPECT_EQ(server_.asked(), 0);
}

TEST(Own, ScenesOpenAndDraw) {
    int drawn = 0;
    for (const auto& entry : std::filesystem::directory_iterator(own())) {
        const std::filesystem::path& file = entry.path();
        if (!file.filename().string().starts_with("scene_")) continue;
        const scene::Scene scene = scene::read_scene(file);
        Trust({}, file.string(), NamedBy::File).check_names(scene);
        FilesInUse files;
        Session session(scene, {.device = test::gl_device()}, files);
        session.draw();
        EXPECT_EQ(session.picture().width, 96) << file;
        ++drawn;
    }
    EXPECT_EQ(drawn, 8);
}

}  // namespace
}  // namespace relevo::session::test_trust

// Each option of scene::options() is one for the command line, for JSON and in the schema.
#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "cli/scene_arguments.h"
#include "scene/options.h"
#include "support/support.h"

namespace relevo::cli::test_scene_options {
namespace {

using nlohmann::ordered_json;
using scene::Option;
using scene::Scene;
using Kind = Option::Kind;

bool is_number(const Option& option) {
    return option.kind == Kind::Number || option.kind == Kind::Whole;
}

/// The scene of a line with an option and a value. @throws CLI::ParseError
Scene from_line(const Option& option, const std::string& value) {
    CLI::App app;
    SceneArguments arguments;
    arguments.add_to(Verb(app));
    std::vector<std::string> words{"a.tif", "--overlay", "b.tif", std::string(option.flag)};
    if (option.kind != Kind::Flag) words.back() += "=" + value;
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(words);
    return arguments.scene();
}

/// The scene of a file with an option and a value. @throws Error
Scene from_file(const Option& option, const std::string& value) {
    ordered_json json = {
        {"format", 1}, {"dem", {{"files", {"a.tif"}}}}, {"overlay", {{"file", "b.tif"}}}};
    ordered_json& object = option.object.empty() ? json : json[std::string(option.object)];
    const bool quoted = option.kind == Kind::Word || option.kind == Kind::Text;
    object[std::string(option.key)] =
        quoted || value == "x" ? ordered_json(value) : ordered_json::parse(value);
    return scene::read_scene_text(json.dump(), "s.json", "");
}

/// A value that is not the default.
std::string other_value(const Option& option) {
    if (option.kind == Kind::Word) return std::string(option.words.back());
    if (option.key == "weather") return "LSZB 011150Z 24009KT CAVOK 17/13 Q1014";
    if (option.kind == Kind::Text) return "a text";
    if (option.kind == Kind::Whole) return "7";
    if (option.kind == Kind::Flag)
        return scene::text_of(option, Scene()) == "true" ? "false" : "true";
    return fmt::format("{}", option.min + (option.max - option.min) / 4);
}

TEST(SceneOptions, AreReadFromALineAndAFileAndWrittenAgain) {
    for (const Option& option : scene::options()) {
        SCOPED_TRACE(option.flag);
        const std::string value = other_value(option);
        EXPECT_TRUE(scene::is_default(option, Scene()));
        for (const Scene& scene : {from_line(option, value), from_file(option, value)}) {
            EXPECT_EQ(scene::text_of(option, scene), value);
            EXPECT_FALSE(scene::is_default(option, scene));
            const Scene back = scene::read_scene_text(scene::scene_line(scene), "s.json", "");
            EXPECT_EQ(scene::text_of(option, back), value);
        }
    }
}

TEST(SceneOptions, AreRefusedInTheSameWordsFromALineAndAFile) {
    for (const Option& option : scene::options()) {
        if (!is_number(option) && option.kind != Kind::Word) continue;
        std::vector<std::string> wrong{"x"};
        if (is_number(option)) {
            for (const double end : {option.min, option.max}) {
                EXPECT_NO_THROW(from_line(option, fmt::format("{}", end))) << option.flag;
                EXPECT_NO_THROW(from_file(option, fmt::format("{}", end))) << option.flag;
            }
            wrong.push_back(fmt::format("{}", option.min - 1));
            wrong.push_back(fmt::format("{}", option.max + 1));
        }
        if (option.kind == Kind::Whole) wrong.emplace_back("1.5");
        for (const std::string& value : wrong) {
            SCOPED_TRACE(fmt::format("{} {}", option.flag, value));
            const std::string fault = scene::fault_of(option, scene::value_of(option, value));
            EXPECT_THAT(fault, testing::StartsWith("expected "));
            std::string of_line;
            try {
                from_line(option, value);
            } catch (const CLI::ParseError& error) {
                of_line = error.what();
            }
            EXPECT_EQ(of_line, fmt::format("{}: {}", option.flag, fault));
            EXPECT_THAT(test::error_of([&] { from_file(option, value); }),
                        testing::EndsWith(fmt::format("{}: {}", option.key, fault)));
        }
    }
}

TEST(SceneOptions, ADefaultOnTheLineReplacesWhatASceneSays) {
    const std::string path = (test::scratch_dir() / "scene.json").string();
    std::ofstream(path) << R"({"format": 1, "dem": {"files": ["a.tif"], "memory_mib": 77,
                               "encoding": "terrarium"}})";
    CLI::App app;
    SceneArguments arguments;
    arguments.add_to(Verb(app));
    app.parse(fmt::format("--scene {} --memory 3072 --encoding none", path));
    const Scene scene = arguments.scene();
    EXPECT_EQ(scene.dem.memory.mib(), MemoryBudget::kDefault_mib);
    EXPECT_EQ(scene.dem.encoding, dem::Encoding::None);
}

ordered_json schema_of(const Option& option) {
    ordered_json json = {{"description", option.help}};
    const auto end_of_range = [&](double end) {
        return end == std::floor(end) ? ordered_json(static_cast<std::int64_t>(end))
                                      : ordered_json(end);
    };
    if (is_number(option)) {
        json["type"] = option.kind == Kind::Whole ? "integer" : "number";
        json["minimum"] = end_of_range(option.min);
        json["maximum"] = end_of_range(option.max);
    } else if (option.kind == Kind::Word) {
        json["enum"] = option.words;
    } else if (option.kind == Kind::Flag) {
        json["type"] = "boolean";
    } else {
        json["type"] = "string";
        json["minLength"] = 1;
    }
    return json;
}

/// With RELEVO_WRITE_SCHEMA=1 in the environment the files are written instead of compared.
TEST(SceneOptions, AreThoseOfTheSchemas) {
    const std::filesystem::path docs = test::source_dir() / "docs";
    const std::filesystem::path scene_file = docs / "scene.schema.json",
                                job_file = docs / "job.schema.json";
    ordered_json scene = ordered_json::parse(read_text(scene_file, "test")),
                 job = ordered_json::parse(read_text(job_file, "test"));
    for (const Option& option : scene::options()) {
        const std::string object(option.object), key(option.key);
        ordered_json& definitions = scene["$defs"];
        if (!object.empty()) {
            definitions[object]["properties"][key] = schema_of(option);
            if (object == "camera")
                job["$defs"]["named_camera"]["properties"][key]["$ref"] =
                    "scene.schema.json#/$defs/camera/properties/" + key;
            continue;
        }
        definitions[key] = schema_of(option);
        scene["properties"][key]["$ref"] = "#/$defs/" + key;
        for (ordered_json* const holder : {&job, &job["$defs"]["shot"]})
            (*holder)["properties"][key]["$ref"] = "scene.schema.json#/$defs/" + key;
    }
    for (const auto& [path, json] : {std::pair(scene_file, scene), {job_file, job}}) {
        const std::string text = json.dump(1) + "\n";
        if (std::getenv("RELEVO_WRITE_SCHEMA")) std::ofstream(path) << text;
        EXPECT_EQ(read_text(path, "test"), text) << "RELEVO_WRITE_SCHEMA=1 writes it";
    }
}

}  // namespace
}  // namespace relevo::cli::test_scene_options

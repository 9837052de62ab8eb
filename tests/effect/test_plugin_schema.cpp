// docs/plugin.schema.json has the keys that the loader takes, and no others.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/text.h"
#include "effect/plugins.h"
#include "json/value.h"

namespace relevo::effect::test::test_plugin_schema {
namespace {

using relevo::test::error_of;

const json::Value& member(const json::Value& value, std::string_view name) {
    for (const auto& [key, inner] : value.members)
        if (key == name) return inner;
    throw std::runtime_error(fmt::format("no member {}", name));
}

std::vector<std::string> keys(const json::Value& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : member(object, "properties").members)
        names.push_back(key);
    return names;
}

/// The keys that the loader lists for an unknown one.
std::vector<std::string> known_keys(const std::string& members) {
    const Plugins plugins;
    plugins.add("dust", members);
    const std::string error =
        error_of([&] { load_effect(plugins.plugins() / "dust", plugins.data()); });
    const std::size_t list = error.find("there are ");
    if (list == std::string::npos) return {error};
    std::vector<std::string> names;
    for (const std::string& name : split(error.substr(list + 10), ','))
        names.emplace_back(trimmed(name));
    return names;
}

TEST(PluginSchema, HasTheLoadersKeys) {
    using ::testing::UnorderedElementsAreArray;
    const auto file = relevo::test::source_dir() / "docs/plugin.schema.json";
    const json::Value schema = json::parse("test", "schema", read_text(file, "test"));
    const json::Value& objects = member(schema, "definitions");
    const json::Value& properties = member(schema, "properties");
    const std::string unknown = R"("qqqqqqqqqqqq": 0)";
    EXPECT_THAT(keys(schema), UnorderedElementsAreArray(known_keys(unknown)));
    EXPECT_THAT(keys(member(properties, "displaces")),
                UnorderedElementsAreArray(known_keys(R"("displaces": {)" + unknown + "}")));
    EXPECT_THAT(keys(member(properties, "invents")),
                UnorderedElementsAreArray(
                    known_keys(R"("invents": {"what": "w", "by": "b", )" + unknown + "}")));
    EXPECT_THAT(keys(member(properties, "weather")),
                UnorderedElementsAreArray(known_keys(R"("weather": {)" + unknown + "}")));
    const std::string sizes = R"("spacing_m": 1, "height_m": 1)";
    EXPECT_THAT(keys(member(objects, "instances")),
                UnorderedElementsAreArray(
                    known_keys(R"("instances": {"a": {"levels": [{"meshes": ["dust.glsl"]}], )" +
                               sizes + ", " + unknown + "}}")));
    EXPECT_THAT(keys(member(objects, "instance_level")),
                UnorderedElementsAreArray(
                    known_keys(R"("instances": {"a": {"levels": [{"meshes": ["dust.glsl"], )" +
                               unknown + "}], " + sizes + "}}")));
    EXPECT_THAT(keys(member(objects, "text")),
                UnorderedElementsAreArray(
                    known_keys(R"("module": "dust", "texts": {"a": {)" + unknown + "}}")));
    EXPECT_THAT(keys(member(objects, "marks")),
                UnorderedElementsAreArray(
                    known_keys(R"("marks": {"a": {"from": "file", )" + unknown + "}}")));
    // Each kind of pass takes some of these.
    EXPECT_THAT(keys(member(objects, "pass")),
                UnorderedElementsAreArray(known_keys(R"("passes": {"a": {)" + unknown + "}}")));
    // Each kind of texture takes some of these.
    std::vector<std::string> texture =
        known_keys(R"("textures": {"a": {"kind": "3d", "file": "dust.glsl", "encoding": "srgb", )" +
                   unknown + "}}");
    texture.emplace_back("files");
    EXPECT_THAT(keys(member(objects, "file_texture")), UnorderedElementsAreArray(texture));
    EXPECT_THAT(keys(member(objects, "raster")),
                UnorderedElementsAreArray(known_keys(
                    R"("textures": {"a": {"kind": "raster", "from": "file", )" + unknown + "}}")));
    EXPECT_THAT(keys(member(objects, "field")),
                UnorderedElementsAreArray(known_keys(
                    R"("textures": {"a": {"kind": "field", "from": "file", )" + unknown + "}}")));
    EXPECT_THAT(keys(member(objects, "lines")),
                UnorderedElementsAreArray(known_keys(
                    R"("textures": {"a": {"kind": "lines", "from": "file", )" + unknown + "}}")));
    EXPECT_THAT(
        keys(member(objects, "table")),
        UnorderedElementsAreArray(known_keys(
            R"("textures": {"a": {"kind": "table", "file": "dust.glsl", )" + unknown + "}}")));
}

}  // namespace
}  // namespace relevo::effect::test::test_plugin_schema

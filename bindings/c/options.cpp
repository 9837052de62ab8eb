#include "options.h"

#include <utility>

#include "scene/scene_reader.h"

namespace relevo::c {
namespace {

constexpr const char* kText = "(text)";  // in the place of a file's name

void take(scene::Scene& scene, const json::Value& value, const std::filesystem::path& folder) {
    const scene::SceneReader reader("scene", kText, folder);
    json::ObjectReader object("scene", kText, "", value);
    object.number("format", 1, 1, 1, true);
    reader.take(object, "", scene);
    object.finish();
}

}  // namespace

Options::Options(const char* text, const std::string& who)
    : value_(json::parse(who, "options", text ? text : "{}")),
      reader_(who, "options", "", value_) {}

void change_scene(scene::Scene& scene, const char* text, const std::filesystem::path& folder) {
    if (text) take(scene, json::parse("scene", kText, text), folder);
}

void change_dem(scene::Scene& scene, const char* text) {
    if (!text) return;
    json::Value whole;
    whole.kind = json::Value::Kind::Object;
    whole.line = 1;
    whole.members.emplace_back("dem", json::parse("dem", kText, text));
    take(scene, whole, {});
}

}  // namespace relevo::c

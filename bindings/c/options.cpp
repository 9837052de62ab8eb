#include "options.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/allowed_name.h"
#include "base/contains.h"
#include "base/error.h"
#include "scene/options.h"
#include "scene/scene_reader.h"
#include "session/scene_times.h"

namespace relevo::c {
namespace {

constexpr const char* kText = "(text)";  // in the place of a file's name

/// By the library's contract a scene's names are the caller's own.
void allow_names(const json::Value& value) {
    if (is_remote(value.text)) allow_name(value.text);
    for (const json::Value& item : value.items)
        allow_names(item);
    for (const auto& [key, member] : value.members)
        allow_names(member);
}

void take(scene::Scene& scene, const json::Value& value, const std::filesystem::path& folder) {
    allow_names(value);
    const scene::SceneReader reader("scene", kText, folder);
    json::ObjectReader object("scene", kText, "", value);
    object.number("format", 1, 1, 1, true);
    reader.take(object, "", scene);
    object.finish();
    scene = scene::with_absolute_paths(std::move(scene));
}

}  // namespace

Options::Options(const char* text, const std::string& who)
    : value_(json::parse(who, "options", text ? text : "{}", kMaxBytes)),
      reader_(who, "options", "", value_) {}

void change_scene(scene::Scene& scene, const char* text, const std::filesystem::path& folder) {
    if (text) take(scene, json::parse("scene", kText, text), folder);
}

std::string refraction_name(const std::string& name, const std::string& who) {
    const scene::Option& option = scene::option("--refraction");
    const std::string fault = scene::fault_of(option, scene::value_of(option, name));
    if (!fault.empty()) bad_input(fmt::format("{}refraction: {}", who, fault));
    return name;
}

json::Value take_members(json::Value& object, const std::vector<std::string>& names) {
    json::Value own;
    own.kind = json::Value::Kind::Object;
    const auto is_own = [&](const auto& member) { return contains(names, member.name); };
    std::ranges::copy_if(object.members, std::back_inserter(own.members), is_own);
    std::erase_if(object.members, is_own);
    return own;
}

json::Value parse_dem(const char* text) {
    return json::parse("dem", kText, text ? text : "{}");
}

scene::Scene read_dem(const std::vector<std::string>& files, const char* text) {
    return read_dem(files, parse_dem(text));
}

scene::Scene read_dem(const std::vector<std::string>& files, json::Value dem) {
    json::Value list;
    list.kind = json::Value::Kind::Array;
    for (const std::string& file : files) {
        json::Value& item = list.items.emplace_back();
        item.kind = json::Value::Kind::String;
        item.text = file;
    }
    if (dem.kind == json::Value::Kind::Object) dem.members.push_back({"files", std::move(list)});
    const json::Value own = take_members(dem, {"surroundings"});
    allow_names(own);
    json::Value whole;
    whole.kind = json::Value::Kind::Object;
    whole.members.push_back({"dem", std::move(dem)});
    scene::Scene scene;
    take(scene, whole, {});
    scene.dem.surroundings = json::ObjectReader("dem", kText, "", own).strings("surroundings");
    return scene;
}

bool same_dem(scene::Scene a, scene::Scene b) {
    b.holes = a.holes;
    a.overlay = b.overlay = {};  // part of what a session opens, not of the DEM
    return session::dem_key(a) == session::dem_key(b);
}

}  // namespace relevo::c

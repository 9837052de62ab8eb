#include "effect/new_plugin.h"

#include <cctype>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"

namespace relevo::effect {
namespace {

constexpr std::string_view kNewPluginWho = "plugins new";

/// Replaces @ID@ and @NAME@.
std::string filled(std::string text, const std::string& id) {
    const auto replace = [&](std::string_view word, const std::string& value) {
        for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos;
             at += value.size())
            text.replace(at, word.size(), value);
    };
    replace("@ID@", id);
    replace("@NAME@", name_of(id));
    return text;
}

constexpr const char* kManifest = R"({
  "format": 1,
  "id": "@ID@",
  "name": "@NAME@",
  "description": "A film of dust on flat ground",
  "version": "1.0.0",@MODULE@
  "after": ["materials"]
}
)";

constexpr const char* kGlsl = R"(//! provides  @ID@: a film of dust on flat ground
//! hook      material
//! reads     normal, vertical
//! writes    diffuse, ambient, specular

uniform float @ID@_amount = 0.5;                  //@ range(0, 1) label("Amount") description("Share of level ground that dust hides")
uniform vec3 @ID@_tint = vec3(0.55, 0.45, 0.33);  //@ colour label("Colour")

void @ID@_on_material(inout Surface s) {
    float cover = @ID@_amount * max(dot(s.normal, s.up), 0.0);
    s.diffuse = mix(s.diffuse, @ID@_tint, cover);  // for the sun ...
    s.ambient = mix(s.ambient, @ID@_tint, cover);  // ... and for the light of the sky
    s.specular *= 1.0 - cover;
}
)";

constexpr const char* kNativeGlsl =
    R"(//! provides  @ID@: a film of dust on flat ground, thinner while the sun is high
//! hook      material
//! reads     normal, vertical, @ID@.now of @ID@.cpp
//! writes    diffuse, ambient, specular

uniform float @ID@_amount = 0.5;                  //@ range(0, 1) label("Amount") description("Share of level ground that dust hides at sunrise")
uniform vec3 @ID@_tint = vec3(0.55, 0.45, 0.33);  //@ colour label("Colour")
uniform float @ID@_now = 0.0;                     //@ host

void @ID@_on_material(inout Surface s) {
    float cover = @ID@_now * max(dot(s.normal, s.up), 0.0);
    s.diffuse = mix(s.diffuse, @ID@_tint, cover);  // for the sun ...
    s.ambient = mix(s.ambient, @ID@_tint, cover);  // ... and for the light of the sky
    s.specular *= 1.0 - cover;
}
)";

constexpr const char* kModule =
    R"(// c++ -std=c++20 -shared -fPIC -I include @ID@.cpp -o @ID@.so
// `include` is that of an installation of Relevo or of its repository.
#include <algorithm>

#include <relevo/plugin.hpp>

namespace {

using namespace relevo::plugin;

/// Writes the parameter @ID@.now for every frame.
class @NAME@Module : public Instance {
  public:
    explicit @NAME@Module(const Host& host) : params_(host), frame_(host) {}

    void prepare() override {
        const double height = std::max(frame_.get().sun[2], 0.0);  // sine of the sun's elevation
        params_.set("@ID@.now", {params_.get("@ID@.amount") * (1.0 - 0.5 * height), 0, 0, 0});
    }

  private:
    Params params_;
    Frame frame_;
};

}  // namespace

RELEVO_PLUGIN("@ID@", @NAME@Module)
)";

constexpr const char* kReadme = R"(# @NAME@

A film of dust on flat ground.

## Equation

    diffuse = mix(diffuse, tint, amount max(normal . vertical, 0))

Source: name it here.

## Limits

- Name them here.

)";

constexpr const char* kUsage = R"(## Use

    relevo capture dem.tif -o picture.png --plugin-path .@ENABLE@ --set @ID@.PARAMETER=VALUE
    relevo plugins info @ID@ --plugin-path .   # the parameters
    relevo plugins check .                     # finds mistakes
    relevo plugins test . --update             # writes golden.png, the picture to compare with
    relevo plugins test .                      # compares with golden.png
)";

constexpr const char* kBuild = R"(## Build

    c++ -std=c++20 -shared -fPIC -I include @ID@.cpp -o @ID@.so

`include` is that of an installation of Relevo or of its repository.

)";

PluginFiles template_of(const NewPlugin& plugin) {
    const auto text = [&](std::string from) {
        const std::string_view mark = "@MODULE@";
        if (const std::size_t at = from.find(mark); at != std::string::npos)
            from.replace(at, mark.size(), plugin.native ? "\n  \"module\": \"@ID@\"," : "");
        return filled(std::move(from), plugin.id);
    };
    PluginFiles files{{"plugin.json", text(kManifest)},
                      {plugin.id + ".glsl", text(plugin.native ? kNativeGlsl : kGlsl)},
                      {"README.md", text(kReadme) + (plugin.native ? text(kBuild) : "") +
                                        usage_section(plugin.id, /*is_on=*/true)}};
    if (plugin.native) files.emplace_back(plugin.id + ".cpp", text(kModule));
    return files;
}

void check(const NewPlugin& plugin, const Registry& registry) {
    if (const std::string fault = fault_of_id(plugin.id); !fault.empty())
        bad_input(fmt::format("{}: {}: {}", kNewPluginWho, plugin.id, fault));
    if (const Effect* const taken = registry.find(plugin.id))
        bad_input(fmt::format("{}: {}: this id is taken by {}; choose another", kNewPluginWho,
                              plugin.id, taken->manifest.folder.string()));
    if (plugin.copied.empty()) return;
    if (plugin.native)
        bad_usage(
            fmt::format("{}: --native and --from exclude each other; use one", kNewPluginWho));
    const Effect& effect = registry.effect(plugin.copied, kNewPluginWho);
    if (!effect.manifest.module.empty())
        bad_input(
            fmt::format("{}: {}: a native plugin cannot be copied; write --native for a new "
                        "one",
                        kNewPluginWho, plugin.copied));
}

/// Creates a folder, which must be new.
void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    if (folder.has_parent_path()) std::filesystem::create_directories(folder.parent_path(), error);
    const bool is_new = !error && std::filesystem::create_directory(folder, error);
    if (!is_new && (!error || error == std::errc::file_exists))
        bad_input(fmt::format("{}: {}: exists already; choose another id or --into", kNewPluginWho,
                              folder.string()));
    if (error)
        bad_input(fmt::format("{}: {}: the folder cannot be created, {}", kNewPluginWho,
                              folder.string(), error.message()));
}

}  // namespace

std::string name_of(std::string id) {
    id.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(id.front())));
    return id;
}

std::string usage_section(const std::string& id, bool is_on) {
    std::string text = kUsage;
    const std::string_view mark = "@ENABLE@";
    text.replace(text.find(mark), mark.size(), is_on ? "" : " --enable @ID@");
    return filled(std::move(text), id);
}

std::vector<std::filesystem::path> write_new_plugin(const NewPlugin& plugin,
                                                    const std::filesystem::path& into,
                                                    const Registry& registry) {
    namespace fs = std::filesystem;
    check(plugin, registry);
    const PluginFiles files =
        plugin.copied.empty()
            ? template_of(plugin)
            : copied_plugin(plugin.id, registry.effect(plugin.copied, kNewPluginWho));
    const fs::path folder = into / plugin.id;
    make_folder(folder);
    std::vector<fs::path> written;
    try {
        for (const auto& [name, text] : files) {
            written.push_back(folder / name);
            write_text(written.back(), text, /*overwrite=*/false, kNewPluginWho);
        }
    } catch (const Error&) {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
        throw;
    }
    return written;
}

}  // namespace relevo::effect

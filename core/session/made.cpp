#include "session/made.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/local_copy.h"
#include "base/output_file.h"
#include "base/sha256.h"
#include "base/text.h"
#include "image/image.h"
#include "scene/sheet.h"
#include "session/picture_file.h"
#include "session/record.h"

namespace relevo::session {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Keys of SceneInputs::record(), and the message if their values differ.
constexpr std::array kChanges{std::pair("dem", "the DEM has changed"),
                              std::pair("overlay", "the overlay has changed"),
                              std::pair("colours", "the colour file has changed"),
                              std::pair("weather", "the weather has changed"),
                              std::pair("land_cover", "the land cover has changed"),
                              std::pair("presets", "the preset has changed"),
                              std::pair("plugins", "a plugin has changed"),
                              std::pair("files", "a file that it was made from has changed")};

/// Message on how two records differ; empty if they do not.
std::string difference(const std::string& before, const std::string& now) {
    if (before == now) return {};
    const auto parsed = [](const std::string& text) {
        return ordered_json::parse(shallow_json(text), nullptr, /*allow_exceptions=*/false);
    };
    const ordered_json a = parsed(before), b = parsed(now);
    if (!a.is_object()) return "it does not record its inputs";
    if (a.value("relevo", ordered_json()) != b.value("relevo", ordered_json()))
        return fmt::format("Relevo {} made it, and this is {}",
                           printable(a.value("relevo", ordered_json("?")).dump()),
                           b.value("relevo", ordered_json()).dump());
    for (const auto& [key, change] : kChanges)
        if (a.value(key, ordered_json()) != b.value(key, ordered_json())) return change;
    return "it was made from other files";
}

std::string fault_of_picture(const scene::Shot& shot, const Wanted& wanted) {
    try {
        const LocalCopy file(shot.output, "--resume");
        const image::Metadata metadata = image::read_metadata(file.path());
        const auto text = [&](const char* keyword) {
            const auto found = metadata.find(keyword);
            return found == metadata.end() ? std::string() : found->second;
        };
        const std::string line = scene::whole_scene_line(shot.scene), scene = text(kSceneKeyword),
                          digest = text(kSceneDigestKeyword);
        if (scene.empty() && digest.empty()) return "it contains no scene";
        if (metadata.contains(kComparedKeyword) ||
            (scene.empty() ? digest != sha256_of_text(line) : scene != line))
            return "it shows another scene";
        if (std::string why = difference(text(kInputsKeyword), wanted.record); !why.empty())
            return why;
        if (text(kFormatKeyword) != wanted.format) return "it has other bits, quality or layers";
        if (scene::is_pdf(shot.output)) return {};  // files appear only when they are whole
        const image::Image8 picture = image::read(file.path());
        if (picture.width == shot.scene.width_px && picture.height == shot.scene.height_px)
            return {};
    } catch (const Error&) {
        // Not an image, or a truncated one.
    }
    return "it is not a complete picture";
}

std::string fault_of_sidecar(const scene::Shot& shot, const Wanted& wanted) {
    std::error_code ignored;
    const LocalCopy file(sidecar_of(shot.output), "--resume");
    const fs::path& path = file.path();
    if (!fs::is_regular_file(path, ignored)) return "its sidecar is not a file";
    std::string content;
    try {
        content = read_text(path, "--sidecar");
    } catch (const Error&) {
        return "its sidecar cannot be read";
    }
    const auto json = ordered_json::parse(shallow_json(content), nullptr, false);
    if (!json.is_object() || !json.contains("scene")) return "its sidecar is incomplete";
    const auto text = [](const ordered_json& value) {
        return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    };
    if (text(json["scene"]) != scene::whole_scene_line(shot.scene))
        return "its sidecar is of another scene";
    if (std::string why =
            difference(json.contains("inputs") ? text(json["inputs"]) : "", wanted.record);
        !why.empty())
        return "its sidecar: " + why;
    if (wanted.audited && !json.contains("audit")) return "its sidecar has no audit";
    return {};
}

}  // namespace

OnDisk on_disk(const scene::Shot& shot, const Wanted& wanted) {
    const bool picture = is_taken(shot.output),
               sidecar = wanted.sidecar && is_taken(sidecar_of(shot.output));
    if (!picture && !sidecar) return {};
    std::string why;
    if (sidecar) why = fault_of_sidecar(shot, wanted);
    if (picture && why.empty()) why = fault_of_picture(shot, wanted);
    if (!why.empty()) return {OnDisk::State::Other, std::move(why)};
    const bool all = picture && sidecar == wanted.sidecar &&
                     std::ranges::all_of(files_beside(shot.scene, shot.output), is_taken);
    return {all ? OnDisk::State::Whole : OnDisk::State::Part, {}};
}

}  // namespace relevo::session

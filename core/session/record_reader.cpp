#include "session/record_reader.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/sha256.h"
#include "base/text.h"

namespace relevo::session {

using nlohmann::ordered_json;

std::filesystem::path sidecar_of(std::filesystem::path picture) {
    return picture += ".json";
}

std::string shallow_json(const std::string& text) {
    constexpr int kDeepest = 32;
    const auto json = ordered_json::parse(
        text, [](int depth, auto, const auto&) { return depth <= kDeepest; },
        /*allow_exceptions=*/false);
    return json.is_discarded() ? std::string()
                               : json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

image::Metadata read_record(const std::filesystem::path& picture) {
    image::Metadata metadata = image::read_metadata(picture);
    const auto digest = metadata.find(kSceneDigestKeyword);
    if (metadata.contains(kSceneKeyword) || digest == metadata.end()) return metadata;
    const std::filesystem::path sidecar = sidecar_of(picture);
    const auto refuse = [&](const char* why) {
        bad_input(fmt::format("{}: its scene is in {}, which {}; put the picture's own file there",
                              printable(picture.string()), printable(sidecar.string()), why));
    };
    std::error_code ignored;
    if (!std::filesystem::exists(sidecar, ignored)) refuse("is missing");
    const auto json =
        ordered_json::parse(shallow_json(read_text(sidecar, "sidecar")), nullptr, false);
    if (!json.is_object() || !json.contains("scene")) refuse("is not a sidecar");
    const std::string line =
        json["scene"].dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    if (sha256_of_text(line) != digest->second) refuse("has another scene");
    metadata[kSceneKeyword] = line;
    return metadata;
}

}  // namespace relevo::session

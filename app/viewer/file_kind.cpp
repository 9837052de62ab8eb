#include "viewer/file_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "dem/placement.h"
#include "dem/tile_index.h"
#include "image/image.h"
#include "overlay/band_over.h"
#include "overlay/camera_photo.h"
#include "overlay/photo.h"
#include "session/overlay_time.h"
#include "session/record.h"

namespace relevo::viewer {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 5> kVectors = {".kml", ".shp", ".fgb", ".gpkg", ".tab"};

/// The member "type" of an object; empty: none.
std::string type_of(const json& object) {
    const auto type = object.is_object() ? object.find("type") : object.end();
    return object.is_object() && type != object.end() && type->is_string()
               ? type->get<std::string>()
               : "";
}

std::string geometry_of_feature(const json& feature) {
    return feature.is_object() && feature.contains("geometry") ? type_of(feature["geometry"]) : "";
}

/// The first geometry of a GeoJSON; empty: none.
std::string geometry_of(const json& object) {
    const std::string type = type_of(object);
    if (type == "Feature") return geometry_of_feature(object);
    if (type != "FeatureCollection") return type;
    if (!object.contains("features")) return "";
    for (const json& feature : object["features"])
        if (const std::string geometry = geometry_of_feature(feature); !geometry.empty())
            return geometry;
    return "";
}

FileKind kind_of_json(const std::string& path) {
    const json object = json::parse(read_text(path, "open"), nullptr, /*allow_exceptions=*/false);
    if (!object.is_object()) return FileKind::Scene;  // whose reader says what is wrong
    if (!type_of(object).empty()) {
        const std::string geometry = geometry_of(object);
        return geometry.ends_with("Point") ? FileKind::Places : FileKind::Lines;
    }
    const auto has = [&](const char* key) { return object.contains(key); };
    return has("sweep") || has("shots") || has("output") || has("scene") ? FileKind::Job
                                                                         : FileKind::Scene;
}

FileKind kind_of_gpx(const std::string& path) {
    const std::string text = read_text(path, "open");
    const auto has = [&](const char* tag) { return text.find(tag) != std::string::npos; };
    return has("<trkpt") || has("<rtept") ? FileKind::Lines : FileKind::Places;
}

bool has_record(const std::string& path) {
    if (!image::is_picture_name(path)) return false;
    try {
        const image::Metadata metadata = image::read_metadata(path);
        return metadata.contains(session::kSceneKeyword) ||
               metadata.contains(session::kSceneDigestKeyword);
    } catch (const Error&) {
        return false;
    }
}

FileKind kind_of_raster(const std::string& path) {
    if (has_record(path)) return FileKind::Picture;
    if (dem::web_tile(path)) return FileKind::Dem;
    const std::optional<overlay::CameraPhoto> photo = overlay::camera_photo(path);
    if (photo && photo->place) return FileKind::Photograph;
    if (overlay::photo_kind(path) != overlay::PhotoKind::None) return FileKind::Overlay;
    return session::overlay_time(overlay::band_metadata(path, 1)) ? FileKind::Overlay
                                                                  : FileKind::Dem;
}

}  // namespace

bool is_name_of_layer(const std::string& path) {
    const std::string ending = lower(std::filesystem::path(path).extension().string());
    constexpr std::array<std::string_view, 4> kOthers = {".json", ".geojson", ".gpx", ".csv"};
    return contains(kVectors, std::string_view(ending)) ||
           contains(kOthers, std::string_view(ending)) || image::is_picture_name(path);
}

bool is_raster_file(const std::string& path) {
    try {
        overlay::photo_kind(path);
        return true;
    } catch (const Error&) {
        return false;
    }
}

FileKind kind_of_file(const std::string& path) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) return FileKind::Dem;
    const std::string ending = lower(std::filesystem::path(path).extension().string());
    try {
        if (dem::is_tile_index(path)) return FileKind::Dem;
        if (ending == ".json" || ending == ".geojson") return kind_of_json(path);
        if (ending == ".gpx") return kind_of_gpx(path);
        if (ending == ".csv") return FileKind::Places;
        if (contains(kVectors, std::string_view(ending)) && !is_raster_file(path))
            return FileKind::Lines;
        return kind_of_raster(path);
    } catch (const Error&) {
        return FileKind::Dem;
    }
}

std::string file_text_for(FileKind kind, const effect::Registry& registry) {
    for (const effect::Effect& effect : registry.effects()) {
        const effect::Manifest& manifest = effect.manifest;
        if (kind == FileKind::Places)
            for (const effect::MarksSpec& marks : manifest.marks)
                if (!marks.from.empty()) return marks.from;  // else a module sets them
        if (kind == FileKind::Lines && !manifest.lines.empty()) return manifest.lines.front().file;
    }
    return "";
}

}  // namespace relevo::viewer

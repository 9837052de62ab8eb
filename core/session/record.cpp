#include "session/record.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/sha256.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/versions.h"
#include "effect/selection.h"
#include "session/active_effects.h"
#include "session/climate_words.h"
#include "session/panorama_maker.h"
#include "session/scene_weather.h"
#include "session/words.h"
#include "sun/position.h"

namespace relevo::session {
namespace {

using nlohmann::ordered_json;

ordered_json sun_json(const Session& session) {
    const geo::Geodetic middle = session.ground().frame.origin();
    const sun::Position at = sun::position(session.time(), middle);
    const sun::Refraction air =
        session.refraction({middle.lat_rad, middle.lon_rad, session.ground().air_height_m()});
    return {{"lat_deg", degrees(middle.lat_rad)},
            {"lon_deg", degrees(middle.lon_rad)},
            {"azimuth_deg", degrees(at.azimuth_rad)},
            {"elevation_deg", degrees(at.elevation_rad)},
            {"apparent_elevation_deg", degrees(air.apparent_rad(at.elevation_rad))},
            {"refraction", session.scene().refraction}};
}

/// The resolved position and direction of the camera.
ordered_json camera_json(const Session& session) {
    const scene::Camera& camera = session.camera();
    const geo::LocalFrame& frame = session.ground().frame;
    const geo::Geodetic eye = frame.to_geodetic(camera.eye_m);
    const geo::Axes axes = frame.axes(eye.lat_rad, eye.lon_rad);
    const double heading_deg =
        degrees(std::atan2(dot(camera.forward, axes.east), dot(camera.forward, axes.north)));
    ordered_json json{
        {"lat_deg", degrees(eye.lat_rad)},
        {"lon_deg", degrees(eye.lon_rad)},
        {"height_m", eye.height_m / session.scene().exaggeration},
        {"heading_deg", heading_deg < 0 ? heading_deg + 360 : heading_deg},
        {"pitch_deg", degrees(std::asin(std::min(1.0, dot(camera.forward, axes.up))))}};
    if (session.scene().view.panorama == scene::Panorama::None) {
        json["fov_deg"] = degrees(camera.fov_y_rad);
        return json;
    }
    const scene::PanoramaMap map = panorama_map(session.scene(), frame, camera);
    json["hfov_deg"] = degrees(session.scene().view.hfov_rad);
    json["elevations_deg"] = {degrees(map.elevation_rad(map.picture_px().y)),
                              degrees(map.elevation_rad(0))};
    return json;
}

ordered_json dem_json(const Session& session, const std::vector<HashedFile>& files) {
    const dem::Grid& grid = session.dem()->source->grid();
    ordered_json json;
    json["files"] = ordered_json::array();
    for (const HashedFile& file : files)
        json["files"].push_back({{"path", file.path}, {"sha256", file.sha256}});
    json["size"] = {grid.columns(), grid.rows()};
    json["crs"] = grid.crs().text();
    return json;
}

std::string origin_line(const geo::Geodetic& origin) {
    const ordered_json json{{"lat_deg", degrees(origin.lat_rad)},
                            {"lon_deg", degrees(origin.lon_rad)},
                            {"height_m", origin.height_m}};
    return json.dump();
}

/// With the compared effects on.
scene::Scene drawn(scene::Scene scene, const Session& session) {
    scene.effects = with(std::move(scene.effects), session.compared());
    return scene;
}

/// Properties by which viewers show an equirectangular panorama as a sphere.
/// source: Google, Photo Sphere XMP Metadata,
/// developers.google.com/streetview/spherical-metadata
image::Metadata sphere_metadata(const scene::PanoramaMap& map) {
    if (!map.is_equirectangular()) return {};
    const auto whole = [](double px) { return fmt::format("{}", std::lround(px)); };
    const glm::ivec2 size = map.picture_px();
    const double turn_px = 2 * kPi * map.px_per_rad();
    double heading_deg = std::fmod(degrees(map.azimuth_rad(0.5 * size.x)), 360);
    if (heading_deg < 0) heading_deg += 360;
    return {
        {"GPano:ProjectionType", "equirectangular"},
        {"GPano:UsePanoramaViewer", "True"},
        {"GPano:PoseHeadingDegrees", fmt::format("{:.3f}", heading_deg)},
        {"GPano:FullPanoWidthPixels", whole(turn_px)},
        {"GPano:FullPanoHeightPixels", whole(0.5 * turn_px)},
        {"GPano:CroppedAreaImageWidthPixels", whole(size.x)},
        {"GPano:CroppedAreaImageHeightPixels", whole(size.y)},
        {"GPano:CroppedAreaLeftPixels", whole(0.5 * (turn_px - size.x))},
        {"GPano:CroppedAreaTopPixels", whole((kPi / 2 - map.elevation_rad(0)) * map.px_per_rad())}};
}

}  // namespace

scene::Scene settled_scene(const Session& session) {
    scene::Scene scene = scene::with_absolute_paths(session.scene());
    scene.time.at = sun::exact_iso(session.time());
    scene.time.date.clear();
    return scene;
}

std::filesystem::path sidecar_to_write(const std::filesystem::path& picture) {
    std::filesystem::path sidecar = sidecar_of(picture);
    std::error_code unknown;
    const std::filesystem::file_status status = std::filesystem::status(sidecar, unknown);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        bad_input(
            fmt::format("--sidecar: {}: is not a regular file; remove it, or give the "
                        "picture another name",
                        printable(sidecar.string())));
    return sidecar;
}

SceneIn scene_in(const std::filesystem::path& picture, const scene::Scene& scene) {
    // Reserve for other metadata and for what a session fills into the scene [bytes].
    constexpr std::size_t kRest = 2048;
    return image::metadata_fits(picture, {{kSceneKeyword, scene::whole_scene_line(scene)}}, kRest)
               ? SceneIn::Picture
               : SceneIn::Sidecar;
}

std::string says_where_scene_is(const std::filesystem::path& picture) {
    return fmt::format("{}: the scene is too long for this format; it is in {}, keep both together",
                       printable(picture.string()), printable(sidecar_of(picture).string()));
}

std::string format_text(const image::Encoding& encoding, const PictureFormat& format) {
    std::vector<std::string> parts;
    if (encoding.bits != image::Encoding().bits)
        parts.push_back(fmt::format("{} bits", encoding.bits));
    if (encoding.quality) parts.push_back(fmt::format("quality {}", *encoding.quality));
    std::string layers;
    for (const DataLayer layer : format.layers)
        layers += " " + word_of(layer);
    if (!layers.empty()) parts.push_back("layers" + layers);
    return fmt::format("{}", fmt::join(parts, ", "));
}

image::Metadata metadata_of(const Session& session, SceneInputs& inputs, SceneIn where,
                            const std::string& format) {
    const scene::Scene scene = settled_scene(session);
    const std::string line = scene::whole_scene_line(scene);
    image::Metadata metadata{
        {"Software", "Relevo " + inputs.version()},
        {"Description", fmt::format("{}; {}; sun at {}", session.place_text(),
                                    sun::to_iso(session.time()), session.sun_text())},
        {kInputsKeyword, inputs.record(drawn(scene, session))}};
    if (session.format() && !session.format()->layers.empty())
        metadata[kOriginKeyword] = origin_line(session.ground().frame.origin());
    if (!format.empty()) metadata[kFormatKeyword] = format;
    if (where == SceneIn::Picture)
        metadata[kSceneKeyword] = line;
    else
        metadata[kSceneDigestKeyword] = sha256_of_text(line);
    if (scene.view.panorama != scene::Panorama::None)
        metadata.merge(
            sphere_metadata(panorama_map(scene, session.ground().frame, session.camera())));
    if (!session.compared().empty())
        metadata[kComparedKeyword] = fmt::format("{}", fmt::join(session.compared(), ","));
    return metadata;
}

std::string sidecar_text(const Session& session, SceneInputs& inputs, const std::string& picture,
                         const std::optional<ShadowAudit>& audit) {
    const scene::Scene scene = settled_scene(session);
    ordered_json json;
    json["picture"] = picture;
    json["utc"] = sun::exact_iso(session.time());
    json["sun"] = sun_json(session);
    json["camera"] = camera_json(session);
    if (const SceneWeather* const weather = session.weather()) {
        if (weather->report)
            json["weather"]["report"] = weather->report->text;
        else
            json["weather"]["forecast"] = weather->forecast->summary();
        json["weather"]["station_height_m"] = weather->station_m;
    }
    if (!scene.land_cover.climate_alone && !session.climate_text().empty())
        json["land_cover"] = kLandCoverText;
    json["effects"] = ordered_json::array();
    for (const effect::Effect* effect : session.effects().loaded.selection.effects)
        json["effects"].push_back(effect->id());
    json["dem"] = dem_json(session, inputs.hashed_dem(scene));
    const gl::DeviceInfo& device = session.device();
    json["device"] = {{"renderer", device.renderer},
                      {"vendor", device.vendor},
                      {"version", device.version},
                      {"software", device.device.software}};
    json["versions"] = {{"relevo", inputs.version()},
                        {"gdal", dem::gdal_version()},
                        {"proj", dem::proj_version()},
                        {"time_zones", sun::zone_database_version()}};
    if (audit) json["audit"] = ordered_json::parse(audit->json_text());
    json["inputs"] = ordered_json::parse(inputs.record(drawn(scene, session)));
    json["scene"] = ordered_json::parse(scene::whole_scene_line(scene));
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace relevo::session

#include "session/record.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/sha256.h"
#include "base/units.h"
#include "dem/files_of.h"
#include "dem/versions.h"
#include "effect/selection.h"
#include "render/ground.h"
#include "session/active_effects.h"
#include "session/words.h"
#include "sun/position.h"

namespace relevo::session {
namespace {

using nlohmann::ordered_json;

ordered_json sun_json(const Session& session) {
    const geo::Geodetic middle = session.ground().frame.origin();
    const sun::Position at = sun::position(session.moment(), middle);
    const sun::Refraction air =
        refraction_at(session.scene().refraction,
                      {middle.lat_rad, middle.lon_rad, session.ground().air_height_m()});
    return {{"lat_deg", degrees(middle.lat_rad)},
            {"lon_deg", degrees(middle.lon_rad)},
            {"azimuth_deg", degrees(at.azimuth_rad)},
            {"elevation_deg", degrees(at.elevation_rad)},
            {"apparent_elevation_deg", degrees(air.apparent_rad(at.elevation_rad))},
            {"refraction", session.scene().refraction}};
}

/// The camera where it stands, whatever words placed it.
ordered_json camera_json(const Session& session) {
    const scene::Camera& camera = session.camera();
    const geo::LocalFrame& frame = session.ground().frame;
    const geo::Geodetic eye = frame.to_geodetic(camera.eye_m);
    const geo::Axes axes = frame.axes(eye.lat_rad, eye.lon_rad);
    const double heading_deg =
        degrees(std::atan2(dot(camera.forward, axes.east), dot(camera.forward, axes.north)));
    return {{"lat_deg", degrees(eye.lat_rad)},
            {"lon_deg", degrees(eye.lon_rad)},
            {"height_m", eye.height_m / session.scene().exaggeration},
            {"heading_deg", heading_deg < 0 ? heading_deg + 360 : heading_deg},
            {"pitch_deg", degrees(std::asin(std::min(1.0, dot(camera.forward, axes.up))))},
            {"fov_deg", degrees(camera.fov_y_rad)}};
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

}  // namespace

scene::Scene settled_scene(const Session& session) {
    scene::Scene scene = scene::with_absolute_paths(session.scene());
    scene.moment.time = sun::exact_iso(session.moment());
    scene.moment.date.clear();
    return scene;
}

image::Metadata metadata_of(const Session& session, const std::string& version,
                            const std::vector<std::string>& compared) {
    image::Metadata metadata{
        {"Software", "Relevo " + version},
        {"Description", fmt::format("{}; {}; sun at {}", session.place_text(),
                                    sun::to_iso(session.moment()), session.sun_text())},
        {kSceneKeyword, scene::scene_line(settled_scene(session))}};
    if (!compared.empty()) metadata[kComparedKeyword] = fmt::format("{}", fmt::join(compared, ","));
    return metadata;
}

std::vector<HashedFile> hashed_files(const std::vector<std::string>& dems) {
    std::vector<HashedFile> result;
    std::error_code ignored;
    for (const std::filesystem::path& path : dem::files_of(dems))
        if (std::filesystem::is_regular_file(path, ignored))
            result.push_back({path.string(), sha256_of_file(path, "--sidecar")});
    return result;
}

std::string sidecar_text(const Session& session, const std::string& version,
                         const std::string& picture, const std::vector<HashedFile>& dem_files,
                         const std::optional<ShadowAudit>& audit) {
    ordered_json json;
    json["picture"] = picture;
    json["utc"] = sun::exact_iso(session.moment());
    json["sun"] = sun_json(session);
    json["camera"] = camera_json(session);
    json["effects"] = ordered_json::array();
    for (const effect::Effect* effect : session.effects().loaded.selection.effects)
        json["effects"].push_back(effect->id());
    json["dem"] = dem_json(session, dem_files);
    const gl::DeviceInfo& device = session.device();
    json["device"] = {{"renderer", device.renderer},
                      {"vendor", device.vendor},
                      {"version", device.version},
                      {"software", device.device.software}};
    json["versions"] = {{"relevo", version},
                        {"gdal", dem::gdal_version()},
                        {"proj", dem::proj_version()},
                        {"time_zones", sun::zone_database_version()}};
    if (audit) json["audit"] = ordered_json::parse(audit->json_text());
    json["scene"] = ordered_json::parse(scene::scene_line(settled_scene(session)));
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace relevo::session

#include "output/export_text.h"

#include <nlohmann/json.hpp>

#include "base/units.h"

namespace relevo::output {
namespace {

using Json = nlohmann::ordered_json;

Json ground_json(const ExportedGround& ground, const std::string& generator) {
    const dem::Description& about = ground.field.about;
    const geo::Crs& crs = ground.field.grid.crs();
    Json json;
    json["generator"] = generator;
    json["dem"] = about.files;
    json["dem_size"] = {ground.dem_posts.x, ground.dem_posts.y};
    json["crs"] = crs.text();
    json["crs_name"] = crs.name();
    json["vertical_datum"] = about.vertical_datum;
    json["exaggeration"] = ground.exaggeration;
    json["voids"] = ground.voids;
    json["assumptions"] = about.assumptions;
    if (!ground.holes_text.empty()) json["assumptions"].push_back(ground.holes_text);
    return json;
}

Json place_json(const geo::Geodetic& place) {
    return {{"lat_deg", degrees(place.lat_rad)}, {"lon_deg", degrees(place.lon_rad)}};
}

Json corner_json(const dem::Grid& grid, int column, int row) {
    Json json = place_json(grid.place(column, row));
    const glm::dvec2 at = grid.affine()(column, row);
    json["x"] = at.x;
    json["y"] = at.y;
    return json;
}

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string map_json(const ExportedGround& ground, const std::string& generator,
                     const HeightScale* scale, const Green* green) {
    const dem::Grid& grid = ground.field.grid;
    Json json = ground_json(ground, generator);
    json["size"] = {grid.columns(), grid.rows()};
    json["rows"] = "from the top";
    const glm::dvec2 spacing = grid.post_spacing_m();
    json["spacing_m"] = {spacing.x, spacing.y};
    json["first_to_last_m"] = {spacing.x * (grid.columns() - 1), spacing.y * (grid.rows() - 1)};
    if (scale)
        json["height_m"] = {{"offset", scale->offset_m},
                            {"step", scale->step_m},
                            {"range", kMostValue * scale->step_m},
                            {"formula", "offset + step * value"}};
    if (green)
        json["normal"] = {{"red", "right (east)"},
                          {"green", *green == Green::Up ? "up the map (north), as OpenGL"
                                                        : "down the map (south), as DirectX"},
                          {"blue", "up"}};
    json["row_azimuth_deg"] = degrees(grid.row_azimuth_rad());
    const int last_column = grid.columns() - 1, last_row = grid.rows() - 1;
    json["corners"] = {{"upper_left", corner_json(grid, 0, 0)},
                       {"upper_right", corner_json(grid, last_column, 0)},
                       {"lower_left", corner_json(grid, 0, last_row)},
                       {"lower_right", corner_json(grid, last_column, last_row)}};
    return text_of(json);
}

std::string mesh_json(const ExportedGround& ground, const std::string& generator,
                      const GroundFrame& frame, const TerrainMesh& mesh, double error_m) {
    Json json = ground_json(ground, generator);
    json["unit"] = "metre";
    json["axes"] = "x east, y up, z south";
    json["origin"] = place_json(frame.origin());
    json["origin"]["height_m"] = 0.0;
    if (frame.is_flat()) {
        json["frame"] = "flat: the plane of the CRS about the origin, y is the height";
        json["origin"]["x"] = frame.origin_crs().x;
        json["origin"]["y"] = frame.origin_crs().y;
        json["metres_a_crs_unit"] = {frame.metres_a_unit().x, frame.metres_a_unit().y};
    } else {
        json["frame"] =
            "round: east, up and south at the origin on the WGS 84 ellipsoid (EPSG method 9837)";
    }
    if (mesh.base_m) json["base_m"] = *mesh.base_m;
    json["error_m"] = {{"allowed", error_m}, {"worst", mesh.worst_m}, {"mean", mesh.mean_m}};
    json["posts"] = mesh.posts;
    json["triangles"] = mesh.surface.triangles();
    return text_of(json);
}

}  // namespace relevo::output

#include "zones/zone_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/guard.h"
#include "dem/interpret.h"
#include "zones/vector_file.h"

namespace relevo::zones {
namespace {

bool has_polygons(OGRLayerH layer) {
    const OGRwkbGeometryType type = OGR_GT_Flatten(OGR_L_GetGeomType(layer));
    return type == wkbPolygon || type == wkbMultiPolygon || type == wkbUnknown ||
           type == wkbCurvePolygon || type == wkbMultiSurface || type == wkbGeometryCollection;
}

/// The number of a field. @throws Error (BadInput) where there is none of that name
int field_of(const std::string& path, OGRFeatureDefnH fields, const std::string& name) {
    const int field = OGR_FD_GetFieldIndex(fields, name.c_str());
    if (field >= 0) return field;
    std::vector<std::string> names;
    for (int i = 0; i < OGR_FD_GetFieldCount(fields); ++i)
        names.emplace_back(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(fields, i)));
    bad_input(fmt::format("--id: {}: no such field in {}, which has {}", name, path,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

/// Adds the rings of polygons; returns why something is none.
std::string collect(OGRGeometryH geometry, std::vector<Ring>& rings) {
    const OGRwkbGeometryType type = OGR_GT_Flatten(OGR_G_GetGeometryType(geometry));
    const int parts = OGR_G_GetGeometryCount(geometry);
    if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
        for (int i = 0; i < parts; ++i)
            if (std::string fault = collect(OGR_G_GetGeometryRef(geometry, i), rings);
                !fault.empty())
                return fault;
        return {};
    }
    if (type != wkbPolygon) return "no polygon, but points or lines";
    for (int i = 0; i < parts; ++i) {
        const OGRGeometryH line = OGR_G_GetGeometryRef(geometry, i);
        Ring ring(static_cast<std::size_t>(std::max(OGR_G_GetPointCount(line), 0)));
        if (!ring.empty())
            OGR_G_GetPoints(line, &ring.front().x, sizeof(glm::dvec2), &ring.front().y,
                            sizeof(glm::dvec2), nullptr, 0);
        if (!ring.empty() && ring.front() == ring.back()) ring.pop_back();
        if (ring.size() < 3)
            return fmt::format("a ring of {} corners, expected 3 or more", ring.size());
        if (std::ranges::any_of(
                ring, [](const auto& at) { return !std::isfinite(at.x) || !std::isfinite(at.y); }))
            return "a corner without coordinates";
        rings.push_back(std::move(ring));
    }
    return {};
}

Zone zone_of(OGRFeatureH feature, int id_field) {
    Zone zone{.id = id_field < 0 ? fmt::format("{}", OGR_F_GetFID(feature))
                                 : OGR_F_GetFieldAsString(feature, id_field),
              .rings = {},
              .fault = {}};
    OGRGeometryH geometry = OGR_F_GetGeometryRef(feature);
    const std::unique_ptr<void, void (*)(void*)> straight(
        geometry && OGR_G_HasCurveGeometry(geometry, FALSE)
            ? OGR_G_GetLinearGeometry(geometry, 0, nullptr)
            : nullptr,
        [](void* made) { OGR_G_DestroyGeometry(made); });
    if (straight) geometry = straight.get();
    zone.fault = geometry ? collect(geometry, zone.rings) : "no geometry";
    if (zone.fault.empty() && zone.rings.empty()) zone.fault = "an empty polygon";
    return zone;
}

}  // namespace

OGRLayerH layer_of_zones(const std::string& path, GDALDatasetH dataset) {
    OGRLayerH found = nullptr;
    std::vector<std::string> names;
    for (int i = 0; i < GDALDatasetGetLayerCount(dataset); ++i) {
        const OGRLayerH layer = GDALDatasetGetLayer(dataset, i);
        if (!has_polygons(layer)) continue;
        names.emplace_back(OGR_L_GetName(layer));
        found = layer;
    }
    if (names.empty()) dem::refuse(path, "no layer with polygons");
    if (names.size() > 1)
        dem::refuse(path, fmt::format("several layers with polygons ({}); make a file of one, for "
                                      "example with ogr2ogr",
                                      fmt::join(names, ", ")));
    return found;
}

dem::Dataset open_vectors(const std::string& path) {
    // Drivers that read nothing but the file and files of its name.
    static constexpr std::array kDrivers = {"GPKG",           "FlatGeobuf",
                                            "ESRI Shapefile", "GeoJSONSeq",
                                            "GeoJSON",        static_cast<const char*>(nullptr)};
    dem::prepare_gdal();
    dem::refuse_unreadable(path);
    const dem::GdalMessages messages;
    dem::Dataset dataset =
        dem::open_by_gdal(AllowedName(path), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers.data());
    if (!dataset) {
        constexpr const char* kWhat =
            "no polygons that can be read, expected a GeoPackage, GeoJSON, FlatGeobuf or Shapefile";
        if (messages.any_failure()) messages.refuse(path, kWhat);
        dem::refuse(path, kWhat);
    }
    return dataset;
}

ZoneFile read_zones(const std::string& path, const std::string& id_field) {
    const dem::Dataset dataset = open_vectors(path);
    const OGRLayerH layer = layer_of_zones(path, dataset.get());
    const dem::GdalMessages messages;
    const int field = id_field.empty() ? -1 : field_of(path, OGR_L_GetLayerDefn(layer), id_field);
    ZoneFile file;
    const OGRSpatialReferenceH srs = OGR_L_GetSpatialRef(layer);
    const std::string wkt = dem::wkt_of(srs);
    if (!wkt.empty() && !OSRIsLocal(srs) && !lower(OSRGetName(srs)).starts_with("undefined"))
        file.crs = geo::Crs::parse(wkt, path);
    OGR_L_ResetReading(layer);
    while (const dem::Feature feature{OGR_L_GetNextFeature(layer)})
        file.zones.push_back(zone_of(feature.get(), field));
    if (messages.any_failure()) messages.refuse(path, "cannot be read to its end");
    if (file.zones.empty()) dem::refuse(path, "no zones in it");
    return file;
}

}  // namespace relevo::zones

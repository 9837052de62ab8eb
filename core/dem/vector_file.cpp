#include "dem/vector_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include "base/error.h"
#include "base/units.h"
#include "dem/gdal_support.h"
#include "dem/interpret.h"
#include "geo/crs.h"

namespace relevo::dem {
namespace {

struct DestroyFeature {
    void operator()(void* feature) const { OGR_F_Destroy(static_cast<OGRFeatureH>(feature)); }
};
using Feature = std::unique_ptr<void, DestroyFeature>;

/// A field of a feature as text; empty where it is not there.
std::string text_field(OGRFeatureH feature, const char* name) {
    const int field = OGR_F_GetFieldIndex(feature, name);
    if (field < 0 || !OGR_F_IsFieldSetAndNotNull(feature, field)) return {};
    return OGR_F_GetFieldAsString(feature, field);
}

std::string name_of(OGRFeatureH feature) {
    for (const char* field : {"name", "title", "id"})
        if (std::string name = text_field(feature, field); !name.empty()) return name;
    return {};
}

/// The time of a GPX point. The format's times are UTC, also where they do not say so.
std::string time_of(OGRFeatureH feature) {
    const int field = OGR_F_GetFieldIndex(feature, "time");
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, zone = 0;
    float second = 0;
    if (field < 0 || !OGR_F_IsFieldSetAndNotNull(feature, field) ||
        !OGR_F_GetFieldAsDateTimeEx(feature, field, &year, &month, &day, &hour, &minute, &second,
                                    &zone))
        return {};
    // GDAL counts offsets in quarters of an hour from 100 on; 0 and 1 are no offset.
    const int offset_min = zone > 1 ? (zone - 100) * 15 : 0;
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:06.3f}{}{:02}:{:02}", year, month, day,
                       hour, minute, static_cast<double>(second), offset_min < 0 ? '-' : '+',
                       std::abs(offset_min) / 60, std::abs(offset_min) % 60);
}

/// From coordinates of a layer to degrees.
class ToDegrees {
  public:
    ToDegrees(OGRLayerH layer, std::string_view who) {
        const OGRSpatialReferenceH srs = OGR_L_GetSpatialRef(layer);
        const char* const code = srs ? OSRGetAuthorityCode(srs, nullptr) : nullptr;
        // What both formats have unless they say otherwise; longitude first either way.
        if (!srs || (code && (EQUAL(code, "4326") || EQUAL(code, "4979") || EQUAL(code, "CRS84"))))
            return;
        char* wkt = nullptr;
        OSRExportToWkt(srs, &wkt);
        const std::string text = wkt ? wkt : "";
        CPLFree(wkt);
        crs_ = geo::Crs::parse(text, who);
    }

    void set(double x, double y, VectorPoint& point) const {
        if (!crs_) {
            point.lon_deg = x;
            point.lat_deg = y;
            return;
        }
        const geo::Geodetic place = crs_->to_geodetic(x, y);
        point.lat_deg = degrees(place.lat_rad);
        point.lon_deg = degrees(place.lon_rad);
    }

  private:
    std::optional<geo::Crs> crs_;
};

using VisitGeometry = std::function<void(OGRGeometryH)>;

/// The parts of a kind that a geometry has, down through its collections.
void parts(OGRGeometryH geometry, OGRwkbGeometryType kind, const VisitGeometry& visit) {
    if (!geometry) return;
    const OGRwkbGeometryType type = OGR_GT_Flatten(OGR_G_GetGeometryType(geometry));
    if (type == kind) return visit(geometry);
    if (!OGR_GT_IsSubClassOf(type, wkbGeometryCollection)) return;
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i)
        parts(OGR_G_GetGeometryRef(geometry, i), kind, visit);
}

}  // namespace

struct VectorFile::Impl {
    std::string path, who;
    bool gpx = false;
    GdalMessages messages;
    Dataset dataset;

    [[noreturn]] void refuse_damaged() const {
        bad_input(fmt::format("{}: {}: cannot be read as {}{}{}; the file is damaged or too large",
                              who, path, gpx ? "GPX" : "GeoJSON",
                              messages.any_failure() ? ", " : "", messages.failure(path)));
    }

    OGRLayerH layer(const std::string& name) const {
        return GDALDatasetGetLayerByName(dataset.get(), name.c_str());
    }

    /// Calls `visit` with every feature and its geometry, which may be null.
    void features(OGRLayerH layer, const std::function<void(OGRFeatureH, OGRGeometryH)>& visit) {
        if (!layer) return;
        OGR_L_ResetReading(layer);
        while (const Feature feature{OGR_L_GetNextFeature(layer)}) {
            const auto handle = static_cast<OGRFeatureH>(feature.get());
            visit(handle, OGR_F_GetGeometryRef(handle));
        }
        if (messages.any_failure()) refuse_damaged();
    }

    /// What GDAL cannot read as coordinates it leaves without a geometry.
    static VectorPoint gpx_point(OGRGeometryH at) {
        VectorPoint point;
        point.lat_deg = at ? OGR_G_GetY(at, 0) : std::nan("");
        point.lon_deg = at ? OGR_G_GetX(at, 0) : std::nan("");
        return point;
    }

    /// Points of tracks or of routes, and their names. @param kind  "track" or "route"
    std::vector<std::string> gpx_lines(const std::string& kind,
                                       const std::function<void(int, VectorPoint&&)>& visit) {
        const std::string number = kind + "_fid";
        int count = 0;
        features(layer(kind + "_points"), [&](OGRFeatureH feature, OGRGeometryH at) {
            const int line =
                OGR_F_GetFieldAsInteger(feature, OGR_F_GetFieldIndex(feature, number.c_str()));
            count = std::max(count, line + 1);
            VectorPoint point = gpx_point(at);
            point.time = time_of(feature);
            visit(line + 1, std::move(point));
        });
        // After the points, of which there may be too many: GDAL makes lines of them for this.
        std::vector<std::string> names(static_cast<std::size_t>(count));
        features(layer(kind + "s"), [&](OGRFeatureH feature, OGRGeometryH) {
            const auto line = static_cast<std::size_t>(OGR_F_GetFID(feature));
            if (line < names.size()) names[line] = name_of(feature);
        });
        return names;
    }
};

VectorFile::VectorFile(const std::string& path, std::string_view who, bool gpx)
    : impl_(std::make_unique<Impl>()) {
    impl_->path = path;
    impl_->who = std::string(who);
    impl_->gpx = gpx;
    // As a path that begins at the root it is no address, no text of JSON and no "/vsi...".
    const std::string file = std::filesystem::absolute(path).string();
    const std::array<const char*, 2> drivers{gpx ? "GPX" : "GeoJSON", nullptr};
    impl_->dataset.reset(GDALOpenEx(file.c_str(),
                                    GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                    drivers.data(), nullptr, nullptr));
    if (!impl_->dataset) impl_->refuse_damaged();
    impl_->messages.clear();
}

VectorFile::~VectorFile() = default;

void VectorFile::points(const std::function<void(VectorPoint&&)>& visit) {
    const auto of_layer = [&](OGRLayerH layer) {
        if (!layer) return;
        const ToDegrees to_degrees(layer, impl_->who);
        impl_->features(layer, [&](OGRFeatureH feature, OGRGeometryH geometry) {
            parts(geometry, wkbPoint, [&](OGRGeometryH at) {
                if (OGR_G_IsEmpty(at)) return;
                VectorPoint point;
                to_degrees.set(OGR_G_GetX(at, 0), OGR_G_GetY(at, 0), point);
                point.name = name_of(feature);
                visit(std::move(point));
            });
        });
    };
    if (impl_->gpx)
        return impl_->features(impl_->layer("waypoints"),
                               [&](OGRFeatureH feature, OGRGeometryH at) {
                                   VectorPoint point = Impl::gpx_point(at);
                                   point.name = name_of(feature);
                                   visit(std::move(point));
                               });
    for (int i = 0; i < GDALDatasetGetLayerCount(impl_->dataset.get()); ++i)
        of_layer(GDALDatasetGetLayer(impl_->dataset.get(), i));
}

std::vector<std::string> VectorFile::lines(const std::function<void(int, VectorPoint&&)>& visit) {
    if (impl_->gpx) {
        std::vector<std::string> tracks = impl_->gpx_lines("track", visit);
        return tracks.empty() ? impl_->gpx_lines("route", visit) : tracks;
    }
    std::vector<std::string> names;
    for (int i = 0; i < GDALDatasetGetLayerCount(impl_->dataset.get()); ++i) {
        const OGRLayerH layer = GDALDatasetGetLayer(impl_->dataset.get(), i);
        const ToDegrees to_degrees(layer, impl_->who);
        impl_->features(layer, [&](OGRFeatureH feature, OGRGeometryH geometry) {
            bool is_line = false;
            parts(geometry, wkbLineString, [&](OGRGeometryH part) {
                if (!std::exchange(is_line, true)) names.push_back(name_of(feature));
                for (int k = 0; k < OGR_G_GetPointCount(part); ++k) {
                    VectorPoint point;
                    to_degrees.set(OGR_G_GetX(part, k), OGR_G_GetY(part, k), point);
                    visit(static_cast<int>(names.size()), std::move(point));
                }
            });
        });
    }
    return names;
}

}  // namespace relevo::dem

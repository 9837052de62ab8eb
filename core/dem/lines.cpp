#include "dem/lines.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "base/contains.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/interpret.h"
#include "dem/lines_over.h"

namespace relevo::dem {
namespace {

/// Drivers that read nothing but the file and files of its name.
constexpr std::array kDrivers = {"ESRI Shapefile",
                                 "GPKG",
                                 "GeoJSON",
                                 "GeoJSONSeq",
                                 "TopoJSON",
                                 "LIBKML",
                                 "KML",
                                 "GPX",
                                 "FlatGeobuf",
                                 "MapInfo File",
                                 static_cast<const char*>(nullptr)};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class LineReader {
  public:
    LineReader(const std::string& path, std::string_view who, const std::string& attribute,
               const Grid& dem)
        : path_(path), who_(who), attribute_(attribute), dem_(dem) {}

    std::vector<PlacedLine> run() {
        open();
        const int layers = GDALDatasetGetLayerCount(dataset_.get());
        for (int i = 0; i < layers; ++i)
            layer(GDALDatasetGetLayer(dataset_.get(), i));
        if (!any_line_)
            fail(fmt::format("it has no lines{}; expected lines, or polygons for their outlines",
                             points_ ? ", but points" : ""));
        if (!attribute_.empty() && !has_attribute_)
            fail(fmt::format("no line has the attribute \"{}\"; {}", printable(attribute_),
                             fields_.empty() ? std::string("there are none")
                                             : fmt::format("there are {}", some_fields())));
        return std::move(lines_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        bad_input(fmt::format("{}: {}: {}", who_, printable(path_), what));
    }

    void open() {
        prepare_gdal();
        try {
            refuse_unreadable(path_);
        } catch (const Error& error) {
            bad_input(fmt::format("{}: {}", who_, error.what()));
        }
        const GdalMessages messages;
        dataset_ =
            open_by_gdal(AllowedName(path_), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers.data());
        if (dataset_) return;
        const std::string reason = messages.failure(path_);
        fail(
            fmt::format("expected a vector file (Shapefile, GeoPackage, GeoJSON, KML, GPX, "
                        "FlatGeobuf, MapInfo){}",
                        reason.empty() ? "" : " but got: " + printable(reason)));
    }

    void layer(OGRLayerH layer) {
        const std::string_view driver =
            GDALGetDriverShortName(GDALGetDatasetDriver(dataset_.get()));
        const std::string name = OGR_L_GetName(layer);
        // Layers of vertices, and of waypoints.
        if (driver == "GPX" && name.ends_with("points")) return;
        OGR_L_ResetReading(layer);
        const GdalMessages messages;
        std::optional<LinesOver> over;
        const int field = field_of(layer);
        while (const Feature feature{OGR_L_GetNextFeature(layer)}) {
            const OGRGeometryH geometry = OGR_F_GetGeometryRef(feature.get());
            if (!geometry) continue;
            value_ = field < 0 ? kNone : number_of(feature.get(), field);
            collect(geometry);
            if (parts_.empty()) continue;
            if (!over) over.emplace(crs_of(layer), dem_);
            note_fields(layer, field);
            place(*over);
        }
        if (messages.any_failure()) fail(printable(messages.failure(path_)));
    }

    int field_of(OGRLayerH layer) const {
        return attribute_.empty()
                   ? -1
                   : OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer), attribute_.c_str());
    }

    void note_fields(OGRLayerH layer, int field) {
        any_line_ = true;
        has_attribute_ = has_attribute_ || field >= 0;
        if (attribute_.empty() || field >= 0) return;
        const OGRFeatureDefnH definition = OGR_L_GetLayerDefn(layer);
        for (int i = 0; i < OGR_FD_GetFieldCount(definition); ++i)
            fields_.insert(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(definition, i)));
    }

    std::string some_fields() const {
        constexpr std::size_t kMost = 12;
        std::vector<std::string> names;
        for (const std::string& field : fields_)
            if (names.size() < kMost) names.push_back(printable(field));
        return fmt::format("{}{}", fmt::join(names, ", "), fields_.size() > kMost ? ", ..." : "");
    }

    static double number_of(OGRFeatureH feature, int field) {
        if (!OGR_F_IsFieldSetAndNotNull(feature, field)) return kNone;
        switch (OGR_Fld_GetType(OGR_F_GetFieldDefnRef(feature, field))) {
            case OFTInteger:
            case OFTInteger64:
            case OFTReal:
                return OGR_F_GetFieldAsDouble(feature, field);
            case OFTString: {
                const std::string_view text = OGR_F_GetFieldAsString(feature, field);
                double value = 0;
                const auto [end, error] =
                    std::from_chars(text.data(), text.data() + text.size(), value);
                return error == std::errc() && end == text.data() + text.size() ? value : kNone;
            }
            default:
                return kNone;
        }
    }

    geo::Crs crs_of(OGRLayerH layer) const {
        const std::string wkt = wkt_of(OGR_L_GetSpatialRef(layer));
        if (wkt.empty())
            fail(
                "it names no coordinate system, its place on the ground is unknown; add one with "
                "ogr2ogr -a_srs EPSG:n");
        return geo::Crs::parse(wkt, fmt::format("{}: {}", who_, printable(path_)));
    }

    /// Adds the vertices of all lines of a geometry to `parts_`.
    void collect(OGRGeometryH geometry) {
        const OGRwkbGeometryType type = OGR_GT_Flatten(OGR_G_GetGeometryType(geometry));
        if (type == wkbPoint || type == wkbMultiPoint) {
            points_ = true;
            return;
        }
        if (OGR_G_HasCurveGeometry(geometry, 1)) {
            const std::unique_ptr<void, void (*)(OGRGeometryH)> linear(
                OGR_G_GetLinearGeometry(geometry, 0, nullptr), OGR_G_DestroyGeometry.address());
            return collect(linear.get());
        }
        const int inner = OGR_G_GetGeometryCount(geometry);
        for (int i = 0; i < inner; ++i)
            collect(OGR_G_GetGeometryRef(geometry, i));
        if (type != wkbLineString || OGR_G_GetPointCount(geometry) < 2) return;
        const int count = OGR_G_GetPointCount(geometry);
        vertices_ += static_cast<std::size_t>(count);
        check_count();
        std::vector<glm::dvec2> part(static_cast<std::size_t>(count));
        OGR_G_GetPoints(geometry, &part[0].x, sizeof(glm::dvec2), &part[0].y, sizeof(glm::dvec2),
                        nullptr, 0);
        for (const glm::dvec2& vertex : part)
            if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y))
                fail(fmt::format("line {}: a coordinate is not a number", number_ + 1));
        parts_.push_back(std::move(part));
    }

    void check_count() const {
        if (vertices_ > kMostLineVertices)
            fail(
                fmt::format("it has more than {} vertices; cut it with ogr2ogr -spat, or "
                            "simplify it with ogr2ogr -simplify",
                            kMostLineVertices));
    }

    void place(const LinesOver& over) {
        for (const std::vector<glm::dvec2>& part : parts_)
            for (PlacedLine& line : over.placed(part)) {
                added_ += line.posts.size();
                if (added_ > kMostPlacedVertices)
                    fail(
                        fmt::format("on this DEM its lines need more than {} vertices; cut it "
                                    "with ogr2ogr -spat",
                                    kMostPlacedVertices));
                line.value = value_;
                line.number = number_;
                lines_.push_back(std::move(line));
            }
        parts_.clear();
        ++number_;
    }

    const std::string& path_;
    std::string_view who_;
    const std::string& attribute_;
    const Grid& dem_;
    Dataset dataset_;
    std::vector<std::vector<glm::dvec2>> parts_;  // of a feature
    double value_ = kNone;
    int number_ = 0;
    std::size_t vertices_ = 0, added_ = 0;
    bool any_line_ = false, points_ = false, has_attribute_ = false;
    std::set<std::string> fields_;
    std::vector<PlacedLine> lines_;
};

}  // namespace

std::vector<PlacedLine> read_lines(const std::string& path, std::string_view who,
                                   const std::string& attribute, const Grid& dem) {
    return LineReader(path, who, attribute, dem).run();
}

}  // namespace relevo::dem

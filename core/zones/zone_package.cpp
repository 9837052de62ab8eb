#include "zones/zone_package.h"

#include <atomic>
#include <span>

#include <fmt/format.h>

#include "base/error.h"
#include "dem/gdal.h"
#include "zones/vector_file.h"

namespace relevo::zones {
namespace {

/// A file in GDAL's memory, which this removes.
struct MemoryName {
    std::string name;
    MemoryName() {
        static std::atomic<int> count = 0;
        name = fmt::format("/vsimem/relevo_zones_{}.gpkg", ++count);
    }
    ~MemoryName() { VSIUnlink(name.c_str()); }
    MemoryName(const MemoryName&) = delete;
    MemoryName& operator=(const MemoryName&) = delete;
};

void check(bool done, const dem::GdalMessages& messages) {
    if (!done) failed(fmt::format("-o: the GeoPackage cannot be made, {}", messages.failure("")));
}

void add_row(OGRLayerH layer, OGRGeometryH geometry, const std::vector<std::string>& row,
             const dem::GdalMessages& messages) {
    const dem::Feature feature{OGR_F_Create(OGR_L_GetLayerDefn(layer))};
    for (std::size_t i = 0; i < row.size(); ++i)
        if (!row[i].empty())
            OGR_F_SetFieldString(feature.get(), static_cast<int>(i), row[i].c_str());
    if (geometry) OGR_F_SetGeometry(feature.get(), geometry);
    check(OGR_L_CreateFeature(layer, feature.get()) == OGRERR_NONE, messages);
}

void fill(GDALDatasetH to, const std::string& zones, const ZoneTable& table,
          const dem::GdalMessages& messages) {
    const dem::Dataset source = open_vectors(zones);
    const OGRLayerH from = layer_of_zones(zones, source.get());
    const OGRLayerH layer =
        GDALDatasetCreateLayer(to, "zones", OGR_L_GetSpatialRef(from), wkbUnknown, nullptr);
    check(layer, messages);
    for (const ZoneTable::Column& column : table.columns) {
        const OGRFieldDefnH field =
            OGR_Fld_Create(column.name.c_str(), column.is_text ? OFTString : OFTReal);
        const bool made = OGR_L_CreateField(layer, field, TRUE) == OGRERR_NONE;
        OGR_Fld_Destroy(field);
        check(made, messages);
    }
    check(GDALDatasetStartTransaction(to, FALSE) == OGRERR_NONE, messages);
    for (std::size_t row = 0; row < table.rows.size();) {
        OGR_L_ResetReading(from);
        const std::size_t begun = row;
        while (const dem::Feature feature{OGR_L_GetNextFeature(from)})
            if (row < table.rows.size())
                add_row(layer, OGR_F_GetGeometryRef(feature.get()), table.rows[row++], messages);
        if (row == begun) break;  // the file has changed meanwhile
    }
    check(GDALDatasetCommitTransaction(to) == OGRERR_NONE, messages);
}

}  // namespace

void write_package(OutputFile& file, const std::string& zones, const ZoneTable& table) {
    const MemoryName memory;
    const dem::GdalMessages messages;
    {
        const dem::Dataset made(GDALCreate(GDALGetDriverByName("GPKG"), memory.name.c_str(), 0, 0,
                                           0, GDT_Unknown, nullptr));
        check(made != nullptr, messages);
        fill(made.get(), zones, table, messages);
    }
    vsi_l_offset size = 0;
    const GByte* bytes = VSIGetMemFileBuffer(memory.name.c_str(), &size, FALSE);
    check(bytes, messages);
    file.write(std::as_bytes(std::span(bytes, static_cast<std::size_t>(size))));
}

}  // namespace relevo::zones

#include "dem/tile_index.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/contains.h"
#include "base/text.h"
#include "dem/gdal.h"
#include "dem/gdal_open.h"
#include "dem/gdal_support.h"
#include "dem/guard.h"
#include "dem/interpret.h"
#include "dem/remote.h"
#include "dem/tile_index_parts.h"

namespace relevo::dem {
namespace {

constexpr const char* kLocation = "location";
constexpr const char* kTileCrs = "src_srs";  // what gdaltindex's manual calls it

/// Drivers that read nothing but the file and files of its name.
constexpr std::array kIndexDrivers = {"GPKG",           "FlatGeobuf",
                                      "ESRI Shapefile", "GeoJSONSeq",
                                      "GeoJSON",        static_cast<const char*>(nullptr)};
constexpr std::array<std::string_view, 6> kEndings = {".gpkg", ".fgb",     ".shp",
                                                      ".json", ".geojson", ".geojsonl"};
constexpr std::uint64_t kMostUnpacked = std::uint64_t{512} << 20;
constexpr std::uint64_t kMostJson = std::uint64_t{256} << 20;

bool is_packed(const std::string& path) {
    return lower(path).ends_with(".gz");
}

/// The ending of a name in small letters, before ".gz".
std::string ending_of(const std::string& path) {
    std::string name = lower(path);
    if (name.ends_with(".gz")) name.resize(name.size() - 3);
    return std::filesystem::path(name).extension().string();
}

bool is_json(const std::string& path) {
    return ending_of(path).starts_with(".json") || ending_of(path).starts_with(".geojson");
}

/// Bytes of a file that is plain or packed.
/// @param most  more are not read
std::string bytes_of(const std::string& path, std::uint64_t most) {
    const AllowedName name(path);
    return read_vsi(is_packed(path) ? name.derived("/vsigzip/" + path) : name, most);
}

/// What a packed file has unpacked. @throws Error (BadInput) where it is cut short
std::string unpacked(const std::string& path, std::uint64_t most) {
    GdalMessages messages;
    std::string bytes = bytes_of(path, most + 1);
    if (bytes.size() > most)
        refuse(printable(path), fmt::format("more than {} MiB unpacked; unpack it and cut it up, "
                                            "for example with ogr2ogr -spat",
                                            most >> 20));
    // RFC 1952, section 2.3.1: the last four bytes are the length modulo 2^32.
    std::array<unsigned char, 4> last{};
    const AllowedName name(path);
    const std::uint64_t size = size_by_vsi(name).value_or(0);
    const VsiFile file = open_vsi(name);
    auto* const handle = static_cast<VSILFILE*>(file.get());
    const bool read = file && size > 4 && VSIFSeekL(handle, size - 4, SEEK_SET) == 0 &&
                      VSIFReadL(last.data(), 1, last.size(), handle) == last.size();
    const std::uint32_t length = std::uint32_t{last[0]} | std::uint32_t{last[1]} << 8 |
                                 std::uint32_t{last[2]} << 16 | std::uint32_t{last[3]} << 24;
    if (!read || messages.any_failure() || length != static_cast<std::uint32_t>(bytes.size()))
        refuse(printable(path), "cannot be unpacked; the file is damaged or incomplete");
    return bytes;
}

/// A file in GDAL's memory for as long as this lives.
class MemoryFile {
  public:
    MemoryFile(std::string bytes, const std::string& ending) : bytes_(std::move(bytes)) {
        static std::atomic<int> count = 0;
        name_ = fmt::format("/vsimem/relevo_tile_index_{}{}", ++count, ending);
        VSIFCloseL(VSIFileFromMemBuffer(name_.c_str(), reinterpret_cast<GByte*>(bytes_.data()),
                                        bytes_.size(), FALSE));
    }
    ~MemoryFile() { VSIUnlink(name_.c_str()); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    const std::string& name() const { return name_; }

  private:
    std::string bytes_, name_;
};

/// A vector file that is open, plain or packed.
struct Vectors {
    std::unique_ptr<MemoryFile> memory;
    Dataset dataset;
};

Vectors open_vectors(const std::string& path) {
    Vectors vectors;
    AllowedName name(path);
    if (is_packed(path)) {
        vectors.memory =
            std::make_unique<MemoryFile>(unpacked(path, kMostUnpacked), ending_of(path));
        name = AllowedName::of_program(vectors.memory->name());
    }
    vectors.dataset = open_by_gdal(name, GDAL_OF_VECTOR | GDAL_OF_READONLY, kIndexDrivers.data());
    return vectors;
}

/// The layer that has the names of tiles; null where there is none.
OGRLayerH layer_of_tiles(GDALDatasetH dataset) {
    const int count = GDALDatasetGetLayerCount(dataset);
    for (int i = 0; i < count; ++i) {
        const OGRLayerH layer = GDALDatasetGetLayer(dataset, i);
        if (OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer), kLocation) >= 0) return layer;
    }
    return nullptr;
}

/// What JSON is by its beginning, as far as a first feature reaches.
enum class JsonKind { Other, Stac, Layer };
JsonKind json_kind(const std::string& path) {
    constexpr std::uint64_t kHead = std::uint64_t{1} << 16;
    const std::string head = lower(bytes_of(path, kHead));
    const auto has = [&](std::string_view key) { return head.find(key) != head.npos; };
    if (!has("\"feature")) return JsonKind::Other;
    if (has("\"stac_version\"")) return JsonKind::Stac;
    // Points may have a property of that name, too: a town.
    return has("\"location\"") && has("polygon\"") ? JsonKind::Layer : JsonKind::Other;
}

/// Refuses JSON that takes minutes to read.
void refuse_long_json(const std::string& path, std::uint64_t bytes) {
    if (bytes > kMostJson)
        refuse(printable(path), fmt::format("more than {} MiB of JSON; make a GeoPackage of it "
                                            "with a field \"{}\"",
                                            kMostJson >> 20, kLocation));
}

/// Adds the rings of a geometry.
void collect(OGRGeometryH geometry, Outline& outline) {
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i)
        collect(OGR_G_GetGeometryRef(geometry, i), outline);
    const int count = OGR_G_GetGeometryCount(geometry) == 0 ? OGR_G_GetPointCount(geometry) : 0;
    if (count <= 0) return;
    std::vector<glm::dvec2>& ring = outline.emplace_back(static_cast<std::size_t>(count));
    OGR_G_GetPoints(geometry, &ring.front().x, sizeof(glm::dvec2), &ring.front().y,
                    sizeof(glm::dvec2), nullptr, 0);
}

std::optional<geo::Crs> crs_of(OGRLayerH layer, TileCollector& tiles) {
    const OGRSpatialReferenceH srs = OGR_L_GetSpatialRef(layer);
    const std::string text = wkt_of(srs);
    // "Undefined Cartesian SRS" and its like of GeoPackages.
    if (text.empty() || OSRIsLocal(srs) || lower(OSRGetName(srs)).starts_with("undefined"))
        return std::nullopt;
    return tiles.crs_of(text);
}

TileIndex read_layer(const std::string& path, const std::string& crs, TileCollector& tiles) {
    GdalMessages messages;
    const Vectors vectors = open_vectors(path);
    const OGRLayerH layer = vectors.dataset ? layer_of_tiles(vectors.dataset.get()) : nullptr;
    if (!layer) tiles.fail(fmt::format("no index of tiles, {}", messages.failure(path)));
    const std::optional<geo::Crs> outlines_crs =
        crs.empty() ? crs_of(layer, tiles) : tiles.crs_of(crs);
    const OGRFeatureDefnH fields = OGR_L_GetLayerDefn(layer);
    const int location = OGR_FD_GetFieldIndex(fields, kLocation);
    const int tile_crs = crs.empty() ? OGR_FD_GetFieldIndex(fields, kTileCrs) : -1;
    if (OGR_L_GetFeatureCount(layer, FALSE) > static_cast<GIntBig>(kMostTiles))
        tiles.fail(
            fmt::format("an index of {} tiles, expected at most {}; cut it up, for example "
                        "with ogr2ogr -spat",
                        OGR_L_GetFeatureCount(layer, FALSE), kMostTiles));
    OGR_L_ResetReading(layer);
    Outline outline;
    while (const Feature feature{OGR_L_GetNextFeature(layer)}) {
        outline.clear();
        if (const OGRGeometryH geometry = OGR_F_GetGeometryRef(feature.get()))
            collect(geometry, outline);
        const bool has_crs = tile_crs >= 0 && OGR_F_IsFieldSetAndNotNull(feature.get(), tile_crs);
        tiles.add(OGR_F_GetFieldAsString(feature.get(), location), outline, outlines_crs,
                  has_crs ? OGR_F_GetFieldAsString(feature.get(), tile_crs) : "");
    }
    if (messages.any_failure())
        tiles.fail(fmt::format("cannot be read to its end, {}; the file is damaged or incomplete",
                               printable(messages.failure(path))));
    return tiles.take(GDALGetDriverShortName(GDALGetDatasetDriver(vectors.dataset.get())));
}

TileIndex read(const std::string& path, const std::string& crs, TileCollector& tiles) {
    prepare_gdal();
    refuse_unreadable(path);
    if (is_json(path)) {
        refuse_long_json(path, size_by_vsi(AllowedName(path)).value_or(0));
    }
    if (!is_json(path) || json_kind(path) != JsonKind::Stac) return read_layer(path, crs, tiles);
    const std::string text =
        is_packed(path) ? unpacked(path, kMostJson) : bytes_of(path, kMostJson + 1);
    refuse_long_json(path, text.size());
    return read_stac(text, crs, tiles);
}

}  // namespace

bool is_index_name(const std::string& path) {
    return contains(kEndings, ending_of(path));
}

bool is_tile_index(const std::string& path) {
    if (!is_index_name(path)) return false;
    prepare_gdal();
    const GdalMessages messages;
    if (!size_by_vsi(AllowedName(path))) return false;
    refuse_unreadable(path);
    // Which takes a look; opening would read all of it.
    if (is_json(path)) return json_kind(path) != JsonKind::Other;
    const Vectors vectors = open_vectors(path);
    return vectors.dataset && layer_of_tiles(vectors.dataset.get());
}

std::string why_no_index(const std::string& path) {
    constexpr int kMostNamed = 8;
    if (!is_index_name(path)) return "";
    if (size_by_vsi(AllowedName(path)).value_or(kMostJson + 1) > kMostJson) return "";
    const GdalMessages messages;
    const Vectors vectors = open_vectors(path);
    if (!vectors.dataset || layer_of_tiles(vectors.dataset.get())) return "";
    const OGRLayerH layer = GDALDatasetGetLayer(vectors.dataset.get(), 0);
    const auto type = layer ? OGR_GT_Flatten(OGR_L_GetGeomType(layer)) : wkbNone;
    if (type != wkbPolygon && type != wkbMultiPolygon) return "";
    const OGRFeatureDefnH fields = OGR_L_GetLayerDefn(layer);
    std::vector<std::string> names;
    for (int i = 0; i < std::min(kMostNamed, OGR_FD_GetFieldCount(fields)); ++i)
        names.push_back(printable(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(fields, i))));
    return fmt::format("polygons without a field \"{}\", which an index of tiles has; {}",
                       kLocation,
                       names.empty() ? std::string("they have no fields")
                                     : fmt::format("their fields are {}", fmt::join(names, ", ")));
}

TileIndex read_tile_index(const std::string& path, const std::string& crs,
                          const geo::Crs* tiles_crs) {
    TileCollector tiles(path, tiles_crs);
    return read(path, crs, tiles);
}

std::vector<std::string> tile_locations(const std::string& path) {
    TileCollector tiles(path, nullptr, TileCollector::Wanted::Locations);
    TileIndex index = read(path, "", tiles);
    std::vector<std::string> locations;
    locations.reserve(index.tiles.size());
    for (IndexedTile& tile : index.tiles)
        locations.push_back(std::move(tile.location));
    return locations;
}

void refuse_remote_tiles(const TileIndex& index) {
    const AllowedName name(index.path);
    for (const IndexedTile& tile : index.tiles)
        if (!name.allows(tile.location))
            refuse(printable(index.path),
                   fmt::format("its tiles are on the net ('{}'), which is asked only by a name on "
                               "the command line; name the index itself there "
                               "(/vsicurl/https://...), or fetch the tiles and write their paths "
                               "into \"{}\"",
                               printable(tile.location), kLocation));
}

}  // namespace relevo::dem

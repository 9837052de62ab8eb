#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "dem/interpret.h"
#include "dem/tile_index_parts.h"

// source: STAC 1.1 Item specification, and its Projection extension 2.0 (proj:code, proj:epsg of
// 1.x, proj:wkt2, proj:shape, proj:transform, proj:bbox).

namespace relevo::dem {
namespace {

using nlohmann::json;

constexpr int kDeepest = 32;
constexpr double kMostPosts = 1e9;  // a side

/// A member of an asset, else of the Item's properties; null where neither has it.
const json* member(const json& item, const json& asset, const char* key) {
    for (const json* object : {&asset, item.contains("properties") ? &item["properties"] : nullptr})
        if (object && object->is_object())
            if (const auto found = object->find(key); found != object->end() && !found->is_null())
                return &*found;
    return nullptr;
}

/// The asset that has the heights: the first GeoTIFF with the role "data", else the first with that
/// role, else the first GeoTIFF; null where there is none.
const json* asset_of(const json& item) {
    if (!item.contains("assets") || !item["assets"].is_object()) return nullptr;
    const json* best = nullptr;
    int best_rank = 0;
    for (const auto& [key, asset] : item["assets"].items()) {
        if (!asset.is_object() || !asset.contains("href") || !asset["href"].is_string()) continue;
        bool is_data = false;
        if (asset.contains("roles") && asset["roles"].is_array())
            for (const json& role : asset["roles"])
                is_data = is_data || (role.is_string() && role.get<std::string>() == "data");
        const std::string href = lower(asset["href"].get<std::string>());
        const bool is_tiff = asset.contains("type") && asset["type"].is_string()
                                 ? asset["type"].get<std::string>().starts_with("image/tiff")
                                 : href.ends_with(".tif") || href.ends_with(".tiff");
        const int rank = (is_data ? 2 : 0) + (is_tiff ? 1 : 0);
        if (rank > best_rank) {
            best = &asset;
            best_rank = rank;
        }
    }
    return best;
}

class StacReader {
  public:
    StacReader(std::string crs, TileCollector& tiles)
        : tiles_(tiles), crs_(std::move(crs)), wgs84_(geo::Crs()) {
        tiles_.set_uris();
        if (!crs_.empty()) tiles_.set_crs(tiles_.crs_of(crs_));
    }

    void item(const json& item) {
        const json* const asset = asset_of(item);
        const std::string id = item.contains("id") && item["id"].is_string()
                                   ? printable(item["id"].get<std::string>().substr(0, 80))
                                   : "";
        ++count_;
        const auto fail = [&](const std::string& what) {
            tiles_.fail(fmt::format("Item {} ('{}'): {}", count_, id, what));
        };
        if (!asset) fail("no asset that is a GeoTIFF or has the role \"data\"");
        const std::string href = (*asset)["href"];
        const std::string crs = crs_.empty() ? crs_text(item, *asset) : crs_;
        std::string why;
        if (const auto posts = posts_of(item, *asset, why)) {
            if (crs.empty()) fail("proj:transform without proj:code");
            return tiles_.add(href, *posts, crs, {outline_of(item), box_of(item)});
        }
        if (!why.empty()) fail(why);
        if (const json* box = member(item, *asset, "proj:bbox"); box && !crs.empty())
            return tiles_.add(href, {corners(numbers(*box), /*in_degrees=*/false)},
                              tiles_.crs_of(crs), crs);
        // What a polygon of GeoJSON is in.
        tiles_.add(href, outline_of(item), wgs84_, crs);
    }

  private:
    static std::string crs_text(const json& item, const json& asset) {
        if (const json* code = member(item, asset, "proj:code"); code && code->is_string())
            return code->get<std::string>();
        if (const json* epsg = member(item, asset, "proj:epsg"); epsg && epsg->is_number_integer())
            return fmt::format("EPSG:{}", epsg->get<std::int64_t>());
        if (const json* wkt = member(item, asset, "proj:wkt2"); wkt && wkt->is_string())
            return wkt->get<std::string>();
        return "";
    }

    /// Numbers of a list; NaN for what is none.
    static std::vector<double> numbers(const json& list) {
        std::vector<double> result;
        if (list.is_array())
            for (const json& value : list)
                result.push_back(value.is_number() ? value.get<double>() : NAN);
        return result;
    }

    /// The corners of [west, south, east, north], also with heights between; none of other lists.
    static std::vector<glm::dvec2> corners(const std::vector<double>& box, bool in_degrees) {
        if (box.size() != 4 && box.size() != 6) return {};
        const std::size_t second = box.size() / 2;
        // RFC 7946, section 5.2: across the antimeridian west is greater than east.
        const double east = box[second] + (in_degrees && box[second] < box[0] ? 360 : 0);
        return {
            {box[0], box[1]}, {east, box[1]}, {east, box[second + 1]}, {box[0], box[second + 1]}};
    }

    /// @param why  filled with what is wrong; empty where the Item states no posts
    static std::optional<TilePosts> posts_of(const json& item, const json& asset,
                                             std::string& why) {
        const json* const shape = member(item, asset, "proj:shape");
        const json* const transform = member(item, asset, "proj:transform");
        if (!shape || !transform) return std::nullopt;
        const std::vector<double> size = numbers(*shape), t = numbers(*transform);
        const auto is_size = [](double n) {
            return n >= 1 && n <= kMostPosts && n == std::floor(n);
        };
        if (size.size() != 2 || !is_size(size[0]) || !is_size(size[1])) {
            why = fmt::format("proj:shape, expected [rows, columns] but got {}",
                              shape->dump().substr(0, 80));
            return std::nullopt;
        }
        const double area = t.size() >= 6 ? t[0] * t[4] - t[1] * t[3] : 0;
        if ((t.size() != 6 && t.size() != 9) || !std::isfinite(area + t[2] + t[5]) || area == 0) {
            why = fmt::format(
                "proj:transform, expected six numbers of cells with an area but got "
                "{}",
                transform->dump().substr(0, 80));
            return std::nullopt;
        }
        const std::array<double, 6> g = {t[2], t[0], t[1], t[5], t[3], t[4]};
        return TilePosts{static_cast<int>(size[1]), static_cast<int>(size[0]),
                         Affine::of_geotransform(g)};
    }

    /// Rings of the geometry, else the bbox.
    static Outline outline_of(const json& item) {
        Outline outline;
        const auto geometry = item.find("geometry");
        if (geometry != item.end() && geometry->is_object() && geometry->contains("coordinates"))
            add_rings((*geometry)["coordinates"], outline);
        return outline.empty() ? box_of(item) : outline;
    }

    /// The bbox.
    static Outline box_of(const json& item) {
        if (!item.contains("bbox")) return {};
        return {corners(numbers(item["bbox"]), /*in_degrees=*/true)};
    }

    /// Of polygons, however deep in lists. No deeper than kDeepest, by the parser.
    static void add_rings(const json& list, Outline& outline) {
        const auto has_lists = [](const json& of) {
            return of.is_array() && !of.empty() && of[0].is_array();
        };
        if (!has_lists(list)) return;
        if (has_lists(list[0])) {
            for (const json& inner : list)
                add_rings(inner, outline);
            return;
        }
        std::vector<glm::dvec2>& ring = outline.emplace_back();
        for (const json& at : list) {
            const std::vector<double> position = numbers(at);
            ring.push_back(position.size() >= 2 ? glm::dvec2(position[0], position[1])
                                                : glm::dvec2(NAN));
        }
    }

    TileCollector& tiles_;
    std::string crs_;
    std::optional<geo::Crs> wgs84_;
    std::size_t count_ = 0;
};

}  // namespace

TileIndex read_stac(const std::string& text, const std::string& crs, TileCollector& tiles) {
    StacReader reader(crs, tiles);
    bool in_features = false;
    // Items are taken and dropped one by one, so that their number costs no memory.
    const auto callback = [&](int depth, json::parse_event_t event, json& parsed) {
        using Event = json::parse_event_t;
        if (depth > kDeepest) return false;
        if (event == Event::key && depth == 1) in_features = parsed == "features";
        if (event != Event::object_end || depth != 2 || !in_features) return true;
        reader.item(parsed);
        return false;
    };
    json root;
    try {
        root = json::parse(text, callback);
    } catch (const json::out_of_range&) {
        tiles.fail("a number too large for a program, expected JSON of a STAC catalogue");
    } catch (const json::parse_error& error) {
        tiles.fail(
            fmt::format("no well-formed JSON at byte {}; the file is damaged or "
                        "incomplete",
                        error.byte));
    }
    if (root.is_object() && root.value("type", json()) == "Feature") reader.item(root);
    return tiles.take("STAC");
}

}  // namespace relevo::dem

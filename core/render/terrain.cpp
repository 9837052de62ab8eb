#include "render/terrain.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_set>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include "base/error.h"
#include "base/units.h"
#include "render/pages.h"
#include "render/tile_grid.h"
#include "scene/map_view.h"

namespace relevo::render {
namespace {

constexpr int kMaxHeightPages = 1024;  // 73 MB
constexpr int kMaxNormalPages = 384;   // 102 MB

/// Parts of MemoryBudget::view_bytes for pages of heights, and for those of normals, water and
/// rasters, whose texels all have four bytes.
constexpr std::int64_t kHeightPart = 5;  // one in so many
constexpr std::int64_t kHeightPageBytes = std::int64_t{kHeightPage_px} * kHeightPage_px * 16;
/// What Mesa's software device keeps of triangles until they are drawn, as measured; that of few is
/// lost among what is measured besides.
constexpr std::int64_t kTriangleBytes = 300, kFewTriangles = 100'000;
constexpr std::int64_t kNormalPageBytes = std::int64_t{kNormalPage_px} * kNormalPage_px * 4;

int height_slots_in(const MemoryBudget& memory) {
    return static_cast<int>(std::min<std::int64_t>(
        kMaxHeightPages, memory.view_bytes / kHeightPart / kHeightPageBytes));
}

/// @param layers  that share the memory
int normal_slots_in(const MemoryBudget& memory, std::int64_t layers) {
    return static_cast<int>(std::min<std::int64_t>(
        kMaxNormalPages,
        memory.view_bytes * (kHeightPart - 1) / kHeightPart / (layers * kNormalPageBytes)));
}

/// A view would be coarser than with more memory. Views that the default has no room for are
/// coarser instead.
/// @param view_bytes  that it needs at least
/// @throws Error (BadInput) if the memory is less than the default
void refuse_coarser(const MemoryBudget& memory, std::int64_t view_bytes) {
    std::int64_t mib = memory.mib();
    if (mib >= MemoryBudget::kDefault_mib) return;
    while (mib < MemoryBudget::kDefault_mib && MemoryBudget::of_mib(mib).view_bytes < view_bytes)
        ++mib;
    bad_input(
        fmt::format("--memory {}: this view needs --memory {} or more for its tiles, or a "
                    "smaller --size",
                    memory.mib(), mib));
}

/// Factor of the tolerance between attempts.
constexpr double kCoarser = 1.2;

std::uint64_t next_serial() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

int tiles_of_all_levels(const dem::Pyramid& pyramid) {
    int sum = 0;
    for (int level = 0; level < pyramid.levels(); ++level) {
        const glm::ivec2 count = pyramid.tiles(level);
        sum += count.x * count.y;
    }
    return sum;
}

int pages_across(int posts, int level) {
    const int posts_a_page = kNormalNodes << level;
    return std::max(1, (posts - 1 + posts_a_page - 1) / posts_a_page);
}

/// Columns and rows that a part of a map shows, from x, y to z, w, with a margin.
glm::dvec4 posts_of(const scene::MapView& map, const PicturePart& part,
                    const glm::ivec2& frame_px) {
    constexpr double kMargin_px = 64;  // for effects that read the ground around a pixel
    constexpr double kMargin_posts = 8;
    const glm::dvec2 frame(frame_px);
    const glm::dvec2 upper_left(part.corner_px.x, part.picture_px.y - part.corner_px.y - frame.y);
    const glm::dvec2 a = map.post(upper_left - kMargin_px),
                     b = map.post(upper_left + frame + kMargin_px),
                     c = map.post(upper_left + glm::dvec2(frame.x + kMargin_px, -kMargin_px)),
                     d = map.post(upper_left + glm::dvec2(-kMargin_px, frame.y + kMargin_px));
    return {glm::min(glm::min(a, b), glm::min(c, d)) - kMargin_posts,
            glm::max(glm::max(a, b), glm::max(c, d)) + kMargin_posts};
}

/// The next tolerance to try.
double coarser(double tolerance) {
    return tolerance > 0 ? tolerance * kCoarser : 1e-5;
}

gl::Texture nothing_to_tell(const char* label) {
    gl::Texture texture(gl::TextureKind::D2Array, gl::Format::RGBA8, {1, 1, 1}, 1, label);
    texture.write(0, {0, 0, 0}, {1, 1, 1}, std::vector<std::byte>(4));
    return texture;
}

}  // namespace

Terrain::Terrain(const dem::Heightfield& heightfield, const geo::LocalFrame& frame,
                 const TerrainOptions& options, const dem::Source* finer)
    : serial_(next_serial()),
      options_(options),
      own_pyramid_(options.pyramid
                       ? std::nullopt
                       : std::optional(dem::Pyramid::of(heightfield, finer, options.memory))),
      pyramid_(options.pyramid ? *options.pyramid : *own_pyramid_),
      grid_(finer && heightfield.reduction > 1 ? finer->grid() : heightfield.grid),
      frame_(frame),
      tree_(pyramid_, grid_, frame_),
      polar_axis_(frame.up(kPi / 2, 0)),
      natural_(grid_, frame_, pyramid_, options.climate_alone),
      light_(heightfield, frame, options.sky, options.shadows_on, options.memory.light_posts),
      height_means_(heightfield),
      drawn_m_(&heightfield.height_m),
      drawn_grid_(&heightfield.grid),
      reduction_(finer ? heightfield.reduction : 1),
      sides_(pyramid_) {
    options_.sky = {};  // light_ holds it
    const glm::dvec2 spacing_m = grid_.post_spacing_m();
    normal_spacing_m_ = std::sqrt(spacing_m.x * spacing_m.y);
    normal_levels_ = std::max(1, pyramid_.levels() - kNormalPageLevels);

    const int most = options.max_array_layers;
    heights_ =
        PageCache({{"height_pages", gl::Format::RGBA32F, kHeightPage_px, gl::Filter::Nearest,
                    [this](const TileKey& key) {
                        return bytes_of(height_page(pyramid_, key.level, key.at));
                    }}},
                  std::min({tiles_of_all_levels(pyramid_), height_slots_in(options.memory), most}));
    int normal_count = 0;
    for (int level = 0; level < normal_levels_; ++level)
        normal_count +=
            pages_across(pyramid_.columns(), level) * pages_across(pyramid_.rows(), level);
    normal_layers_ = std::min({normal_count, kMaxNormalPages, most});
    page_table_ =
        PageTable(std::max(pages_across(pyramid_.columns(), 0), pages_across(pyramid_.rows(), 0)),
                  "page table");
}

void Terrain::displace(const Displacement& displacement) {
    if (displacement == tree_.displacement()) return;
    tree_.displace(displacement);
    serial_ = next_serial();
}

bool Terrain::winds_counterclockwise() {
    const PatchNet& net = tree_.net(tree_.root());
    return dot(cross(net.position_m[3], net.position_m[1]), net.vertical[0]) > 0;
}

std::vector<std::byte> Terrain::make_normals(const TileKey& key) const {
    const glm::ivec2 first = key.at * (kNormalNodes << key.level);
    const PatchNet net = fit_patch_net(
        [&](double column, double row) { return grid_.place(column, row); }, frame_,
        glm::dvec2(first), glm::dvec2(span_on_dem(pyramid_, first, kNormalNodes << key.level)));
    return bytes_of(normal_page(pyramid_, key.level, key.at, net, polar_axis_));
}

void Terrain::update_surface_layers() {
    if (surface_.find("normal_pages")) return;
    std::vector<PageLayer> layers{{"normal_pages", gl::Format::RG16Snorm, kNormalPage_px,
                                   gl::Filter::Linear,
                                   [this](const TileKey& key) { return make_normals(key); }}};
    if (has_surface_pages_)
        layers.push_back({"surface_pages", gl::Format::R32F, kNormalPage_px, gl::Filter::Nearest,
                          [this](const TileKey& key) {
                              return bytes_of(surface_page(pyramid_, key.level, key.at));
                          }});
    if (water_)
        layers.push_back({"water_pages", gl::Format::RGBA8, kNormalPage_px, gl::Filter::Linear,
                          [this](const TileKey& key) { return make_water(key); },
                          options_.land_cover ? 2 : 1});
    if (options_.houses)
        layers.push_back({"house_pages", gl::Format::RGBA8, kNormalPage_px, gl::Filter::Linear,
                          [this](const TileKey& key) {
                              return bytes_of(
                                  overlay_page(*options_.houses, pyramid_, key.level, key.at));
                          }});
    const std::int64_t slices = std::ssize(layers) + (water_ && options_.land_cover ? 1 : 0);
    surface_bytes_ = slices * kNormalPageBytes;
    const int in_memory = normal_slots_in(options_.memory, slices);
    surface_ = PageCache(std::move(layers), std::min(normal_layers_, in_memory));
}

std::vector<std::byte> Terrain::make_water(const TileKey& key) const {
    std::vector<std::byte> texels = bytes_of(water_->page(pyramid_, key.level, key.at));
    if (!options_.land_cover) return texels;
    const std::vector<std::byte> cover =
        bytes_of(photo_page(*options_.land_cover, OverlayTexels{}, key.level, key.at));
    texels.insert(texels.end(), cover.begin(), cover.end());
    return texels;
}

void Terrain::set_overlay(std::shared_ptr<const OverlayRaster> raster) {
    NamedRasters rasters;
    if (raster) rasters.emplace("overlay", std::move(raster));
    overlay_.set(std::move(rasters), pyramid_, normal_spacing_m_, raster_slots());
}

void Terrain::set_rasters(NamedRasters rasters) {
    rasters_.set(std::move(rasters), pyramid_, normal_spacing_m_, raster_slots());
}

int Terrain::raster_slots() const {
    constexpr std::int64_t kSurfaceLayers = 3;
    return std::min(normal_slots_in(options_.memory, kSurfaceLayers + 1),
                    options_.max_array_layers);
}

void Terrain::write(GroundBlock& block) const {
    const glm::vec2 posts(pyramid_.columns(), pyramid_.rows());
    block.posts = glm::vec4(posts, 1.0F / posts);
    block.normal_levels = static_cast<float>(normal_levels_);
    block.normal_texels_per_m = static_cast<float>(1 / normal_spacing_m_);
    const RasterPlace overlay = overlay_.place("overlay");
    block.overlay_texels = overlay.place;
    block.overlay_shape = overlay.shape;
    block.land_cover = glm::vec4(options_.land_cover ? 1 : 0, 0, 0, 0);
}

void Terrain::require_water_pages() {
    if (has_water_pages_) return;
    has_water_pages_ = true;
    if (!options_.water) own_water_ = dem::find_water(*drawn_m_, *drawn_grid_);
    const dem::Water& water = options_.water ? *options_.water : *own_water_;
    if (!water.any() && !options_.filled && !options_.land_cover) {
        dry_ = nothing_to_tell("dry ground");
        return;
    }
    water_.emplace(*drawn_m_, water, options_.filled, reduction_);
    surface_ = PageCache();
}

void Terrain::require_house_pages() {
    if (!options_.houses && bare_.name() == 0) bare_ = nothing_to_tell("ground without houses");
}

void Terrain::require_surface_pages() {
    if (has_surface_pages_) return;
    has_surface_pages_ = true;
    surface_ = PageCache();
}

const gl::Texture* Terrain::texture(std::string_view name) const {
    if (const gl::Texture* const natural = natural_.texture(name)) return natural;
    if (name == kHeightMeansTexture) return height_means_.texture();
    if (name == "page_table") return &page_table_.texture();
    if (name == "water_pages" && dry_.name() != 0) return &dry_;
    if (name == "house_pages" && bare_.name() != 0) return &bare_;
    if (const gl::Texture* const heights = heights_.find(name)) return heights;
    if (const gl::Texture* const light = light_.texture(name)) return light;
    if (const gl::Texture* const raster = overlay_.texture(name)) return raster;
    if (const gl::Texture* const raster = rasters_.texture(name)) return raster;
    if (const gl::Texture* const field = fields_.texture(name)) return field;
    return surface_.find(name);
}

double Terrain::tolerance_in_budget(const LodView& wanted) {
    LodView view = wanted;
    while (!in_budget(wanted, view.tolerance, tree_.select(view)))
        view.tolerance = coarser(view.tolerance);
    return view.tolerance;
}

TileSelection Terrain::select(const LodView& wanted, const TileSelection* keep) {
    LodView view = wanted;
    std::vector<TileDraw> draws;
    std::vector<TileKey> keys;
    // A quarter of the slots is reserved for selections that are kept.
    const auto room_of = [&](int slots) {
        return keep || slots == tiles_of_all_levels(pyramid_) ? slots : slots - slots / 4;
    };
    const int room = room_of(heights_.slots());
    const int room_in_more_memory = room_of(std::min(kMaxHeightPages, options_.max_array_layers));
    while (true) {
        draws = tree_.select(view);
        keys.clear();
        std::unordered_set<std::uint64_t> named;
        const auto name = [&](const TileKey& key) {
            if (named.insert(key.packed()).second) keys.push_back(key);
        };
        if (keep)
            for (const TileSelection::Tile& tile : keep->tiles_)
                name(tile.draw.key);
        for (const TileDraw& draw : draws)
            name(draw.key);
        const auto pages = static_cast<int>(keys.size());
        const bool is_coarse_enough = !view.eye_m || in_budget(wanted, view.tolerance, draws);
        if (pages <= room && is_coarse_enough) break;
        if (is_coarse_enough && pages <= room_in_more_memory)
            refuse_coarser(options_.memory,
                           kHeightPart * kHeightPageBytes * (pages + pages / 3 + 1));
        view.tolerance = coarser(view.tolerance);
    }
    heights_.require(keys);
    TileSelection selection = ready(view, draws);
    view_bytes_ = std::ssize(keys) * kHeightPageBytes +
                  std::max<std::int64_t>(0, selection.triangles_ - kFewTriangles) * kTriangleBytes;
    return selection;
}

TileSelection Terrain::select_in_background(const LodView& wanted) {
    LodView view = wanted;
    const TileKey root = tree_.root();
    heights_.require(std::span(&root, 1));
    const auto is_there = [&](const TileKey& key) { return heights_.slot(key) >= 0; };
    std::vector<TileDraw> draws;
    std::vector<TileKey> keys;
    const int slots = heights_.slots();
    const int room = slots == tiles_of_all_levels(pyramid_) ? slots : slots - slots / 4;
    while (true) {
        keys.clear();
        draws = tree_.select(view, TileTree::Resident{is_there, keys});
        if (static_cast<int>(keys.size()) <= room && in_budget(wanted, view.tolerance, draws))
            break;
        view.tolerance = coarser(view.tolerance);
    }
    complete_ = std::ranges::all_of(keys, is_there);
    TileSelection selection = ready(view, draws);
    // Coarse pages first: they replace all finer ones.
    std::ranges::stable_sort(keys,
                             [](const TileKey& a, const TileKey& b) { return a.level > b.level; });
    heights_.request(keys);
    return selection;
}

TileSelection Terrain::ready(const LodView& view, const std::vector<TileDraw>& draws) {
    const LodRanges ranges = view.eye_m ? tree_.ranges(view) : LodRanges{};
    TileSelection selection;
    selection.tolerance_ = view.tolerance;
    for (const TileDraw& draw : draws) {
        TileSelection::Tile tile{draw, static_cast<float>(heights_.slot(draw.key))};
        if (view.eye_m) {
            const LodRanges::Range& level = ranges.levels[static_cast<std::size_t>(draw.key.level)];
            if (std::isfinite(level.range_m)) {
                tile.morph_start_m = static_cast<float>(level.morph_start_m);
                tile.per_morph_m = static_cast<float>(1 / (level.range_m - level.morph_start_m));
            }
        }
        selection.tiles_.push_back(tile);
        for (int q = 0; q < 4; ++q)
            selection.triangles_ += (draw.quadrants >> q & 1) * kQuadrantIndices / 3;
    }
    return selection;
}

double Terrain::pixel_error(double exaggeration) const {
    return options_.pixel_error * std::clamp(exaggeration, 1.0, 2.0);
}

LodView Terrain::view_of(const FrameInputs& inputs, const glm::ivec2& picture_px) const {
    const bool around = inputs.part && inputs.part->of_panorama;
    const auto make = around ? LodView::around_camera : LodView::of_camera;
    return make(inputs.camera, picture_px.x, picture_px.y, pixel_error(inputs.exaggeration),
                inputs.exaggeration);
}

TileSelection Terrain::select_for_frame(const FrameInputs& inputs, const glm::ivec2& picture_px,
                                        const glm::ivec2& frame_px) {
    const LodView view = view_of(inputs, picture_px);
    tree_.begin_frame();
    complete_ = true;
    TileSelection selection =
        inputs.loading == Loading::Background ? select_in_background(view) : select(view);
    update_surface_layers();
    // Levels of pages depend on the distance alone.
    LodView pixels =
        LodView::of_camera(inputs.camera, picture_px.x, picture_px.y, 1, inputs.exaggeration);
    if (inputs.camera.map && inputs.part)
        pixels.posts = posts_of(*inputs.camera.map, *inputs.part, frame_px);
    prepare_surface(pixels, inputs.loading, inputs.deterministic);
    for (GroundRasters* const rasters : {&overlay_, &rasters_})
        complete_ =
            rasters->prepare(tree_, pixels, inputs.loading, inputs.deterministic) && complete_;
    return selection;
}

std::optional<Terrain::Extent> Terrain::extent(const glm::dmat3& axes, double exaggeration,
                                               const TileSelection* selection,
                                               double nearer_than_m) {
    Extent extent{glm::dvec3(1e300), glm::dvec3(-1e300)};
    const auto add = [&](const TileKey& key) {
        const Box box = tree_.box(key, exaggeration);
        const glm::dvec3 middle = 0.5 * (box.low + box.high);
        const glm::dvec3 half = 0.5 * (box.high - box.low);
        for (int i = 0; i < 3; ++i) {
            const double at = dot(middle, axes[i]);
            const double reach = dot(half, abs(axes[i]));
            extent.low[i] = std::min(extent.low[i], at - reach);
            extent.high[i] = std::max(extent.high[i], at + reach);
        }
    };
    if (selection) {
        for (const TileSelection::Tile& tile : selection->tiles_)
            if (tile.draw.distance_m < nearer_than_m) add(tile.draw.key);
    } else {
        const int level = std::max(0, tree_.root().level - 3);
        const glm::ivec2 count = pyramid_.tiles(level);
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x)
                if (!pyramid_.bounds(level, {x, y}).empty()) add({level, {x, y}});
    }
    if (extent.low.x > extent.high.x) return std::nullopt;
    return extent;
}

void Terrain::prepare_surface(const LodView& view, Loading loading, bool deterministic) {
    // A page is needed if its texels are not smaller than a pixel. Pixels are measured by depth,
    // which is less than distance in the corners of the frame.
    constexpr double kCorner = 0.7;
    std::vector<TileKey> pages;
    for (double scale = 1;; scale *= kCoarser) {
        pages.clear();
        const auto wanted = [&](int tile_level, double distance_m) {
            const int level = std::max(tile_level - kNormalPageLevels, 0);
            return kCorner * distance_m * view.tolerance * scale <
                   normal_spacing_m_ * std::exp2(level);
        };
        tree_.visit(view, tree_.root(), kNormalPageLevels, wanted, [&](const TileKey& key) {
            pages.push_back({std::max(key.level - kNormalPageLevels, 0), key.at});
        });
        if (static_cast<int>(pages.size()) <= surface_.slots()) break;
        if (loading == Loading::Wait && surface_.slots() < normal_layers_)
            refuse_coarser(options_.memory,
                           kHeightPart * std::ssize(pages) * surface_bytes_ / (kHeightPart - 1));
    }
    const std::int64_t needed = view_bytes_ + std::ssize(pages) * surface_bytes_;
    if (loading == Loading::Wait && needed > options_.memory.view_bytes)
        refuse_coarser(options_.memory, needed);
    const bool came = surface_.load(pages, loading);
    complete_ = complete_ && std::ranges::all_of(pages, [&](const TileKey& page) {
                    return surface_.slot(page) >= 0;
                });
    if (came || deterministic || table_is_narrowed_)
        page_table_.write(surface_, deterministic ? &pages : nullptr);
    table_is_narrowed_ = deterministic;
}

TileMesh::Instance Terrain::instance_of(const TileSelection::Tile& tile,
                                        const glm::dvec3& origin_m) {
    const auto with = [](const glm::dvec3& v, double w) { return glm::vec4(glm::vec3(v), w); };
    const TileKey& key = tile.draw.key;
    const PatchNet& net = tree_.net(key);
    const auto& p = net.position_m;
    const dem::Pyramid::Bounds bounds = pyramid_.bounds(key.level, key.at);
    const glm::ivec2 first_post = key.at * (kTileQuads << key.level);
    const double posts_a_quad = 1 << key.level;
    const glm::dvec2 quads =
        glm::dvec2(span_on_dem(pyramid_, first_post, kTileQuads << key.level)) / posts_a_quad;
    return {with(net.centre_m - origin_m + p[0], quads.x),
            with(p[1], quads.y),
            with(p[2], tile.height_layer),
            with(p[3], first_post.x),
            with(p[4], first_post.y),
            with(p[5], posts_a_quad),
            with(p[6], tile.morph_start_m),
            with(p[7], tile.per_morph_m),
            with(p[8], bounds.lowest_m),
            with(net.vertical[0], bounds.highest_m),
            with(net.vertical[1], 0),
            with(net.vertical[2], 0)};
}

std::vector<TileMesh::Tile> Terrain::tiles_of(const TileSelection& selection,
                                              const glm::dvec3& origin_m) {
    std::vector<TileMesh::Tile> tiles;
    tiles.reserve(selection.tiles_.size());
    for (const TileSelection::Tile& tile : selection.tiles_)
        tiles.push_back({tile.draw.key, tile.draw.quadrants, instance_of(tile, origin_m)});
    return tiles;
}

void Terrain::draw(const TileSelection& selection, const glm::dvec3& origin_m) {
    mesh_.draw(tiles_of(selection, origin_m));
}

void Terrain::draw_sides(const TileSelection& selection, const glm::dvec3& origin_m) {
    mesh_.draw_sides(tiles_of(selection, origin_m), sides_);
}

}  // namespace relevo::render

#include "render/device_shadows.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"
#include "gl/errors.h"
#include "render/draw_watch.h"
#include "shader/core_texts.h"

// The dispatches are not passes of the frame graph. Their number depends on the tiles of the sun,
// which are known after the sun has moved, and effects have no GLSL in them.
//
// light_sweep.comp.glsl repeats light::ShadowStrip and its kernels: change both. Tests:
// DeviceShadows.*.
namespace relevo::render {
namespace {

using light::SunTerrain;
using light::TileSweep;
using DeviceSweep = light::Clearances::DeviceSweep;

constexpr unsigned kSweepLines = 64, kSide = 8;  // of work groups, as the programs have them
constexpr float kNight_m = 1e9F;                 // a shadow over any ground

gl::ComputeProgram program(const std::string& name) {
    const shader::FolderTexts core(share_dir() / "shaders");
    const std::string file = name + ".comp.glsl";
    const std::optional<std::string> text = core.text(file);
    if (!text) failed(fmt::format("{}: no such file", core.file(file)));
    return {*text, name};
}

unsigned groups(int count, unsigned size) {
    return (static_cast<unsigned>(count) + size - 1) / size;
}

/// A tile of light_sweep.comp.glsl: members of four bytes in its order.
struct Tile {
    std::int32_t first_row, rows, first_line, end_line, first_crossing, columns;
    std::int32_t is_transposed, first_index, index_step;
    std::int32_t heights_pitch, found_pitch, found_column;
    float height_origin_m, floor_m;
    std::int32_t mixes;
    float mix_lowest_m, mix_per_m;
    std::int32_t earth_edges, earth_edge_count, earth_rows, earth_bases, earth_column;
    float earth_per_post, earth_curvature, earth_lowest_m;
};
static_assert(sizeof(Tile) == 25 * 4);

/// The tables of some tiles, one after another.
class Tables {
  public:
    Tables(const SunTerrain& terrain, const DeviceSweep& sweep) {
        for (const TileSweep& tile : sweep.tiles)
            if (!tile.tables.lines.is_empty()) add(terrain, tile, sweep.mixes);
        if (earth_.empty()) earth_.push_back(0);  // a buffer has some size
    }

    int tiles() const { return static_cast<int>(tiles_.size()); }
    int most_lines() const { return most_lines_; }

    /// Copies of them on the device, bound from a binding on. They live until the caller drops
    /// them; GL keeps them as long as the device needs them.
    std::array<gl::Buffer, 4> bind(unsigned binding) const {
        std::array<gl::Buffer, 4> buffers{gl::Buffer::of(std::span(tiles_), "light_tiles"),
                                          gl::Buffer::of(std::span(rows_), "light_rows"),
                                          gl::Buffer::of(std::span(crossings_), "light_crossings"),
                                          gl::Buffer::of(std::span(earth_), "light_earth")};
        for (const gl::Buffer& buffer : buffers)
            buffer.bind_storage(binding++);
        return buffers;
    }

  private:
    void add(const SunTerrain& terrain, const TileSweep& from, bool mixes) {
        const light::ShadowTables& tables = from.tables;
        const Window posts = terrain.window();
        Tile to{};
        to.first_row = static_cast<int>(rows_.size());
        to.rows = static_cast<int>(tables.rows.size()) - 1;
        to.first_line = tables.lines.begin;
        to.end_line = tables.lines.end;
        to.first_crossing = static_cast<int>(crossings_.size());
        to.columns = tables.columns;
        to.is_transposed = tables.orientation.transposed;
        to.first_index = tables.orientation.grid_index(tables.first_row);
        to.index_step = tables.orientation.mirrored ? -1 : 1;
        to.heights_pitch = terrain.grid().columns();
        to.found_pitch = posts.columns;
        to.found_column = posts.column;
        to.height_origin_m = tables.height_origin_m;
        to.floor_m = tables.floor_m;
        to.mixes = mixes;
        to.mix_lowest_m = static_cast<float>(terrain.lowest_m());
        to.mix_per_m = static_cast<float>(1 / terrain.relief_m());
        to.earth_rows = -1;
        if (from.earth) add(*from.earth, to);
        rows_.insert(rows_.end(), tables.rows.begin(), tables.rows.end());
        crossings_.insert(crossings_.end(), tables.crossings.begin(), tables.crossings.end());
        tiles_.push_back(to);
        most_lines_ = std::max(most_lines_, to.end_line - to.first_line);
    }

    void add(const TileSweep::Earth& from, Tile& to) {
        constexpr float kNowhere = -1e30F, kNoLine = 1e9F;
        const auto size = [&] { return static_cast<int>(earth_.size()); };
        to.earth_edges = size();
        to.earth_edge_count = static_cast<int>(from.edge_height_m.size());
        for (std::size_t i = 0; i < from.edge_height_m.size(); ++i) {
            earth_.push_back(std::max(from.edge_height_m[i], kNowhere));
            earth_.push_back(std::max(from.edge_distance_m[i], kNowhere));
        }
        to.earth_rows = size();
        for (const light::GroundBeyond::SweepRow& row : from.rows) {
            earth_.push_back(row.distance_m);
            earth_.push_back(std::min(static_cast<float>(row.line_column), kNoLine));
        }
        to.earth_bases = size() - from.first_row;
        earth_.insert(earth_.end(), from.base.begin(), from.base.end());
        to.earth_column = from.reference_column;
        to.earth_per_post = from.a_post;
        to.earth_curvature = from.curvature;
        to.earth_lowest_m = from.lowest_m;
    }

    std::vector<Tile> tiles_;
    std::vector<light::ShadowTables::Row> rows_;
    std::vector<light::ShadowTables::Crossing> crossings_;
    std::vector<float> earth_;
    int most_lines_ = 0;
};

/// Heights of all posts, also of those that a DEM round the Earth repeats; kNothing_m in voids.
std::vector<float> heights_of(const SunTerrain& terrain) {
    const dem::Grid& grid = terrain.grid();
    const light::WindowHeights heights(terrain.posts(), terrain.whole_grid());
    std::vector<float> height_m;
    height_m.reserve(static_cast<std::size_t>(grid.columns()) *
                     static_cast<std::size_t>(grid.rows()));
    for (int row = 0; row < grid.rows(); ++row)
        std::transform(heights.view.at(0, row), heights.view.at(0, row) + grid.columns(),
                       std::back_inserter(height_m),
                       [](float h) { return std::isnan(h) ? light::kNothing_m : h; });
    return height_m;
}

std::size_t shadow_bytes(const SunTerrain& terrain) {
    const Window posts = terrain.window();
    return sizeof(float) * static_cast<std::size_t>(posts.columns) *
           static_cast<std::size_t>(posts.rows);
}

/// Blocks of memory that programs read are smaller on some devices than buffers.
void check_fits(std::size_t bytes, const char* what) {
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (bytes > static_cast<std::size_t>(most))
        failed(fmt::format("GL buffer: {}: {} MiB, but programs of the device read {} MiB at most",
                           what, bytes >> 20, most >> 20));
}

}  // namespace

DeviceShadows::DeviceShadows()
    : sweep_(program("light_sweep")),
      clearance_(program("light_clearance")),
      fraction_(program("light_fraction")) {}

DeviceShadows::Ground::Ground(const SunTerrain& terrain) : terrain_(terrain) {
    const std::vector<float> height_m = heights_of(terrain);
    check_fits(std::as_bytes(std::span(height_m)).size(), "light_heights");
    height_m_ = gl::Buffer::of(std::span(height_m), "light_heights");
    for (gl::Buffer& part : shadow_m_)
        part = gl::Buffer(shadow_bytes(terrain), "light_shadows");
}

std::vector<float> DeviceShadows::Ground::read(DeviceSweep::Part part) const {
    std::vector<float> shadow_m(shadow_bytes(terrain_) / sizeof(float));
    shadow_m_[part].read(std::as_writable_bytes(std::span(shadow_m)));
    return shadow_m;
}

void DeviceShadows::sweep(const Ground& ground, const DeviceSweep& sweep) {
    const Tables tables(ground.terrain_, sweep);
    if (tables.tiles() == 0) return;
    ground.height_m_.bind_storage(0);
    ground.shadow_m_[sweep.part].bind_storage(1);
    const std::array<gl::Buffer, 4> buffers = tables.bind(2);
    sweep_.use();
    // The second air's sweep reads the heights that the first one's has written.
    if (sweep.mixes) glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glDispatchCompute(groups(tables.most_lines(), kSweepLines),
                      static_cast<unsigned>(tables.tiles()), 1);
}

void DeviceShadows::write_textures(const Ground& ground, bool has_disc,
                                   const gl::Texture& clearance, const gl::Texture& fraction) {
    const Window posts = ground.terrain_.window();
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    ground.height_m_.bind_storage(0);
    for (unsigned part = 0; part < 3; ++part)
        ground.shadow_m_[has_disc ? part : 0].bind_storage(1 + part);
    clearance.bind_image(0, 0, gl::Format::RG16UI);
    fraction.bind_image(1, 0, gl::Format::RG8);
    clearance_.use();
    const int uniforms[] = {posts.columns, posts.rows, ground.terrain_.grid().columns(),
                            posts.column};
    for (int location = 0; location < 4; ++location)
        clearance_.set(location, uniforms[location]);
    glDispatchCompute(groups((posts.columns + 1) / 2, kSide), groups((posts.rows + 1) / 2, kSide),
                      1);
    fraction_.use();
    for (int level = 1; level < fraction.levels(); ++level) {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        fraction.bind_image(0, level - 1, gl::Format::RG8);
        fraction.bind_image(1, level, gl::Format::RG8);
        const gl::Extent size = fraction.level_extent(level);
        glDispatchCompute(groups(size.width, kSide), groups(size.height, kSide), 1);
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

light::Clearances::Found DeviceShadows::find(const light::Clearances& clearances, Ground& ground,
                                             const geo::Geodetic& place,
                                             const light::SunOverDem& sun,
                                             const gl::Texture& clearance,
                                             const gl::Texture& fraction) {
    gl::expect_no_error("light_sweep");
    // A program that has never run may hang a device, whose driver then cannot be stopped.
    const std::vector<const shader::Snippet*> none;
    std::optional<DrawWatch> watch;
    std::optional<DrawWatch::Turn> turn;
    if (!proven_) {
        const double parts = static_cast<double>(shadow_bytes(ground.terrain_));
        turn.emplace(watch.emplace(none), ProgramText{"light_sweep", {}, {}}, parts);
    }
    for (gl::Buffer& part : ground.shadow_m_)
        part.fill(kNight_m);
    const light::Clearances::Found found =
        clearances.each_sweep(place, sun, [&](const DeviceSweep& each) { sweep(ground, each); });
    if (found.night) return found;
    write_textures(ground, sun.semidiameter_rad > 0, clearance, fraction);
    if (!proven_) glFinish();
    gl::throw_if_lost();
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        failed(fmt::format("GL program: light_sweep: {}", gl::error_name(error)));
    proven_ = true;
    return found;
}

}  // namespace relevo::render

#include "render/line_textures.h"

#include <cmath>
#include <span>

#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "dem/lines.h"
#include "effect/ground_data.h"
#include "render/eye_post.h"
#include "render/line_index.h"

namespace relevo::render {
namespace {

gl::Texture upload(LineIndex& index, const std::string& name) {
    const std::size_t rows = (index.texels.size() + kLineColumns - 1) / kLineColumns;
    index.texels.resize(rows * kLineColumns);
    gl::Texture texture(gl::TextureKind::D2, gl::Format::RGBA32F,
                        {kLineColumns, static_cast<int>(rows), 1}, 1, name);
    texture.write(0, {0, 0, 0}, texture.extent(), std::as_bytes(std::span(index.texels)));
    texture.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
    return texture;
}

LineIndex index_of(const std::vector<dem::PlacedLine>& lines, const dem::Grid& dem) {
    return make_line_index(lines, {.size_posts = {dem.columns(), dem.rows()},
                                   .metres_per_post = [&](const glm::dvec2& post) {
                                       return metres_per_post(dem, post);
                                   }});
}

void report(const LineSource& source, const LineIndex& index, std::size_t lines) {
    const std::string file = fmt::format("{}: {}", source.who, printable(source.file));
    if (lines == 0) log::info(fmt::format("{}: no line is on the DEM; nothing is drawn", file));
    // The finest cells are accurate to a millimetre.
    if (index.accuracy_m > 0.01)
        log::info(fmt::format("{}: drawn to {:.2g} m: it has more lines than {} MiB hold", file,
                              index.accuracy_m, kMostLineTexels * sizeof(glm::vec4) >> 20));
    if (index.dropped > 0)
        log::info(
            fmt::format("{}: more than 1023 segments within {:.0f} m in places; the shortest "
                        "there are not drawn",
                        file, index.finest_m));
    log::debug(fmt::format("{}: {} lines, {} KiB", file, lines,
                           index.texels.size() * sizeof(glm::vec4) >> 10));
}

}  // namespace

std::shared_ptr<const gl::Texture> LineTextureCache::find_or_make(const LineSource& source,
                                                                  const dem::Grid& dem) {
    std::erase_if(known_, [](const Known& known) { return known.texture.expired(); });
    const glm::ivec2 size_posts(dem.columns(), dem.rows());
    for (const Known& known : known_)
        if (known.source == source && known.affine == dem.affine() &&
            known.crs == dem.crs().text() && known.size_posts == size_posts && known.stamps.hold())
            return known.texture.lock();
    FileStamps stamps;
    std::vector<dem::PlacedLine> lines;
    if (source.file.empty()) {
        log::info(effect::no_file_text(source.who));
    } else {
        stamps.add(source.file);
        lines = dem::read_lines(source.file, source.who, source.attribute, dem);
    }
    LineIndex index = index_of(lines, dem);
    if (!source.file.empty()) report(source, index, lines.size());
    auto texture = std::make_shared<const gl::Texture>(upload(index, source.resource));
    known_.push_back({source, dem.affine(), dem.crs().text(), size_posts, stamps, texture});
    return texture;
}

void LineTextures::update(const dem::Grid& dem, std::uint64_t serial, LineTextureCache& cache) {
    if (serial == serial_) return;
    for (const LineSource& source : sources_)
        textures_[source.resource] = cache.find_or_make(source, dem);
    serial_ = serial;
}

const gl::Texture* LineTextures::find(const std::string& resource) const {
    const auto found = textures_.find(resource);
    return found == textures_.end() ? nullptr : found->second.get();
}

}  // namespace relevo::render

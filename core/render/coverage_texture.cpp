#include "render/coverage_texture.h"

#include <algorithm>
#include <span>

#include "base/parallel_for.h"

namespace relevo::render {
namespace {

constexpr int kMaxLevels = 9;  // the coarsest has means of 512 x 512 posts

/// Means of 2 x 2 texels.
void reduce(const Array2d<CoverageTexel>& fine, Array2d<CoverageTexel>& coarse) {
    parallel_for(0, coarse.height(), 64, [&](int first, int last) {
        for (int row = first; row < last; ++row) {
            const CoverageTexel *const a = fine.row(2 * row).data(), *const b =
                                                                         fine.row(2 * row + 1)
                                                                             .data();
            CoverageTexel* const to = coarse.row(row).data();
            for (int i = 0; i < coarse.width(); ++i) {
                const auto mean = [&](std::uint8_t CoverageTexel::*part) {
                    return static_cast<std::uint8_t>((a[2 * i].*part + a[2 * i + 1].*part +
                                                      b[2 * i].*part + b[2 * i + 1].*part + 2) /
                                                     4);
                };
                to[i] = {mean(&CoverageTexel::value), mean(&CoverageTexel::coverage)};
            }
        }
    });
}

}  // namespace

void CoverageTexture::resize(int width, int height) {
    if (width == size_.x && height == size_.y) return;
    size_ = {width, height};
    int levels = 1;
    while (levels < kMaxLevels && std::max(width, height) >> levels > 0)
        ++levels;
    const int unit = 1 << (levels - 1);
    const auto padded = [&](int side) { return (side + unit - 1) / unit * unit; };
    levels_.clear();
    for (int level = 0; level < levels; ++level)
        levels_.emplace_back(padded(width) >> level, padded(height) >> level, CoverageTexel{0, 0});
    texture_.reset();
}

const gl::Texture& CoverageTexture::make_texture(const char* name) {
    if (texture_) return *texture_;
    const Array2d<CoverageTexel>& base = levels_.front();
    texture_.emplace(gl::TextureKind::D2, gl::Format::RG8,
                     gl::Extent{base.width(), base.height(), 1}, static_cast<int>(levels_.size()),
                     name);
    texture_->set_sampling(gl::Filter::Mipmap, gl::Wrap::Clamp);
    texture_->fill(std::byte{0});
    return *texture_;
}

void CoverageTexture::upload(const char* name) {
    for (std::size_t level = 1; level < levels_.size(); ++level)
        reduce(levels_[level - 1], levels_[level]);
    make_texture(name);
    for (std::size_t level = 0; level < levels_.size(); ++level)
        texture_->write(static_cast<int>(level), {0, 0, 0},
                        {levels_[level].width(), levels_[level].height(), 1},
                        std::as_bytes(std::span(levels_[level].data(), levels_[level].size())));
}

}  // namespace relevo::render

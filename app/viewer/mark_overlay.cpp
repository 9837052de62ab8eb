#include "viewer/mark_overlay.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <imgui.h>

#include "chart/drawing.h"
#include "session/marks.h"
#include "viewer/image_texture.h"

namespace relevo::viewer {
namespace {

/// From so many pixels on, all depths of a shared frame are read at once.
constexpr std::size_t kMostSingle = 2000;

/// Depths for pixels of the window, which frames of a moving camera do not have one by one.
session::MarkView view_of(const Picture& picture, glm::ivec2 size_px) {
    const auto depths = [&picture, size_px](std::span<const glm::ivec2> pixels) {
        std::vector<glm::ivec2> own;
        own.reserve(pixels.size());
        for (const glm::ivec2& at : pixels)
            own.emplace_back(at.x * picture.width_px / size_px.x,
                             picture.height_px - 1 - at.y * picture.height_px / size_px.y);
        std::vector<float> found;
        found.reserve(own.size());
        if (picture.shared && own.size() > kMostSingle) {
            const std::vector<float> all = picture.read_depths_m();
            for (const glm::ivec2& at : own)
                found.push_back(all[static_cast<std::size_t>(at.y) *
                                        static_cast<std::size_t>(picture.width_px) +
                                    static_cast<std::size_t>(at.x)]);
            return found;
        }
        picture.fetch_depths(own);
        for (const glm::ivec2& at : own)
            found.push_back(picture.depth_m(at.x, at.y));
        return found;
    };
    return {picture.camera, size_px.x, size_px.y, depths};
}

}  // namespace

void add_marks(const Picture& picture, std::span<const chart::Rect> taken, image::Image8& image) {
    if (picture.marks.empty()) return;
    chart::Drawing drawing(image.width, image.height);
    session::draw_marks(picture.marks, view_of(picture, {image.width, image.height}),
                        {0, 0, drawing.width(), drawing.height()}, taken, drawing);
    chart::paint(drawing, 0, 0, 1, image);
}

void MarkOverlay::draw(const std::shared_ptr<const Picture>& picture, glm::ivec2 size_px,
                       float from, float to, glm::vec2 size, std::span<const chart::Rect> taken) {
    if (picture->marks.empty() || size_px.x <= 0 || size_px.y <= 0) return;
    const glm::vec2 sides(from, to);
    if (of_.lock() != picture || size_px_ != size_px || sides_ != sides ||
        !std::ranges::equal(taken_, taken)) {
        taken_.assign(taken.begin(), taken.end());
        of_ = picture;
        size_px_ = size_px;
        sides_ = sides;
        chart::Drawing drawing(size_px.x, size_px.y);
        const double scale = drawing.width() / static_cast<double>(size.x);
        std::vector<chart::Rect> taken_px;
        for (const chart::Rect& rect : taken)
            taken_px.push_back(
                {scale * rect.x, scale * rect.y, scale * rect.width, scale * rect.height});
        session::draw_marks(
            picture->marks, view_of(*picture, size_px),
            {from * drawing.width(), 0, (to - from) * drawing.width(), drawing.height()}, taken_px,
            drawing);
        texture_ = texture_of(chart::to_transparent_image(drawing));
    }
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.name())), {0, 0},
        {size.x, size.y});
}

}  // namespace relevo::viewer

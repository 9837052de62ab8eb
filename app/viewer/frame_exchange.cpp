#include "viewer/frame_exchange.h"

#include <mutex>
#include <utility>
#include <vector>

namespace relevo::viewer {

struct FrameExchange::Pool {
    std::mutex mutex;
    std::vector<std::unique_ptr<SharedFrame>> free;
};

FrameExchange::FrameExchange() : pool_(std::make_shared<Pool>()) {}

std::shared_ptr<SharedFrame> FrameExchange::take(gl::Extent extent) {
    std::unique_ptr<SharedFrame> frame;
    {
        const std::lock_guard lock(pool_->mutex);
        std::erase_if(pool_->free,
                      [&](const auto& each) { return each->colour.extent() != extent; });
        if (!pool_->free.empty()) {
            frame = std::move(pool_->free.back());
            pool_->free.pop_back();
        }
    }
    if (!frame) {
        frame = std::make_unique<SharedFrame>();
        frame->colour =
            gl::Texture(gl::TextureKind::D2, gl::Format::RGBA8, extent, 1, "shared frame");
        frame->depth = gl::Texture(gl::TextureKind::D2, gl::Format::Depth32F, extent, 1,
                                   "depth of a shared frame");
    }
    frame->shown.wait_on_device();
    return {frame.release(), [pool = pool_](SharedFrame* returned) {
                const std::lock_guard lock(pool->mutex);
                pool->free.emplace_back(returned);
            }};
}

}  // namespace relevo::viewer

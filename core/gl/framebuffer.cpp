#include "gl/framebuffer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/buffer.h"
#include "gl/errors.h"

namespace relevo::gl {

void Framebuffer::destroy(unsigned name) {
    glDeleteFramebuffers(1, &name);
}

Framebuffer::Framebuffer(std::span<const Texture* const> colours, const Texture* depth,
                         std::string_view label) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    handle_ = Handle<&Framebuffer::destroy>(name);
    set_label(GL_FRAMEBUFFER, name, label);
    std::vector<GLenum> targets;
    for (const Texture* colour : colours) {
        const bool array = colour->kind() == TextureKind::D2Array;
        for (int layer = 0; layer < (array ? colour->extent().depth : 1); ++layer) {
            const GLenum target = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size());
            if (array)
                glNamedFramebufferTextureLayer(name, target, colour->name(), 0, layer);
            else
                glNamedFramebufferTexture(name, target, colour->name(), 0);
            targets.push_back(target);
        }
        extent_ = {colour->extent().width, colour->extent().height, 1};
    }
    glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(targets.size()), targets.data());
    if (targets.empty()) glNamedFramebufferReadBuffer(name, GL_NONE);
    if (depth) {
        glNamedFramebufferTexture(
            name, depth->format() == Format::Stencil8 ? GL_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
            depth->name(), 0);
        extent_ = depth->extent();
    }
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) throw_if_lost();
    if (status != GL_FRAMEBUFFER_COMPLETE)
        failed(fmt::format("framebuffer: {}: this device cannot draw to it, status 0x{:04x}", label,
                           status));
}

Framebuffer::Framebuffer(const Texture& colour, int level, int layer, std::string_view label) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    handle_ = Handle<&Framebuffer::destroy>(name);
    set_label(GL_FRAMEBUFFER, name, label);
    if (colour.kind() == TextureKind::D2)
        glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, colour.name(), level);
    else
        glNamedFramebufferTextureLayer(name, GL_COLOR_ATTACHMENT0, colour.name(), level, layer);
    extent_ = {std::max(colour.extent().width >> level, 1),
               std::max(colour.extent().height >> level, 1), 1};
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) throw_if_lost();
    if (status != GL_FRAMEBUFFER_COMPLETE)
        failed(fmt::format("framebuffer: {}: this device cannot draw to it, status 0x{:04x}", label,
                           status));
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, handle_.name());
    glViewport(0, 0, extent_.width, extent_.height);
}

void Framebuffer::clear_colour(int index, glm::vec4 value) const {
    glClearNamedFramebufferfv(handle_.name(), GL_COLOR, index, &value.x);
}

void Framebuffer::clear_depth(float value) const {
    glClearNamedFramebufferfv(handle_.name(), GL_DEPTH, 0, &value);
}

void Framebuffer::clear_stencil(int value) const {
    glClearNamedFramebufferiv(handle_.name(), GL_STENCIL, 0, &value);
}

std::vector<float> Framebuffer::read_depths(std::span<const glm::ivec2> pixels) const {
    std::vector<float> depths(pixels.size());
    if (pixels.empty()) return depths;
    const Buffer buffer(depths.size() * sizeof(float), "depths of pixels");
    glBindFramebuffer(GL_READ_FRAMEBUFFER, handle_.name());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer.name());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        glReadPixels(pixels[i].x, pixels[i].y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                     reinterpret_cast<void*>(i * sizeof(float)));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    buffer.read(std::as_writable_bytes(std::span(depths)));
    return depths;
}

void Framebuffer::copy_to_window(int width_px, int height_px, float share) const {
    constexpr GLuint kWindow = 0;
    const bool same = width_px == extent_.width && height_px == extent_.height;
    const auto part = [&](int width) {
        return static_cast<int>(std::lround(share * static_cast<float>(width)));
    };
    glBlitNamedFramebuffer(handle_.name(), kWindow, 0, 0, part(extent_.width), extent_.height, 0, 0,
                           part(width_px), height_px, GL_COLOR_BUFFER_BIT,
                           same ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, kWindow);
    glViewport(0, 0, width_px, height_px);
}

}  // namespace relevo::gl

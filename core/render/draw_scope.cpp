#include "render/draw_scope.h"

#include <epoxy/gl.h>

namespace relevo::render {
namespace {

// The full-screen triangle is at depth 0, the far plane.
GLenum function_of(DepthTest test) {
    switch (test) {
        case DepthTest::Nearer:
            return GL_GREATER;
        case DepthTest::Covered:
            return GL_LESS;
        case DepthTest::Uncovered:
            return GL_EQUAL;
    }
    return GL_ALWAYS;
}

void set_depth(const gl::Framebuffer& target, const Depth& depth) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(depth.writes ? GL_TRUE : GL_FALSE);
    glDepthFunc(function_of(depth.test));
    if (depth.clear) target.clear_depth(*depth.clear);  // affected by the depth mask
}

void set_stencil(const gl::Framebuffer& target, const Stencil& stencil) {
    glEnable(GL_STENCIL_TEST);
    if (stencil.marks) {
        target.clear_stencil(0);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        glStencilFunc(GL_ALWAYS, 1, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    } else {
        glStencilFunc(GL_EQUAL, 1, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    }
}

}  // namespace

DrawScope::DrawScope(const gl::Framebuffer& target, const DrawState& state) {
    target.bind();
    if (state.depth) set_depth(target, *state.depth);
    if (state.stencil) set_stencil(target, *state.stencil);
    if (state.clips_voids) glEnable(GL_CLIP_DISTANCE0);
    if (state.clamps_depth) glEnable(GL_DEPTH_CLAMP);
    if (state.winds_counterclockwise) {
        glEnable(GL_CULL_FACE);
        glFrontFace(*state.winds_counterclockwise ? GL_CCW : GL_CW);
    }
}

DrawScope::~DrawScope() {
    for (const GLenum capability :
         {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_CLIP_DISTANCE0, GL_DEPTH_CLAMP, GL_CULL_FACE})
        glDisable(capability);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace relevo::render

#include "render/plugin_resources.h"

namespace relevo::render {

When when_of(shader::PluginPass::When when) {
    switch (when) {
        case shader::PluginPass::When::Sun:
            return When::Sun;
        case shader::PluginPass::When::Changed:
            return When::Parameters;
        case shader::PluginPass::When::Dem:
            return When::Dem;
        default:
            return When::Frame;
    }
}

ResourceSize size_of(const shader::PassSize& size) {
    return {.share = size.scale, .width = size.width, .height = size.height, .depth = size.depth};
}

Resource resource_of(const shader::PluginPass& pass, When when) {
    using Output = shader::PluginPass::Output;
    Resource resource{.name = pass.resource,
                      .format = pass.format,
                      .size = size_of(pass.size),
                      // What is not computed in every frame has to last.
                      .lifetime = when == When::Frame ? Lifetime::Frame : Lifetime::Kept,
                      .linear = pass.linear};
    if (pass.output == Output::Texture3D) resource.kind = ResourceKind::Texture3D;
    if (pass.is_buffer()) {
        resource.kind = ResourceKind::Buffer;
        resource.format = pass.output == Output::Floats ? PixelFormat::R32F : PixelFormat::R32UI;
        resource.size.bytes = sizeof(float) * static_cast<std::size_t>(pass.size.width);
    }
    return resource;
}

}  // namespace relevo::render

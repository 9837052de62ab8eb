#pragma once

#include "render/graph/graph.h"
#include "shader/plugin_pass.h"

/// What the passes that plugins declare in plugin.json are in a frame graph.
namespace relevo::render {

When when_of(shader::PluginPass::When when);
ResourceSize size_of(const shader::PassSize& size);
/// What a pass of a plugin writes.
Resource resource_of(const shader::PluginPass& pass, When when);

}  // namespace relevo::render

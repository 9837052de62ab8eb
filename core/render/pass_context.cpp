#include "render/pass_context.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace relevo::render {
namespace {

template <typename Memory>
Memory& declared(const Pass& pass, std::string_view resource, Memory* memory) {
    const bool declares = std::ranges::any_of(
        accesses(pass), [&](const Access& access) { return access.version.resource == resource; });
    if (!declares || !memory)
        failed(fmt::format("render: graph: pass {} uses {}, which {}", pass.name, resource,
                           declares ? "is not of that kind" : "it does not declare"));
    return *memory;
}

}  // namespace

gl::Texture& PassContext::texture(std::string_view resource) const {
    return declared(*pass, resource, targets.texture(resource));
}

const gl::Buffer& PassContext::buffer(std::string_view resource) const {
    return declared(*pass, resource, targets.buffer(resource));
}

}  // namespace relevo::render

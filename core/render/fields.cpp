#include "render/fields.h"

#include <cmath>
#include <span>
#include <utility>

#include <glm/vec2.hpp>

// A field is a regular grid in metres around the DEM's centre, not on the DEM's posts, because
// most samples of clouds lie outside the DEM. Virtual textures as for rasters on the ground were
// rejected: they need a level of detail for each visible pixel, which passes do not have.
namespace relevo::render {
namespace {

gl::Texture upload(const Field* field, const std::string& name) {
    const Array2d<float> none;
    const Array2d<float>& values = field ? field->around.values : none;
    // Beyond the border, where texels are clamped, there is nothing.
    Array2d<glm::vec2> texels(values.width() + 2, values.height() + 2, glm::vec2(0));
    for (int row = 0; row < values.height(); ++row)
        for (int column = 0; column < values.width(); ++column)
            if (const float value = values.at(column, row); !std::isnan(value))
                texels.at(column + 1, row + 1) = {value, 1};
    gl::Texture texture(gl::TextureKind::D2, gl::Format::RG32F,
                        {texels.width(), texels.height(), 1}, 1, name);
    texture.write(0, {0, 0, 0}, texture.extent(),
                  std::as_bytes(std::span(texels.data(), texels.size())));
    texture.set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
    return texture;
}

}  // namespace

void Fields::set(NamedFields fields) {
    std::erase_if(textures_, [&](const auto& entry) { return !fields.contains(entry.first); });
    for (const auto& [name, field] : fields) {
        const auto before = fields_.find(name);
        if (textures_.contains(name) && before != fields_.end() && before->second == field)
            continue;
        textures_.insert_or_assign(name, upload(field.get(), name));
    }
    fields_ = std::move(fields);
}

const gl::Texture* Fields::texture(std::string_view name) const {
    constexpr std::string_view kTexels = "_texels";
    if (!name.ends_with(kTexels)) return nullptr;
    const auto found = textures_.find(std::string(name.substr(0, name.size() - kTexels.size())));
    return found == textures_.end() ? nullptr : &found->second;
}

FieldPlace Fields::place(const std::string& name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end() || !found->second) return {};
    const Field& field = *found->second;
    const overlay::ValuesAround& around = field.around;
    return {glm::vec4(around.first_m - around.step_m, 1.0 / around.step_m),
            {around.values.width() + 2, around.values.height() + 2, field.mean, field.most}};
}

}  // namespace relevo::render

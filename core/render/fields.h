#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <glm/vec4.hpp>

#include "gl/texture.h"
#include "overlay/band_around.h"

namespace relevo::render {

/// Values around a DEM for effects, and what they are on the whole.
struct Field {
    overlay::ValuesAround around;
    float mean = 0;         ///< over the DEM
    float most = 0;         ///< the largest value
    float part_of_dem = 1;  ///< that has values
};

/// Fields by the resources of their textures: "clouds.local_cover_1". Null: there is none.
using NamedFields = std::map<std::string, std::shared_ptr<const Field>>;

/// Where a field's texels lie, for field_value() of lib/field.glsl.
struct FieldPlace {
    glm::vec4 place{0};             ///< of its first texel [m], and texels per metre
    glm::vec4 shape{1, 1, -1, -1};  ///< columns and rows; mean and largest value, -1: no field
};

/// Fields on the device, each a texture of value * part and part (RG32F), with a border of nothing.
class Fields {
  public:
    /// Replaces the fields. Those that were there before are not uploaded again.
    void set(NamedFields fields);

    /// "clouds.local_cover_1_texels"; null for other names.
    const gl::Texture* texture(std::string_view name) const;
    FieldPlace place(const std::string& name) const;
    const NamedFields& all() const { return fields_; }

  private:
    NamedFields fields_;
    std::map<std::string, gl::Texture> textures_;
};

}  // namespace relevo::render

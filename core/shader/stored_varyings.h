#pragma once

#include <string>
#include <vector>

#include "shader/stage.h"
#include "shader/text_builder.h"

namespace relevo::shader {

/// The varyings that a geometry program stores in textures for its shading program. Both programs
/// assign the same places: the first texture with room, in the order of the files.
class StoredVaryings {
  public:
    StoredVaryings() = default;
    /// Adds the varyings that plugins' functions read in the shading program.
    /// @param shading  the fragment stage of the shading program
    /// @param program  its name, for messages
    /// @throws Error (Failed) if they do not fit into the textures, (BadInput) for a type
    ///         that a texture cannot hold
    StoredVaryings(const Stage& shading, const std::string& program);

    struct Stored {
        const Varying* varying;
        int target, first, count;  ///< components [first, first + count) of the texture
    };
    const std::vector<Stored>& all() const { return stored_; }
    int targets() const { return targets_; }
    bool holds(const Varying& varying) const;

    /// The declaration of the shading program's sampler, an array texture of the targets.
    static constexpr const char* kTexture = "varyings";

    /// `store_varyings()`, which fills the outputs at location 1 and up.
    void write_store(TextBuilder& out) const;
    /// `load_varyings(pixel)`.
    void write_load(TextBuilder& out) const;

  private:
    std::vector<Stored> stored_;
    int targets_ = 0;
};

}  // namespace relevo::shader

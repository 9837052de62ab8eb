#pragma once

#include <string>
#include <vector>

#include "shader/stage.h"
#include "shader/stitch.h"
#include "shader/text_builder.h"

namespace relevo::shader {

/// Assigns a program's texture units: one for each texture, which samplers of core and plugins may
/// read under several names.
///
/// The order is: core's textures, textures that a plugin reads of another, each plugin's own in the
/// order of its file.
class TextureUnits {
  public:
    TextureUnits() = default;
    /// @throws AuthorError (BadInput) for samplers of one texture that differ in type
    TextureUnits(const std::vector<const Stage*>& stages, const StitchInput& input);

    /// Adds a sampler of core that no file declares.
    void add_core(const std::string& name, const std::string& type);

    /// @throws Error (Failed) for more units than the device has, with their owners
    void check(const std::string& program, int max_units) const;

    std::vector<TextureUnit> units() const;

    /// The declarations of the samplers that a stage reads.
    void write(TextBuilder& out, const Stage& stage) const;

  private:
    struct Texture {
        TextureUnit unit;
        std::vector<const Sampler*> samplers;  // the first names the unit; empty: core's
    };
    struct Read {
        const Sampler* sampler;
        std::string owner;
        std::string resource;  // the equal texture that is on the device
        bool shared;           // a plugin reads it that does not own it
    };
    void add(const Read& read);

    std::vector<Texture> textures_;
};

}  // namespace relevo::shader

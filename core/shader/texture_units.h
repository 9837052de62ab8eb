#pragma once

#include <string>
#include <vector>

#include "shader/stage.h"
#include "shader/stitch.h"
#include "shader/text_builder.h"

namespace relevo::shader {

/// Gives out a program's texture units: one for each texture, however many samplers of core and
/// plugins read it, by whatever names.
///
/// Core's come first, then those that a plugin reads of another, then each plugin's own in the
/// order of its file.
class TextureUnits {
  public:
    TextureUnits() = default;
    /// @throws AuthorError (BadInput) for samplers of one texture that differ in type
    TextureUnits(const Stage& vertex, const Stage& fragment, const StitchInput& input);

    /// One more of core's, that no file declares.
    void add_core(const std::string& name, const std::string& type);

    /// @throws Error (Failed) for more than the device has, with who takes which
    void check(const std::string& program, int max_units) const;

    std::vector<TextureUnit> units() const;

    /// Declares what a stage reads.
    void write(TextBuilder& out, const Stage& stage) const;

  private:
    struct Texture {
        TextureUnit unit;
        std::vector<const Sampler*> samplers;  // the first names the unit; none: core's
    };
    struct Read {
        const Sampler* sampler;
        std::string owner;
        std::string resource;  // after what is the same
        bool shared;           // some plugin reads it without having made it
    };
    void add(const Read& read);

    std::vector<Texture> textures_;
};

}  // namespace relevo::shader

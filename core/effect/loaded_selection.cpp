#include "effect/loaded_selection.h"

#include <map>
#include <utility>

#include "base/error.h"
#include "effect/instance_reader.h"
#include "mesh/mesh.h"

namespace relevo::effect {
namespace {

/// Textures and modules of effects, by id.
class Loader {
  public:
    Loader(const shader::ParamStore& values, const std::optional<TextureLimits>& limits,
           LoadedSelection loaded)
        : values_(values), limits_(limits) {
        for (NativeModule& module : loaded.modules)
            modules_.emplace(module.id(), std::move(module));
        for (LoadedTexture& texture : loaded.textures)
            textures_.emplace(texture.spec.resource, std::move(texture));
    }

    /// @throws Error (BadInput) if the effect cannot be used
    void load(const Effect& effect) {
        for (TextureSpec spec : effect.manifest.textures) {
            if (!spec.from.empty())
                if (const std::string file = values_.text(spec.from); !file.empty())
                    spec.files = {file};
            auto texture = textures_.find(spec.resource);
            if (texture == textures_.end() || texture->second.spec.files != spec.files)
                texture = textures_.insert_or_assign(spec.resource, load_texture(spec)).first;
            if (limits_) check_limits(texture->second, *limits_);
        }
        for (const std::filesystem::path& file : mesh_files(effect.manifest))
            mesh::read(file);  // the device's are read again when it is drawn
        if (!effect.manifest.module.empty() && modules_.count(effect.id()) == 0)
            modules_.emplace(effect.id(), NativeModule::load(effect.manifest, values_));
    }

    void hand_over(const Effect& effect, LoadedSelection& to) {
        for (const TextureSpec& spec : effect.manifest.textures)
            to.textures.push_back(std::move(textures_.at(spec.resource)));
        if (const auto module = modules_.find(effect.id()); module != modules_.end())
            to.modules.push_back(std::move(module->second));
    }

  private:
    const shader::ParamStore& values_;
    const std::optional<TextureLimits>& limits_;
    std::map<std::string, NativeModule> modules_;
    std::map<std::string, LoadedTexture> textures_;
};

}  // namespace

LoadedSelection select_and_load(const Registry& registry, const std::vector<Preset>& presets,
                                const Switches& command_line, const shader::ParamStore& values,
                                const std::optional<TextureLimits>& limits, LoadedSelection loaded,
                                const GroundWords& ground) {
    LoadedSelection result;
    result.unusable = std::move(loaded.unusable);
    Loader loader(values, limits, std::move(loaded));
    while (true) {
        result.selection = select(registry, presets, command_line, result.unusable, ground);
        const std::size_t before = result.unusable.size();
        for (const Effect* effect : result.selection.effects) {
            try {
                loader.load(*effect);
            } catch (const Error& error) {
                if (error.code() == ErrorCode::Usage) throw;
                result.unusable[effect->id()] = error.what();
            }
        }
        if (result.unusable.size() == before) break;
    }
    for (const Effect* effect : result.selection.effects)
        loader.hand_over(*effect, result);
    return result;
}

}  // namespace relevo::effect

#include "effect/instance_reader.h"

#include <fmt/format.h>

namespace relevo::effect {
namespace {

constexpr std::size_t kMaxLevels = 8, kMaxKinds = 8;
constexpr double kMinSpacing_m = 0.5, kMaxSpacing_m = 1e5;
constexpr double kMinHeight_m = 0.01, kMaxHeight_m = 1e4;
constexpr double kMax_px = 1e4, kMaxSprite_px = 200;  // devices draw points of 255 pixels

/// @param before   levels before this one
/// @param most_px  limit of below_px
shader::InstanceSet::Level level_of(json::ObjectReader object, const shader::InstanceSet& before,
                                    double most_px, const FileOfKey& file_of) {
    shader::InstanceSet::Level level;
    const bool is_first = before.levels.empty();
    if (is_first == object.has("below_px"))
        object.fail(object.line_of("below_px"), "below_px",
                    "expected the height on the screen below which a level is drawn, of each level "
                    "but the first");
    level.below_px = object.number("below_px", 0, is_first ? 0 : 1, most_px, false);
    for (const std::string& mesh : object.strings("meshes"))
        level.meshes.push_back(file_of(object, "meshes", mesh));
    const bool follows_sprites = !is_first && before.has_sprites();
    const std::size_t kinds = is_first ? level.meshes.size() : before.levels[0].meshes.size();
    if (level.meshes.size() > kMaxKinds || follows_sprites || (is_first && kinds == 0) ||
        (!level.is_sprite() && level.meshes.size() != kinds))
        object.fail(object.line_of("meshes"), "meshes",
                    fmt::format("expected a mesh of each kind, 1 to {} at every level, or none at "
                                "the last level, for sprites",
                                kMaxKinds));
    if (level.is_sprite() && level.below_px > kMaxSprite_px)
        object.fail(object.line_of("below_px"), "below_px",
                    fmt::format("expected at most {} for sprites but got {}", kMaxSprite_px,
                                level.below_px));
    object.finish();
    return level;
}

}  // namespace

shader::InstanceSet read_instance_set(json::ObjectReader& object, const std::string& id,
                                      const std::string& name, const FileOfKey& file_of) {
    shader::InstanceSet set{.name = name,
                            .resource = id + '.' + name,
                            .function = id + "_place_" + name,
                            .line = object.line()};
    object.need("spacing_m");
    object.need("height_m");
    set.spacing_m = object.number("spacing_m", 0, kMinSpacing_m, kMaxSpacing_m, false);
    set.height_m = object.number("height_m", 0, kMinHeight_m, kMaxHeight_m, false);
    set.casts_shadow = object.boolean("casts_shadow", true);
    set.light_through = object.number("light_through", 0, 0, 1, false);
    if (!set.casts_shadow && object.has("light_through"))
        object.fail(object.line_of("light_through"), "light_through",
                    "expected none where casts_shadow is false");
    const json::Value& levels = object.need("levels");
    if (levels.kind != json::Value::Kind::Array || levels.items.empty() ||
        levels.items.size() > kMaxLevels)
        object.fail(levels.line, "levels",
                    fmt::format("expected a list of 1 to {} meshes, finest first", kMaxLevels));
    for (const json::Value& item : levels.items) {
        const double most_px = set.levels.size() > 1 ? set.levels.back().below_px : kMax_px;
        set.levels.push_back(level_of(object.inner("levels", item), set, most_px, file_of));
    }
    return set;
}

std::vector<std::filesystem::path> mesh_files(const Manifest& manifest) {
    std::vector<std::filesystem::path> files;
    for (const shader::InstanceSet& set : manifest.instances)
        for (const shader::InstanceSet::Level& level : set.levels)
            files.insert(files.end(), level.meshes.begin(), level.meshes.end());
    return files;
}

}  // namespace relevo::effect

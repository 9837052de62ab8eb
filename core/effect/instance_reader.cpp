#include "effect/instance_reader.h"

#include <fmt/format.h>

namespace relevo::effect {
namespace {

constexpr std::size_t kMaxLevels = 8;
constexpr double kMinSpacing_m = 0.05, kMaxSpacing_m = 1e5;
constexpr double kMinHeight_m = 0.01, kMaxHeight_m = 1e4;
constexpr double kMax_px = 1e4;

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
    const json::Value& levels = object.need("levels");
    if (levels.kind != json::Value::Kind::Array || levels.items.empty() ||
        levels.items.size() > kMaxLevels)
        object.fail(levels.line, "levels",
                    fmt::format("expected a list of 1 to {} meshes, finest first", kMaxLevels));
    for (const json::Value& item : levels.items) {
        json::ObjectReader level = object.inner("levels", item);
        shader::InstanceSet::Level read;
        read.mesh = file_of(level, "mesh", level.string("mesh"));
        if (set.levels.empty() == level.has("below_px"))
            level.fail(level.line(), "below_px",
                       "expected the height on the screen below which a level is drawn, of each "
                       "level but the first");
        const double most =
            set.levels.empty() || set.levels.size() == 1 ? kMax_px : set.levels.back().below_px;
        read.below_px = level.number("below_px", 0, set.levels.empty() ? 0 : 1, most, false);
        level.finish();
        set.levels.push_back(std::move(read));
    }
    object.finish();
    return set;
}

}  // namespace relevo::effect

#include "effect/stand_in_host.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/paths.h"

namespace relevo::effect {
namespace {

// A device of middling size, and a DEM of 20 x 20 km.
constexpr int kMostSide_px = 16384, kMostLayers = 2048;
constexpr int kWidth_px = 1280, kHeight_px = 1024;
constexpr double kHalfSide_m = 10000, kSeenHalfSide_m = 4000;

/// The sun at noon, low, and below the horizon, east, north, up.
constexpr std::array<std::array<double, 3>, 3> kSuns{
    {{0.0, -0.6, 0.8}, {0.995, 0.0, 0.0998749}, {0.0, 0.8, -0.6}}};

int floats_of(std::int32_t format) {
    switch (format) {
        case RELEVO_FORMAT_R32F:
        case RELEVO_FORMAT_DEPTH32F:
            return 1;
        case RELEVO_FORMAT_RG32F:
            return 2;
        case RELEVO_FORMAT_RGBA32F:
            return 4;
        default:
            return 0;
    }
}

/// Writes as much of `full` as the other side knows of.
template <typename Struct>
void copy_out(const Struct& full, Struct* to) {
    const std::uint32_t size = std::min<std::uint32_t>(to->size, sizeof full);
    std::memcpy(to, &full, size);
    to->size = size;
}

/// What the other side knows of, the rest at zero.
template <typename Struct>
Struct copy_in(const Struct* from) {
    Struct full{};
    std::memcpy(&full, from, std::min<std::size_t>(from->size, sizeof full));
    return full;
}

}  // namespace

StandInHost::StandInHost(std::filesystem::path plugin_folder) : folder_(std::move(plugin_folder)) {
    host_.size = sizeof(relevo_host);
    host_.owner = this;
    host_.abi_version = RELEVO_ABI_VERSION;
    host_.service = [](const relevo_host* host, const char* name,
                       std::uint32_t version) -> const void* {
        const StandInHost& self = *static_cast<const OwnHost*>(host)->owner;
        const std::pair<std::string_view, const void*> tables[] = {
            {"relevo.log", &self.log_},           {"relevo.params", &self.params_},
            {"relevo.frame", &self.frame_table_}, {"relevo.texture", &self.texture_},
            {"relevo.draw", &self.draw_},         {"relevo.terrain", &self.terrain_}};
        for (const auto& [known, table] : tables)
            if (version == 1 && known == name && (self.started_ || table == &self.log_))
                return table;
        return nullptr;
    };
    host_.fail = [](const relevo_host* host, const char* text) {
        static_cast<const OwnHost*>(host)->owner->reason_ = text ? text : "no reason given";
    };
    fill_tables();
}

void StandInHost::add_parameter(const std::string& address, bool is_host,
                                const std::array<double, 4>& value) {
    parameters_.insert_or_assign(address, Parameter{is_host, value});
}

void StandInHost::begin_frame(int number) {
    frame_ = number;
}

relevo_status StandInHost::refuse(const char* reason) {
    reason_ = reason;
    return RELEVO_FAILED;
}

void StandInHost::fill_tables() {
    log_ = {sizeof log_, this, [](void*, std::int32_t, const char*) {}};
    params_ = {sizeof params_, this,
               [](void* self, const char* address, double value[4]) {
                   const auto known = of(self).parameters_.find(std::string_view(address));
                   if (known == of(self).parameters_.end())
                       return of(self).refuse("there is no such parameter");
                   std::copy(known->second.value.begin(), known->second.value.end(), value);
                   return RELEVO_OK;
               },
               [](void* self, const char* address, const double value[4]) {
                   const auto known = of(self).parameters_.find(std::string_view(address));
                   if (known == of(self).parameters_.end() || !known->second.is_host)
                       return of(self).refuse("there is no such host parameter");
                   std::copy_n(value, 4, known->second.value.begin());
                   return RELEVO_OK;
               }};
    frame_table_ = {sizeof frame_table_, this,
                    [](void* self, relevo_frame* out) { return of(self).fill_frame(out); }};
    texture_ = {
        sizeof texture_,
        this,
        [](void* self, const relevo_texture_info* info, relevo_texture* texture) {
            return of(self).make_texture(info, texture);
        },
        [](void* self, relevo_texture name) { of(self).textures_.erase(name); },
        [](void* self, relevo_texture name) {
            return of(self).textures_.count(name) > 0 ? RELEVO_OK
                                                      : of(self).refuse("there is no such texture");
        },
        [](void* self, relevo_texture name, std::int32_t layer, float* values,
           std::uint64_t count) { return of(self).read_texture(name, layer, values, count); }};
    draw_ = {sizeof draw_, this,
             [](void* self, const char* file, relevo_program* program) {
                 const auto path = file_inside(of(self).folder_, file);
                 std::error_code ignored;
                 if (!path || !std::filesystem::is_regular_file(*path, ignored))
                     return of(self).refuse("there is no such file");
                 *program = ++of(self).last_program_;
                 return RELEVO_OK;
             },
             [](void* self, const relevo_draw* draw) { return of(self).draw(draw); }};
    terrain_ = {
        sizeof terrain_, this,
        [](void* self, relevo_box* box) { return of(self).fill_box(box, kHalfSide_m); },
        [](void* self, double nearer_than_m, relevo_box* box) {
            return of(self).fill_box(box, std::min(nearer_than_m, kSeenHalfSide_m));
        },
        [](void* self, const relevo_box*, double, relevo_texture target, std::int32_t* level) {
            const auto known = of(self).textures_.find(target);
            if (of(self).frame_ < 0 || known == of(self).textures_.end() ||
                known->second.format != RELEVO_FORMAT_DEPTH32F)
                return of(self).refuse("expected a frame and a target of depth");
            if (level) *level = 0;
            return RELEVO_OK;
        }};
}

relevo_status StandInHost::make_texture(const relevo_texture_info* given, relevo_texture* texture) {
    const relevo_texture_info info = copy_in(given);
    if (info.format < RELEVO_FORMAT_R32F || info.format > RELEVO_FORMAT_RGBA8 || info.width < 1 ||
        info.height < 1 || info.width > kMostSide_px || info.height > kMostSide_px ||
        info.layers < 0 || info.layers > kMostLayers || info.levels < 0 || info.levels > 15)
        return refuse("there is no such texture on this device");
    textures_[++last_texture_] = {info.width, info.height, std::max(info.layers, 1),
                                  std::max(info.levels, 1), info.format};
    *texture = last_texture_;
    return RELEVO_OK;
}

relevo_status StandInHost::read_texture(relevo_texture name, int layer, float* values,
                                        std::uint64_t count) {
    const auto known = textures_.find(name);
    if (known == textures_.end()) return refuse("there is no such texture");
    const Texture& from = known->second;
    const std::uint64_t floats = std::uint64_t{1} * static_cast<unsigned>(from.width) *
                                 static_cast<unsigned>(from.height) *
                                 static_cast<unsigned>(floats_of(from.format));
    if (floats == 0 || layer < 0 || layer >= from.layers || count < floats)
        return refuse("expected a texture of 32-bit floats, one of its layers and room for them");
    std::fill_n(values, floats, 0.0f);
    return RELEVO_OK;
}

relevo_status StandInHost::draw(const relevo_draw* given) {
    const relevo_draw draw = copy_in(given);
    const auto target = textures_.find(draw.target);
    bool good = draw.program >= 1 && draw.program <= last_program_ && target != textures_.end() &&
                draw.layer >= 0 && draw.layer < target->second.layers && draw.level >= 0 &&
                draw.input_count >= 0 && draw.input_count <= RELEVO_MOST_INPUTS &&
                draw.value_count >= 0 && draw.value_count <= RELEVO_MOST_VALUES;
    // Read as the device would read them: a pointer to nothing shows.
    for (int i = 0; good && i < draw.input_count; ++i)
        good = textures_.count(draw.inputs[i]) > 0;
    volatile float last = 0;
    for (int i = 0; good && i < 4 * draw.value_count; ++i)
        last = draw.values[i];
    static_cast<void>(last);
    return good ? RELEVO_OK : refuse("expected a program, textures and values that there are");
}

relevo_status StandInHost::fill_frame(relevo_frame* out) {
    if (frame_ < 0) return refuse("no frame is drawn now; ask inside prepare()");
    const std::array<double, 3>& sun = kSuns[static_cast<std::size_t>(frame_) % kSuns.size()];
    relevo_frame full{};
    full.width_px = kWidth_px;
    full.height_px = kHeight_px;
    const double eye_m[3] = {0, -6000, 3000}, forward[3] = {0, 0.8, -0.6};
    std::copy_n(eye_m, 3, full.eye_m);
    std::copy_n(forward, 3, full.forward);
    std::copy(sun.begin(), sun.end(), full.sun);
    std::copy(sun.begin(), sun.end(), full.sun_apparent);
    full.pixel_rad = 0.0006;
    full.exaggeration = 1;
    full.lowest_m = 200;
    full.highest_m = 1800;
    full.post_spacing_m = 30;
    full.ground = 1 + static_cast<std::uint64_t>(frame_);
    full.software_device = 1;
    copy_out(full, out);
    return RELEVO_OK;
}

relevo_status StandInHost::fill_box(relevo_box* out, double half_side_m) {
    if (frame_ < 0) return refuse("no frame is drawn now; ask inside prepare()");
    relevo_box box = copy_in(out);
    for (int i = 0; i < 3; ++i) {
        box.low[i] = -half_side_m;
        box.high[i] = half_side_m;
    }
    copy_out(box, out);
    return RELEVO_OK;
}

}  // namespace relevo::effect

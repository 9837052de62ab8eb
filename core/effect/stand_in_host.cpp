#include "effect/stand_in_host.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/paths.h"
#include "effect/texture_format.h"

namespace relevo::effect {
namespace {

// A device of middling size, and a plain of 20 x 20 km on the equator.
constexpr int kMaxSide_px = 16384, kMaxLayers = 2048;
constexpr int kWidth_px = 1280, kHeight_px = 1024;
constexpr double kHalfSide_m = 10000, kSeenHalfSide_m = 4000;
constexpr double kPlain_m = 200;
constexpr int kPosts = 667, kLevels = 5;
constexpr double kSpacing_m = 2 * kHalfSide_m / (kPosts - 1);
constexpr double kMetresADegree = 111'319.5;
constexpr double kNoon_s = 1'782'043'200;  // 2026-06-21T12:00Z

/// The sun at noon, low, and below the horizon, east, north, up.
constexpr std::array<std::array<double, 3>, 3> kSuns{
    {{0.0, -0.6, 0.8}, {0.995, 0.0, 0.0998749}, {0.0, 0.8, -0.6}}};

[[noreturn]] void refuse(const char* what) {
    throw std::invalid_argument(what);
}

}  // namespace

StandInHost::StandInHost(std::filesystem::path plugin_folder) : folder_(std::move(plugin_folder)) {}

void StandInHost::add_parameter(const std::string& address, bool is_host, const Value& value) {
    parameters_.insert_or_assign(address, Parameter{is_host, value});
}

const StandInHost::Parameter& StandInHost::known(const char* address) const {
    const auto found = parameters_.find(std::string_view(address));
    if (found == parameters_.end()) refuse("there is no such parameter");
    return found->second;
}

const StandInHost::Texture& StandInHost::known(relevo_texture texture) const {
    const auto found = textures_.find(texture);
    if (found == textures_.end()) refuse("there is no such texture");
    return found->second;
}

void StandInHost::need_frame() const {
    if (frame_ < 0) refuse("no frame is drawn now; ask inside prepare()");
}

StandInHost::Value StandInHost::parameter(const char* address) {
    return known(address).value;
}

void StandInHost::set_parameter(const char* address, const Value& value) {
    if (!known(address).is_host) refuse("it is not a host parameter");
    parameters_.find(std::string_view(address))->second.value = value;
}

std::string StandInHost::text(const char* address) {
    const auto found = texts_.find(std::string_view(address));
    if (found == texts_.end()) refuse("there is no such text");
    return found->second;
}

relevo_frame StandInHost::frame() {
    need_frame();
    const std::array<double, 3>& sun = kSuns[static_cast<std::size_t>(frame_) % kSuns.size()];
    relevo_frame full{};
    full.width_px = kWidth_px;
    full.height_px = kHeight_px;
    full.software_device = 1;
    full.ground = 1 + static_cast<std::uint64_t>(frame_);
    full.unix_s = kNoon_s;
    const double eye_m[3] = {0, -6000, 3000};
    const double axes[3][3] = {{1, 0, 0}, {0, 0.6, 0.8}, {0, 0.8, -0.6}};
    std::copy_n(eye_m, 3, full.eye_m);
    std::copy_n(axes[0], 3, full.right);
    std::copy_n(axes[1], 3, full.up);
    std::copy_n(axes[2], 3, full.forward);
    full.fov_y_rad = 0.6;
    full.pixel_rad = 0.0006;
    for (int i = 0; i < 3; ++i) {
        full.view[4 * i] = full.right[i];
        full.view[4 * i + 1] = full.up[i];
        full.view[4 * i + 2] = full.forward[i];
    }
    full.view[15] = 1;
    const double tan_y = std::tan(full.fov_y_rad / 2);
    full.projection[0] = kHeight_px / (tan_y * kWidth_px);
    full.projection[5] = 1 / tan_y;
    full.projection[11] = 1;
    full.projection[14] = 0.5;
    full.exposure = 1;
    std::copy(sun.begin(), sun.end(), full.sun);
    std::copy(sun.begin(), sun.end(), full.sun_apparent);
    full.exaggeration = 1;
    full.lowest_m = kPlain_m;
    full.highest_m = 1800;
    full.post_spacing_m = kSpacing_m;
    return full;
}

relevo_texture StandInHost::create_texture(const relevo_texture_info& info) {
    const auto longest = static_cast<unsigned>(std::max({info.width, info.height, 1}));
    const std::optional<PixelFormat> format = texture_format(info.format);
    if (!format || info.width < 1 || info.height < 1 || info.width > kMaxSide_px ||
        info.height > kMaxSide_px || info.layers < 0 || info.layers > kMaxLayers ||
        info.levels < 0 || info.levels > static_cast<int>(std::bit_width(longest)) ||
        info.filter < RELEVO_FILTER_NEAREST || info.filter > RELEVO_FILTER_MIPMAP)
        refuse("there is no such texture on this device");
    textures_[++last_texture_] = {info.width, info.height, std::max(info.layers, 1),
                                  std::max(info.levels, 1), *format};
    return last_texture_;
}

void StandInHost::destroy_texture(relevo_texture texture) {
    known(texture);
    textures_.erase(texture);
}

void StandInHost::write_texture(const relevo_texels& texels) {
    const Texture& to = known(texels.texture);
    const std::int64_t bytes =
        std::int64_t{texels.width} * texels.height * layout_of(to.format).bytes();
    if (texels.layer < 0 || texels.layer >= to.layers || texels.level < 0 || texels.x < 0 ||
        texels.y < 0 || texels.width < 1 || texels.height < 1 ||
        texels.x > std::max(1, to.width >> std::min(texels.level, 30)) - texels.width ||
        texels.y > std::max(1, to.height >> std::min(texels.level, 30)) - texels.height)
        refuse("expected a rectangle of the texture");
    if (texels.bytes != static_cast<std::uint64_t>(bytes))
        refuse("expected as many bytes as the rectangle has");
    // Read as the device would read them: a pointer to nothing shows.
    volatile unsigned char last = 0;
    for (std::int64_t i = 0; i < bytes; ++i)
        last = static_cast<const unsigned char*>(texels.texels)[i];
    static_cast<void>(last);
}

void StandInHost::make_mipmaps(relevo_texture texture) {
    known(texture);
}

void StandInHost::read_texture(relevo_texture texture, int layer, std::span<float> values) {
    const Texture& from = known(texture);
    const std::uint64_t floats = std::uint64_t{1} * static_cast<unsigned>(from.width) *
                                 static_cast<unsigned>(from.height) *
                                 static_cast<unsigned>(readable_floats(from.format));
    if (floats == 0 || layer < 0 || layer >= from.layers || values.size() < floats)
        refuse("expected a texture of 32-bit floats, one of its layers and room for them");
    std::fill_n(values.begin(), floats, 0.0f);
}

relevo_program StandInHost::create_program(const char* file) {
    const auto path = file_inside(folder_, file);
    std::error_code ignored;
    if (!path || !std::filesystem::is_regular_file(*path, ignored))
        refuse("there is no such file in the plugin's folder");
    programs_[++last_program_] = file;
    return last_program_;
}

void StandInHost::destroy_program(relevo_program program) {
    if (programs_.erase(program) == 0) refuse("there is no such program");
}

void StandInHost::draw(const relevo_draw& draw) {
    const Texture& target = known(draw.target);
    if (programs_.count(draw.program) == 0) refuse("there is no such program");
    if (draw.layer < 0 || draw.layer >= target.layers || draw.level < 0)
        refuse("expected a layer and a level of the target");
    for (int i = 0; i < draw.input_count; ++i)
        known(draw.inputs[i]);
    volatile float last = 0;
    for (int i = 0; i < 4 * draw.value_count; ++i)
        last = draw.values[i];
    static_cast<void>(last);
}

void StandInHost::fill_box(relevo_box& box, double half_side_m) const {
    need_frame();
    for (int i = 0; i < 3; ++i) {
        box.low[i] = -half_side_m;
        box.high[i] = half_side_m;
    }
}

void StandInHost::fill_bounds(relevo_box& box) {
    fill_box(box, kHalfSide_m);
}

bool StandInHost::fill_visible_bounds(double nearer_than_m, relevo_box& box) {
    fill_box(box, std::min(nearer_than_m, kSeenHalfSide_m));
    return true;
}

int StandInHost::draw_depth(const relevo_box&, double, relevo_texture target) {
    need_frame();
    if (known(target).format != PixelFormat::Depth32F)
        refuse("expected a target of RELEVO_FORMAT_DEPTH32F without layers");
    return 0;
}

relevo_heights StandInHost::heights() {
    need_frame();
    relevo_heights heights{};
    heights.columns = heights.rows = kPosts;
    heights.levels = kLevels;
    return heights;
}

void StandInHost::read_heights(const relevo_nodes& nodes, std::span<float> heights_m) {
    need_frame();
    if (nodes.level < 0 || nodes.level >= kLevels) refuse("expected a level that there is");
    std::ranges::fill(heights_m, static_cast<float>(kPlain_m));
}

StandInHost::Point StandInHost::to_local(const Point& lat_lon_height) {
    need_frame();
    return {lat_lon_height[1] * kMetresADegree, lat_lon_height[0] * kMetresADegree,
            lat_lon_height[2]};
}

StandInHost::Point StandInHost::from_local(const Point& local_m) {
    need_frame();
    return {local_m[1] / kMetresADegree, local_m[0] / kMetresADegree, local_m[2]};
}

std::array<double, 2> StandInHost::to_post(const std::array<double, 2>& lat_lon) {
    need_frame();
    return {(lat_lon[1] * kMetresADegree + kHalfSide_m) / kSpacing_m,
            (kHalfSide_m - lat_lon[0] * kMetresADegree) / kSpacing_m};
}

std::array<double, 2> StandInHost::from_post(const std::array<double, 2>& column_row) {
    need_frame();
    return {(kHalfSide_m - column_row[1] * kSpacing_m) / kMetresADegree,
            (column_row[0] * kSpacing_m - kHalfSide_m) / kMetresADegree};
}

}  // namespace relevo::effect

#include "effect/stand_in_host.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/paths.h"

namespace relevo::effect {
namespace {

// A plain of 20 x 20 km on the equator.
constexpr int kWidth_px = 1280, kHeight_px = 1024;
constexpr double kHalfSide_m = 10000, kVisibleHalfSide_m = 4000;
constexpr double kPlain_m = 200;
constexpr int kPosts = 667, kLevels = 5;
constexpr double kSpacing_m = 2 * kHalfSide_m / (kPosts - 1);
constexpr double kMetresADegree = 111'319.5;
constexpr double kNoon_s = 1'782'043'200;  // 2026-06-21T12:00Z

/// Directions east, north, up.
constexpr double kSuns[3][3] = {{0.0, -0.6, 0.8}, {0.995, 0.0, 0.0998749}, {0.0, 0.8, -0.6}};

/// Reads all of an array that the module gave, as a device would: an invalid pointer crashes here.
template <typename T>
void touch(const T* values, std::uint64_t count) {
    volatile T last{};
    for (std::uint64_t i = 0; i < count; ++i)
        last = values[i];
    static_cast<void>(last);
}

void fill_box(relevo_box& box, double half_side_m) {
    std::fill_n(box.low, 3, -half_side_m);
    std::fill_n(box.high, 3, half_side_m);
}

}  // namespace

void StandInHost::add_parameter(const std::string& address, bool is_host, const Value& value) {
    parameters_.insert_or_assign(address, Parameter{is_host, value});
}

StandInHost::Parameter& StandInHost::known(const char* address) {
    const auto found = parameters_.find(address);
    if (found == parameters_.end()) throw std::invalid_argument("there is no such parameter");
    return found->second;
}

StandInHost::Value StandInHost::parameter(const char* address) {
    return known(address).value;
}

void StandInHost::set_parameter(const char* address, const Value& value) {
    Parameter& parameter = known(address);
    if (!parameter.is_host) throw std::invalid_argument("it is not a host parameter");
    parameter.value = value;
}

std::string StandInHost::text(const char* address) {
    const auto found = texts_.find(address);
    if (found == texts_.end()) throw std::invalid_argument("there is no such text");
    return found->second;
}

void StandInHost::set_marks(const char* list, ModuleMarks) {
    if (!marks_.contains(list)) throw std::invalid_argument(no_list_text(list));
}

void StandInHost::write_texture(const relevo_texels& texels) {
    touch(static_cast<const unsigned char*>(texels.texels), texels.bytes);
}

void StandInHost::read_texture(relevo_texture, int, std::span<float> values) {
    std::ranges::fill(values, 0.0f);
}

void StandInHost::create_program(relevo_program, const char* file) {
    const auto path = file_inside(folder_, file);
    std::error_code ignored;
    if (!path || !std::filesystem::is_regular_file(*path, ignored))
        throw std::invalid_argument("there is no such file in the plugin's folder");
}

void StandInHost::draw(const relevo_draw& draw) {
    touch(draw.values, 4 * static_cast<std::uint64_t>(draw.value_count));
}

relevo_frame StandInHost::frame() {
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
    for (int i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis)
            full.view[4 * i + axis] = axes[axis][i];
    full.view[15] = 1;
    const double tan_y = std::tan(full.fov_y_rad / 2);
    full.projection[0] = kHeight_px / (tan_y * kWidth_px);
    full.projection[5] = 1 / tan_y;
    full.projection[11] = 1;
    full.projection[14] = 0.5;
    full.exposure = 1;
    std::copy_n(kSuns[frame_ % 3], 3, full.sun);
    std::copy_n(kSuns[frame_ % 3], 3, full.sun_apparent);
    full.exaggeration = 1;
    full.lowest_m = kPlain_m;
    full.highest_m = 1800;
    full.post_spacing_m = kSpacing_m;
    return full;
}

void StandInHost::fill_bounds(relevo_box& box) {
    fill_box(box, kHalfSide_m);
}

bool StandInHost::fill_visible_bounds(double nearer_than_m, relevo_box& box) {
    fill_box(box, std::min(nearer_than_m, kVisibleHalfSide_m));
    return true;
}

relevo_heights StandInHost::heights() {
    relevo_heights heights{};
    heights.columns = heights.rows = kPosts;
    heights.levels = kLevels;
    return heights;
}

void StandInHost::read_heights(const relevo_nodes&, std::span<float> heights_m) {
    std::ranges::fill(heights_m, static_cast<float>(kPlain_m));
}

StandInHost::Point StandInHost::to_local(const Point& at) {
    return {at[1] * kMetresADegree, at[0] * kMetresADegree, at[2]};
}

StandInHost::Point StandInHost::from_local(const Point& local_m) {
    return {local_m[1] / kMetresADegree, local_m[0] / kMetresADegree, local_m[2]};
}

StandInHost::Pair StandInHost::to_post(const Pair& lat_lon) {
    return {(lat_lon[1] * kMetresADegree + kHalfSide_m) / kSpacing_m,
            (kHalfSide_m - lat_lon[0] * kMetresADegree) / kSpacing_m};
}

StandInHost::Pair StandInHost::from_post(const Pair& column_row) {
    return {(kHalfSide_m - column_row[1] * kSpacing_m) / kMetresADegree,
            (column_row[0] * kSpacing_m - kHalfSide_m) / kMetresADegree};
}

}  // namespace relevo::effect

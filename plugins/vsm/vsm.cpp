#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "relevo_plugin.hpp"

namespace {

using namespace relevo::plugin;

/// Least sine of the sun's elevation for which heights are measured along the vertical. Below it a
/// ray hardly falls, and points along it hardly differ in height; there the axis leans to the sun.
constexpr double kLeastSine = 0.02;

glm::dvec3 vector_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void write(const glm::dvec3& from, double (&to)[3]) {
    for (int i = 0; i < 3; ++i)
        to[i] = from[i];
}

/// Directions in the light's own space.
struct Axes {
    glm::dvec3 right, up, towards;
    glm::dvec3 rise;  ///< heights are products with this one; none across the light

    explicit Axes(const glm::dvec3& to_sun) : towards(to_sun) {
        const glm::dvec3 level = cross(glm::dvec3(0, 0, 1), to_sun);
        right = length(level) > 1e-6 ? normalize(level) : glm::dvec3(1, 0, 0);
        up = cross(towards, right);
        rise = up.z * up + std::max(towards.z, kLeastSine) * towards;
    }
};

/// What a map was drawn for.
struct Map {
    relevo_box box;
    glm::dvec3 to_sun;
    double exaggeration;
    std::uint64_t ground;
};

class Vsm : public Instance {
  public:
    explicit Vsm(const Host& host)
        : host_(host),
          params_(host),
          frame_(host),
          terrain_(host),
          moments_program_(host, "moments.frag.glsl"),
          blur_program_(host, "blur.frag.glsl") {
        make_textures();
    }

    void prepare() override {
        const relevo_frame frame = frame_.get();
        const Axes axes(vector_of(frame.sun_apparent));
        relevo_box whole = box_along(axes);
        terrain_.bounds(whole);
        relevo_box seen = box_along(axes);
        if (!terrain_.visible_bounds(1e300, seen)) seen = whole;
        seen.low[2] = whole.low[2];
        seen.high[2] = whole.high[2];
        const Map map{seen, axes.towards, frame.exaggeration, frame.ground};
        draw(map, axes, frame);
        write_params(map, axes, frame);
    }

  private:
    static relevo_box box_along(const Axes& axes) {
        relevo_box box{};
        box.size = sizeof box;
        write(axes.right, box.right);
        write(axes.up, box.up);
        write(axes.towards, box.towards);
        return box;
    }

    void make_textures() {
        relevo_texture_info info{};
        info.width = width_;
        info.height = height_;
        info.levels = 1;
        info.format = RELEVO_FORMAT_DEPTH32F;
        info.filter = RELEVO_FILTER_NEAREST;
        depth_ = Texture(host_, info);
        info.format = RELEVO_FORMAT_RG32F;
        rows_ = Texture(host_, info);
        info.name = "moments";
        info.layers = 1;
        info.filter = RELEVO_FILTER_LINEAR;
        moments_ = Texture(host_, info);
    }

    void draw(const Map& map, const Axes& axes, const relevo_frame& frame) {
        const relevo_box& box = map.box;
        const glm::dvec2 texel_m((box.high[0] - box.low[0]) / width_,
                                 (box.high[1] - box.low[1]) / height_);
        terrain_.draw_depth(box, 0.5 * texel_m.y, depth_);
        const double middle_m = middle(frame);
        const double along = dot(axes.rise, axes.up), deep = dot(axes.rise, axes.towards);
        const Program::Value plane{
            0, static_cast<float>(along * texel_m.y),
            static_cast<float>(deep * (box.high[2] - box.low[2])),
            static_cast<float>(along * box.low[1] + deep * box.low[2] - middle_m)};
        const auto floor_m = static_cast<float>(frame.lowest_m * frame.exaggeration - middle_m);
        const auto blur = static_cast<float>(params_.get("vsm.blur"));
        const Program::Value weights{1 - blur, blur / 2, 0, 0};
        moments_program_.draw(rows_, 0, 0, {&depth_}, {plane, {floor_m, 0, 0, 0}, weights});
        blur_program_.draw(moments_, 0, 0, {&rows_}, {{0, 0, 0, 0}, weights});
    }

    static double middle(const relevo_frame& frame) {
        return 0.5 * (frame.lowest_m + frame.highest_m) * frame.exaggeration;
    }

    void write_params(const Map& map, const Axes& axes, const relevo_frame& frame) const {
        const relevo_box& box = map.box;
        const glm::dvec3 eye = vector_of(frame.eye_m);
        const auto set = [&](const char* address, const glm::dvec3& axis, double offset) {
            params_.set(address, {axis.x, axis.y, axis.z, offset});
        };
        const glm::dvec3 across = axes.right / (box.high[0] - box.low[0]);
        const glm::dvec3 along = axes.up / (box.high[1] - box.low[1]);
        set("vsm.across", across, (dot(axes.right, eye) - box.low[0]) / (box.high[0] - box.low[0]));
        set("vsm.along", along, (dot(axes.up, eye) - box.low[1]) / (box.high[1] - box.low[1]));
        params_.set("vsm.texel_m", {(box.high[0] - box.low[0]) / width_,
                                    (box.high[1] - box.low[1]) / height_, 0, 0});
        set("vsm.rise", axes.rise, dot(axes.rise, eye) - middle(frame));
    }

    Host host_;
    Params params_;
    Frame frame_;
    Terrain terrain_;
    Program moments_program_, blur_program_;
    Texture depth_, rows_, moments_;
    int width_ = std::getenv("VSMW") ? atoi(std::getenv("VSMW")) : 1024, height_ = std::getenv("VSMH") ? atoi(std::getenv("VSMH")) : 1024;
};

}  // namespace

RELEVO_PLUGIN("vsm", Vsm)

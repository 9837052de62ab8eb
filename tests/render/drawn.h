#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/units.h"
#include "effect/effect.h"
#include "effect/texture_files.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/camera.h"
#include "scene/map_view.h"
#include "shader/snippet.h"
#include "sun/refraction.h"
#include "sun/zone.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::test {

/// An effect that a test writes.
struct TestEffect {
    std::string id;
    std::string glsl;
    std::optional<effect::DisplaceSpec> displaces{};
};

/// A field under effects, seen by a camera that the test places.
class Drawn {
  public:
    static constexpr double kFov_deg = 40;

    /// @param effects   in calling order, behind those of `shipped`
    /// @param lines     textures of kind `lines`
    /// @param options   but for size and antialiasing; orthographic: frames are those of map()
    Drawn(dem::Heightfield field, std::vector<TestEffect> effects, int width_px, int height_px,
          double pixel_error = 0, const std::vector<effect::Effect>& shipped = {},
          const std::vector<std::pair<std::string, std::string>>& settings = {},
          const std::vector<render::LineSource>& lines = {}, render::RendererOptions options = {})
        : dem_(std::move(field)),
          shipped_(shipped),
          ground_(render::make_ground(dem_)),
          width_px_(width_px),
          height_px_(height_px) {
        std::vector<shader::Param> params = render::core_params();
        render::EffectInputs inputs;
        inputs.lines = lines;
        std::vector<effect::LoadedTexture> textures;
        const auto add = [&](const shader::Snippet& snippet) {
            params.insert(params.end(), snippet.source.params.begin(), snippet.source.params.end());
            inputs.stitch.snippets.push_back(&snippet);
        };
        for (const effect::Effect& effect : shipped_) {
            for (const shader::Snippet& snippet : effect.snippets)
                add(snippet);
            const effect::Manifest& manifest = effect.manifest;
            for (const effect::TextureSpec& texture : manifest.textures)
                textures.push_back(effect::load_texture(texture));
            inputs.stitch.capabilities.insert(inputs.stitch.capabilities.end(),
                                              manifest.provides.begin(), manifest.provides.end());
            inputs.stitch.passes.insert(inputs.stitch.passes.end(), manifest.passes.begin(),
                                        manifest.passes.end());
            inputs.stitch.instances.insert(inputs.stitch.instances.end(),
                                           manifest.instances.begin(), manifest.instances.end());
            if (manifest.displaces) inputs.displaces.push_back(*manifest.displaces);
        }
        snippets_.reserve(effects.size());
        for (const TestEffect& effect : effects) {
            snippets_.push_back(shader::parse_snippet(effect.id, effect.id + ".glsl", effect.glsl));
            add(snippets_.back());
            if (effect.displaces) inputs.displaces.push_back(*effect.displaces);
        }
        for (const effect::LoadedTexture& texture : textures)
            inputs.textures.push_back(&texture);
        values_.declare(params);
        for (const auto& [address, value] : settings)
            values_.set(address, value);
        inputs.stitch.values = &values_;
        options.width_px = width_px;
        options.height_px = height_px;
        options.antialias = false;
        renderer_.emplace(context_, inputs, options);
        terrain_.emplace(
            dem_, ground_.frame,
            render::TerrainOptions{.pixel_error = pixel_error,
                                   .vertex_budget = 100000000,
                                   .max_array_layers = context_.info().max_array_layers,
                                   .climate_alone = true});
        for (const effect::Effect& effect : shipped_)
            for (const effect::FieldSpec& of_effect : effect.manifest.fields)
                fields_[of_effect.resource] = nullptr;
        terrain_->set_fields(fields_);
        shine("2026-06-21T15:00Z");
        frame_.camera.fov_y_rad = radians(kFov_deg);
    }

    /// @param resource  of a texture of kind `field` of a shipped effect
    void set_field(const std::string& resource, render::Field field) {
        fields_.at(resource) = std::make_shared<const render::Field>(std::move(field));
        terrain_->set_fields(fields_);
    }

    void shine(const char* utc) {
        const geo::Geodetic place = dem_.grid.center();
        frame_.sun = render::make_sun_light(sun::position(sun::parse_time(utc).utc, place),
                                            sun::Refraction::standard(place), ground_, dem_.grid);
    }

    /// Stands above a place given as shares of the rows and columns.
    /// @param height_m  above the DEM's zero
    void stand(double column_share, double row_share, double height_m, double heading_deg,
               double pitch_deg) {
        geo::Geodetic place = dem_.grid.place(column_share * (dem_.grid.columns() - 1),
                                              row_share * (dem_.grid.rows() - 1));
        place.height_m = height_m;
        frame_.camera = scene::heading_camera(ground_.frame.to_local(place),
                                              ground_.frame.axes(place.lat_rad, place.lon_rad),
                                              heading_deg, pitch_deg, radians(kFov_deg));
    }

    /// Sees all cells from above, in parallel.
    void map(const glm::ivec2& map_px) {
        frame_.camera =
            scene::map_camera(dem_.grid, ground_.frame, scene::map_area(dem_.grid, 0, map_px));
    }

    image::ImageF radiance() {
        renderer_->render_frame(*terrain_, ground_, frame_);
        context_.check_errors();
        return renderer_->read_radiance();
    }

    /// What a hook wrote as radiance = vec3(a, b, 1.0) / frame.exposure: a and b,
    /// which halves hold to a share of 2048.
    static glm::dvec2 values(const image::ImageF& image, int x, int y) {
        const double unit = image.at(x, y, 2);
        return {image.at(x, y, 0) / unit, image.at(x, y, 1) / unit};
    }

    render::FrameInputs& frame() { return frame_; }
    const render::FrameInputs& frame() const { return frame_; }
    const render::Ground& ground() const { return ground_; }
    const dem::Heightfield& dem() const { return dem_; }
    render::Renderer& renderer() { return *renderer_; }
    render::Terrain& terrain() { return *terrain_; }
    int width_px() const { return width_px_; }
    int height_px() const { return height_px_; }

    /// Unit vector through a point of the picture, from its upper left corner.
    glm::dvec3 ray(double x_px, double y_px) const {
        const scene::Camera& camera = frame_.camera;
        const double tan_y = std::tan(camera.fov_y_rad / 2), step = 2 * tan_y / height_px_;
        return normalize(camera.forward +
                         step * (x_px - width_px_ / 2.0) * cross(camera.forward, camera.up) +
                         step * (height_px_ / 2.0 - y_px) * camera.up);
    }

  private:
    dem::Heightfield dem_;
    std::vector<effect::Effect> shipped_;
    render::Ground ground_;
    int width_px_, height_px_;
    std::vector<shader::Snippet> snippets_;
    shader::ParamStore values_;
    gl::Context context_{{.device = test::gl_device(), .debug = true}};
    std::optional<render::Renderer> renderer_;
    std::optional<render::Terrain> terrain_;
    render::NamedFields fields_;
    render::FrameInputs frame_;
};

/// A sky that no ground is as bright as, and whether a pixel shows it.
inline const TestEffect kBrightSky{
    "bright",
    "vec3 bright_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
    "    return vec3(0.0, 0.0, 40.0) / frame.exposure;\n"
    "}\n"};
inline bool is_sky(const image::ImageF& image, int x, int y) {
    return image.at(x, y, 0) == 0 && image.at(x, y, 1) == 0 && image.at(x, y, 2) > 0;
}

}  // namespace relevo::test

#include "session/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "dem/files_of.h"
#include "dem/load.h"
#include "geo/format.h"
#include "render/ground.h"
#include "scene/moment.h"
#include "session/active_effects.h"
#include "session/not_numbers.h"
#include "session/words.h"
#include "sun/celestial.h"
#include "sun/position.h"

namespace relevo::session {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

std::shared_ptr<const LoadedDem> load(const scene::Scene& scene) {
    const auto began = Clock::now();
    dem::Source source = dem::Source::open(scene.dems, scene.dem);
    dem::Heightfield field = dem::load(source, scene.dem.max_posts);
    return std::make_shared<const LoadedDem>(
        LoadedDem{std::move(source), std::move(field), milliseconds_since(began)});
}

constexpr int kDivider_px = 2;

/// Puts the left half of one picture beside the right half of the other, with a line between.
template <typename Picture, typename Value>
Picture side_by_side(const Picture& left, const Picture& right, Value line) {
    Picture both = right;
    const int first = std::max((left.width - kDivider_px) / 2, 0) * left.channels;
    const int last = std::min(left.width * left.channels, first + kDivider_px * left.channels);
    for (int y = 0; y < left.height; ++y) {
        std::copy_n(left.row(y), first, both.row(y));
        std::fill(both.row(y) + first, both.row(y) + last, line);
    }
    return both;
}

}  // namespace

double LoadedDem::height_m(const geo::Geodetic& at) const {
    if (field.reduction > 1) return source.height_at(at);
    const glm::dvec2 post = field.grid.post(at);
    return field.height_at(post.x, post.y);
}

/// What draws a scene: some effects, and of a comparison the rest of them.
struct Session::DrawnEffects {
    std::unique_ptr<ActiveEffects> effects, others;
    std::unique_ptr<render::Renderer> renderer, without;  // refer to these
};

struct Session::Impl {
    scene::Scene scene;
    Options options;
    StageTimes stages;

    // In the order in which each needs those above.
    std::optional<gl::Context> context;
    std::shared_ptr<const LoadedDem> loaded;
    DrawnEffects drawn;
    std::optional<render::Ground> ground;
    std::optional<render::Terrain> terrain;

    scene::Effects as_given;  ///< the scene's, as they were given
    sun::Instant utc;
    sun::Position position;
    sun::Refraction air = sun::Refraction::none();
    std::vector<glm::dvec3> points;
    render::FrameInputs inputs;

    Impl(scene::Scene given, Options o, FilesInUse& files)
        : scene(std::move(given)), options(std::move(o)) {
        dem::add_all(scene.dems, files);
        std::optional<sun::ParsedTime> time;
        const bool timed = !scene.moment.time.empty();
        if (timed && !needs_dem(scene.moment)) time = parse(scene.moment);
        // Where the system gives no further thread it is read when it is waited for.
        auto loading = std::async(std::launch::async | std::launch::deferred,
                                  [this] { return options.dem ? options.dem : load(scene); });
        open_device(files);
        const auto began = Clock::now();
        compile(drawn);
        stages.emplace_back("compile", milliseconds_since(began));
        loaded = loading.get();
        stages.emplace_back("load", options.dem ? 0 : loaded->took_ms);
        if (timed && !time) time = parse_over(scene.moment, loaded->source, loaded->field);
        upload();
        set_moment(time ? time->utc : scene::default_moment(ground->frame.origin()));
        look(scene.view);
    }

    DrawnEffects load_effects(const scene::Effects& asked) const {
        DrawnEffects result;
        const bool compared = !options.compared.empty();
        result.effects = ActiveEffects::of(compared ? with(asked, options.compared) : asked);
        if (compared)
            result.others =
                ActiveEffects::of(session::without(asked, options.compared, *result.effects),
                                  /*aloud=*/false);
        return result;
    }

    void open_device(FilesInUse& files) {
        const auto began = Clock::now();
        drawn = load_effects(scene.effects);
        drawn.effects->add_inputs(files);
        take_effects(scene.effects);
        context.emplace(options.context
                            ? options.context()
                            : gl::Context(gl::ContextOptions{.device = options.device}));
        fit(drawn);
        stages.emplace_back("device", milliseconds_since(began));
    }

    /// Says in the scene which effects there are.
    void take_effects(const scene::Effects& given) {
        as_given = given;
        scene.effects = given;
        scene.effects.settings =
            effect::with_absolute_files(std::move(scene.effects.settings), drawn.effects->values);
    }

    void fit(DrawnEffects& drawing) const {
        drawing.effects->fit(context->info());
        if (drawing.others) drawing.others->fit(context->info(), /*aloud=*/false);
    }

    render::RendererOptions renderer_options() const {
        return {
            .width_px = scene.width_px, .height_px = scene.height_px, .radiance = options.radiance};
    }

    void compile(DrawnEffects& drawing) {
        render::RendererOptions with_texts = renderer_options();
        with_texts.stitched = options.stitched;
        drawing.renderer =
            std::make_unique<render::Renderer>(*context, drawing.effects->inputs(), with_texts);
        if (drawing.others)
            drawing.without = std::make_unique<render::Renderer>(*context, drawing.others->inputs(),
                                                                 renderer_options());
    }

    void set_effects(const scene::Effects& asked) {
        context->make_current();
        DrawnEffects fresh = load_effects(asked);
        fit(fresh);
        compile(fresh);
        // A driver may refuse a program at its first draw.
        fresh.renderer->render_frame(*terrain, *ground, inputs);
        if (fresh.without) fresh.without->render_frame(*terrain, *ground, inputs);
        std::swap(drawn, fresh);
        take_effects(asked);
        look(scene.view);  // what effects displace may be in sight
    }

    /// The values in which two scenes with the same effects differ, where they may be set as they
    /// are; nothing where the difference is more than that.
    std::optional<std::vector<effect::Setting>> changed_values(const scene::Effects& next) const {
        const auto same_switches = [](const effect::Switches& a, const effect::Switches& b) {
            return a.only == b.only && a.enable == b.enable && a.disable == b.disable;
        };
        if (!same_switches(as_given.switches, next.switches) || as_given.presets != next.presets ||
            as_given.plugin_path != next.plugin_path ||
            as_given.settings.size() != next.settings.size())
            return std::nullopt;
        std::vector<effect::Setting> changed;
        for (std::size_t i = 0; i < next.settings.size(); ++i) {
            const effect::Setting &before = as_given.settings[i], &after = next.settings[i];
            if (before.address != after.address) return std::nullopt;
            if (before.text == after.text && before.folder == after.folder) continue;
            const shader::Param* const param = drawn.effects->values.find(after.address);
            if (!param || param->is_static || param->is_host) return std::nullopt;
            changed.push_back(after);
        }
        return changed;
    }

    void set_value(const std::string& address, const std::string& value) {
        for (const auto& [active, renderer] :
             {std::pair(drawn.effects.get(), drawn.renderer.get()),
              std::pair(drawn.others.get(), drawn.without.get())}) {
            if (!active) continue;
            const shader::Param* const param = active->values.find(address);
            if (param && param->is_static)
                bad_input(fmt::format("session: {}: it is static: another value is another program",
                                      address));
            active->values.set(address, value);
            renderer->set_values(active->values);
        }
        for (scene::Effects* effects : {&as_given, &scene.effects}) {
            scene::Effects change;
            change.settings = {{address, value}};
            *effects = scene::merge(std::move(*effects), change);
        }
    }

    void resize(int width_px, int height_px) {
        scene.width_px = width_px;
        scene.height_px = height_px;
        drawn.renderer->resize(width_px, height_px);
        if (drawn.without) drawn.without->resize(width_px, height_px);
    }

    void show(const scene::Scene& next, sun::Instant instant) {
        context->make_current();
        inputs.afresh = true;
        if (const auto values = changed_values(next.effects)) {
            for (const effect::Setting& value : *values)
                set_value(value.address, value.text);
            take_effects(next.effects);  // in the order that they were given in
        } else {
            set_effects(next.effects);
        }
        resize(next.width_px, next.height_px);
        scene.exposure_ev = next.exposure_ev;
        scene.refraction = next.refraction;
        const bool other_shape = next.exaggeration != scene.exaggeration;
        scene.exaggeration = next.exaggeration;
        if (next.pixel_error != scene.pixel_error) {
            scene.pixel_error = next.pixel_error;
            upload();
        } else {
            take_shape(other_shape);
        }
        scene.moment = next.moment;
        set_moment(instant);
        look(next.view);
    }

    void upload() {
        const auto began = Clock::now();
        ground = render::make_ground(loaded->field);
        terrain.emplace(
            loaded->field, ground->frame,
            render::TerrainOptions{.pixel_error = scene.pixel_error,
                                   .max_array_layers = context->info().max_array_layers},
            &loaded->source);
        stages.emplace_back("upload", milliseconds_since(began));
        take_shape(/*other=*/true);
    }

    /// @param other  the ground is exaggerated otherwise than before
    void take_shape(bool other) {
        inputs.exaggeration = scene.exaggeration;
        inputs.exposure_ev = scene.exposure_ev;
        if (other) points = render::points_to_show(loaded->field, *ground, scene.exaggeration);
    }

    void set_moment(sun::Instant instant) {
        utc = instant;
        const geo::Geodetic place = ground->frame.origin();
        position = sun::position(utc, place);
        air =
            refraction_at(scene.refraction, {place.lat_rad, place.lon_rad, ground->air_height_m()});
        inputs.sun = render::make_sun_light(position, air, *ground, loaded->field.grid);
        inputs.stars = sun::celestial_frame(sun::Epoch::at(utc), place);
        inputs.unix_s = static_cast<double>(utc.unix_us()) * 1e-6;
    }

    void look(const scene::View& view) {
        inputs.camera = scene::make_camera(
            view, [this](const geo::Geodetic& at) { return loaded->height_m(at); }, ground->frame,
            points, static_cast<double>(scene.width_px) / scene.height_px, scene.exaggeration,
            render::points_moved_to(points, *ground, scene.exaggeration,
                                    drawn.renderer->displacement()));
        scene.view = view;
    }

    /// Where the sun that is told of is seen from, as `relevo sun position` has it.
    geo::Geodetic eye() const {
        geo::Geodetic eye = ground->frame.to_geodetic(inputs.camera.eye_m);
        eye.height_m /= scene.exaggeration;
        return eye;
    }

    void draw(render::Loading loading, render::PassTimes* times = nullptr) {
        context->make_current();
        render::FrameInputs frame = inputs;
        frame.loading = loading;
        drawn.renderer->render_frame(*terrain, *ground, frame, times);
        if (drawn.without) drawn.without->render_frame(*terrain, *ground, frame);
    }

    /// @throws Error where the last frame has light that is no number
    void check_numbers(int count, const ActiveEffects& shown) {
        if (count > 0)
            refuse_not_numbers({scene.effects, shown, *context, renderer_options(), *terrain,
                                *ground, inputs, count});
    }

    template <typename Read, typename Value>
    auto read(const Read& read_of, Value line) {
        int not_numbers = 0, others_not_numbers = 0;
        auto picture = read_of(*drawn.renderer, &not_numbers);
        if (drawn.without)
            picture = side_by_side(picture, read_of(*drawn.without, &others_not_numbers), line);
        check_numbers(not_numbers, *drawn.effects);
        if (drawn.without) check_numbers(others_not_numbers, *drawn.others);
        return picture;
    }
};

Session::Session(scene::Scene scene, Options options, FilesInUse& files)
    : impl_(std::make_unique<Impl>(std::move(scene), std::move(options), files)) {}

Session::~Session() {
    // What the session has on the device goes with its own context.
    try {
        impl_->context->make_current();
    } catch (const Error& error) {
        log::warning(error.what());
    }
}

const scene::Scene& Session::scene() const {
    return impl_->scene;
}

void Session::look(const scene::View& view) {
    impl_->look(view);
}

void Session::set_moment(sun::Instant utc) {
    impl_->set_moment(utc);
    impl_->scene.moment.time = sun::exact_iso(utc);
    impl_->scene.moment.date.clear();
}

sun::Instant Session::moment() const {
    return impl_->utc;
}

void Session::set_effects(const scene::Effects& effects) {
    impl_->set_effects(effects);
}

const ActiveEffects& Session::effects() const {
    return *impl_->drawn.effects;
}

void Session::set(const std::string& address, const std::string& value) {
    impl_->context->make_current();
    impl_->set_value(address, value);
}

void Session::show(const scene::Scene& scene, sun::Instant utc) {
    impl_->show(scene, utc);
}

void Session::resize(int width_px, int height_px) {
    impl_->context->make_current();
    impl_->resize(width_px, height_px);
    impl_->look(impl_->scene.view);
}

void Session::draw(render::PassTimes* times) {
    impl_->draw(render::Loading::Wait, times);
}

void Session::keep_native(bool keep) {
    impl_->inputs.keep_native = keep;
}

bool Session::draw_what_is_there() {
    impl_->draw(render::Loading::Beside);
    return impl_->terrain->is_complete();
}

void Session::draw_alone() {
    impl_->context->make_current();
    impl_->drawn.renderer->render_frame(*impl_->terrain, *impl_->ground, impl_->inputs);
    impl_->context->finish();
}

image::Image8 Session::picture() const {
    impl_->context->make_current();
    return impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_picture(count); },
        std::uint8_t{255});
}

image::ImageF Session::radiance() const {
    impl_->context->make_current();
    return impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_radiance(count); },
        0.0f);
}

const gl::Texture& Session::texture() const {
    return impl_->drawn.renderer->picture();
}

bool Session::shows_ground() const {
    std::vector<float> depths_m;
    read_depths(depths_m);
    return std::any_of(depths_m.begin(), depths_m.end(),
                       [](float depth_m) { return std::isfinite(depth_m); });
}

void Session::read_depths(std::vector<float>& depths_m) const {
    impl_->context->make_current();
    impl_->drawn.renderer->read_depths(depths_m);
}

const scene::Camera& Session::camera() const {
    return impl_->inputs.camera;
}

const std::shared_ptr<const LoadedDem>& Session::dem() const {
    return impl_->loaded;
}

const render::Ground& Session::ground() const {
    return *impl_->ground;
}

std::string Session::place_text() const {
    return impl_->scene.view.eye ? geo::degrees_text(impl_->eye()) + " (the eye)"
                                 : geo::degrees_text(impl_->ground->frame.origin());
}

std::string Session::sun_text() const {
    if (!impl_->scene.view.eye) return session::sun_text(impl_->position, impl_->air);
    const geo::Geodetic eye = impl_->eye();
    return session::sun_text(sun::position(impl_->utc, eye),
                             refraction_at(impl_->scene.refraction, eye));
}

const StageTimes& Session::stages() const {
    return impl_->stages;
}

int Session::triangles() const {
    return impl_->drawn.renderer->triangles();
}

const gl::DeviceInfo& Session::device() const {
    return impl_->context->info();
}

}  // namespace relevo::session

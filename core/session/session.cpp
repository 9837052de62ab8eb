#include "session/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "dem/files_of.h"
#include "geo/format.h"
#include "render/ground.h"
#include "scene/moment.h"
#include "session/active_effects.h"
#include "session/climate_words.h"
#include "session/colour_legends.h"
#include "session/not_numbers.h"
#include "session/overlay.h"
#include "session/stamps.h"
#include "session/standing.h"
#include "session/words.h"
#include "sun/celestial.h"
#include "sun/position.h"
#include "sun/zone_of_place.h"

namespace relevo::session {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

/// Where the climate is told of: the DEM's middle, at the middle of its heights above the sea.
geo::Geodetic middle_of(const render::Ground& ground) {
    geo::Geodetic middle = ground.frame.origin();
    middle.height_m = middle_height_m(ground.lowest_m, ground.highest_m);
    return middle;
}

std::shared_ptr<const LoadedDem> load(const scene::Scene& scene, bool may_stand_in) {
    auto source = std::make_shared<const dem::Source>(dem::Source::open(scene.dems, scene.dem));
    if (may_stand_in)
        if (auto stand_in = load_stand_in(source, scene)) return stand_in;
    return load_dem(std::move(source), scene);
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
    render::ProgramCache programs;
    std::shared_ptr<const LoadedDem> loaded;
    render::SkyAhead sky_ahead;  // of the first ground
    DrawnEffects drawn;
    std::optional<render::Ground> ground;
    std::optional<render::Terrain> terrain;

    std::shared_ptr<const render::Drape> drape;
    std::optional<Overlay> overlay;  // the scene's
    std::optional<OverlayTime> overlay_time;
    std::vector<std::string> stamp_notes;

    scene::Effects as_given;  ///< the scene's, as they were given
    sun::Instant utc;
    sun::Position position;
    sun::Refraction air = sun::Refraction::none();
    struct AirAsked {
        std::string model;
        geo::Geodetic place;
        bool operator==(const AirAsked&) const = default;
    };
    std::optional<AirAsked> air_asked;  // what `air` was integrated for
    render::GroundToShow to_show;
    struct MovedPoints {
        render::Displacement by;
        std::vector<glm::dvec3> points;
    };
    std::optional<MovedPoints> moved;  // of `to_show`
    std::optional<scene::DefaultDay> day;
    std::optional<scene::Framing> framing;  // of the last view that left an angle open
    std::string moment_reason;
    render::FrameInputs inputs;
    std::optional<double> keep_above_m;  ///< as look() has it

    Impl(scene::Scene given, Options o, FilesInUse& files)
        : scene(std::move(given)), options(std::move(o)) {
        if (scene.overlay) {
            add_files(*scene.overlay, files);
            overlay_time = time_of(*scene.overlay);
        }
        std::optional<sun::ParsedTime> time;
        const bool timed = !scene.moment.time.empty();
        if (timed && !needs_dem(scene.moment)) time = parse(scene.moment);
        // Where the system gives no further thread it is read when it is waited for.
        auto loading = std::async(std::launch::async | std::launch::deferred,
                                  [this] { return options.dem ? options.dem : load_own(); });
        open_device(files);
        loaded = loading.get();
        dem::add_all(scene.dems, files);
        // Which effects are on may depend on the ground.
        take_ground(drawn);
        const auto began = Clock::now();
        compile(drawn);
        stages.emplace_back("compile", milliseconds_since(began));
        stages.emplace_back("load", options.dem ? 0 : loaded->took_ms);
        if (timed && !time) time = parse_over(scene.moment, *loaded->source, loaded->field);
        upload();
        check_eye_height(scene.view, loaded->field.about.path);
        look(scene.view);
        warn_of_eye();
        set_moment(time ? time->utc : default_moment());
    }

    /// Events over the ground are looked for in all of it.
    std::shared_ptr<const LoadedDem> load_own() const {
        const bool timed = !scene.moment.time.empty();
        return load(scene, options.may_stand_in && !(timed && needs_dem(scene.moment)));
    }

    /// Of the camera as it is.
    sun::Instant default_moment() {
        const scene::DefaultMoment moment = day->moment(scene::side_of_deg(inputs.camera));
        moment_reason = moment.reason();
        return moment.utc;
    }

    DrawnEffects load_effects(const scene::Effects& asked) const {
        DrawnEffects result;
        const bool compared = !options.compared.empty();
        result.effects = ActiveEffects::of(compared ? with(asked, options.compared) : asked,
                                           /*aloud=*/true, ground_words());
        // They are those of the scene's sun, and the overlay is of another's.
        if (overlay_time)
            for (const std::string& id : result.effects->switch_off_unasked("shadow"))
                if (!drawn.effects)
                    log::info(fmt::format(
                        "{} is off, because the overlay shows the sun's light of its own time; "
                        "--enable {} draws them too",
                        id, id));
        if (compared)
            result.others =
                ActiveEffects::of(session::without(asked, options.compared, *result.effects),
                                  /*aloud=*/false, ground_words());
        return result;
    }

    effect::GroundWords ground_words() const {
        if (!loaded) return std::nullopt;
        return loaded->ground_words(scene.holes);
    }

    void take_ground(DrawnEffects& drawing) const {
        drawing.effects->take_ground(ground_words(), scene.effects);
        if (drawing.others) drawing.others->take_ground(ground_words(), scene.effects, false);
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

    render::RendererOptions renderer_options() {
        return {.width_px = scene.width_px,
                .height_px = scene.height_px,
                .radiance = options.radiance,
                .draped = drape || (scene.overlay && !terrain),
                .outside = !scene.view.eye,
                .audited = options.audited,
                .programs = &programs};
    }

    void compile(DrawnEffects& drawing) {
        render::RendererOptions with_texts = renderer_options();
        with_texts.stitched = [this](const render::StitchedFrames& frames) {
            if (options.stitched) options.stitched(frames);
            look_ahead(frames.programs);
        };
        drawing.renderer =
            std::make_unique<render::Renderer>(*context, drawing.effects->inputs(), with_texts);
        if (drawing.others)
            drawing.without = std::make_unique<render::Renderer>(*context, drawing.others->inputs(),
                                                                 renderer_options());
    }

    /// While the driver compiles the first programs, other processors find what these will read.
    void look_ahead(const std::vector<render::ProgramText>& texts) {
        if (terrain || sky_ahead.valid()) return;
        const auto reads_sky = [](const render::ProgramText& text) {
            return std::ranges::any_of(text.stitched.textures, [](const auto& unit) {
                return unit.resource == "light_sky";
            });
        };
        if (thread_count() > 1 && std::ranges::any_of(texts, reads_sky))
            sky_ahead = render::find_sky_ahead(loaded->to_draw(), scene.exaggeration);
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
                bad_input(fmt::format(
                    "session: {}: a static parameter: another value needs another shader",
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
        scene.stamps = next.stamps;
        scene.moment = next.moment;
        set_moment(instant);
        check_eye_height(next.view, loaded->field.about.path);
        look(next.view);
        warn_of_eye();
    }

    void upload() {
        const auto began = Clock::now();
        ground = ground_of(*loaded);
        terrain.emplace(
            loaded->to_draw(), ground->frame,
            render::TerrainOptions{
                .pixel_error = scene.pixel_error,
                .max_array_layers = context->info().max_array_layers,
                .pyramid = loaded->pyramid ? &*loaded->pyramid : nullptr,
                .water = &loaded->drawn.water,
                .filled = loaded->drawn.is_filled.empty() ? nullptr : &loaded->drawn.is_filled,
                .sky = std::exchange(sky_ahead, {})},
            loaded->source.get());
        if (scene.overlay) {
            overlay = read_overlay(*scene.overlay, terrain->grid());
            drape = overlay->drape;
            terrain->drape(drape);
        }
        stages.emplace_back("upload", milliseconds_since(began));
        take_shape(/*other=*/true);
    }

    void take(std::shared_ptr<const LoadedDem> dem, const scene::Scene& given) {
        context->make_current();
        const bool others = loaded->ground_words(scene.holes) != dem->ground_words(scene.holes);
        terrain.reset();  // refers to the one before
        loaded = std::move(dem);
        upload();
        if (!scene.overlay) terrain->drape(drape);
        look(given.view);
        set_moment(given.moment.time.empty() ? default_moment() : utc);
        if (others) set_effects(scene::Effects(as_given));
    }

    /// @param other  the ground is exaggerated otherwise than before
    void take_shape(bool other) {
        inputs.exaggeration = scene.exaggeration;
        inputs.exposure_ev = scene.exposure_ev;
        if (other) {
            to_show = render::ground_to_show(loaded->field, *ground, scene.exaggeration);
            moved.reset();
        }
        day.emplace(ground->frame.origin(), ground->block_m <= 0);
    }

    void lay(std::shared_ptr<const render::Drape> wanted) {
        const bool other_program = bool(drape) != bool(wanted);
        std::swap(drape, wanted);
        context->make_current();
        if (other_program) {
            try {
                compile(drawn);
            } catch (...) {
                std::swap(drape, wanted);
                throw;
            }
        }
        terrain->drape(drape);
    }

    void set_moment(sun::Instant instant) {
        utc = instant;
        const geo::Geodetic place = ground->frame.origin();
        position = sun::position(utc, place);
        const AirAsked asked{scene.refraction,
                             {place.lat_rad, place.lon_rad, ground->air_height_m()}};
        if (air_asked != asked) air = refraction_at(asked.model, asked.place);
        air_asked = asked;
        inputs.sun = render::make_sun_light(position, air, *ground, loaded->field.grid);
        if (air.bends())
            inputs.sun.air = [model = scene.refraction](const geo::Geodetic& at) {
                return refraction_at(model, at);
            };
        inputs.stars = sun::celestial_frame(sun::Epoch::at(utc), place);
        inputs.unix_s = static_cast<double>(utc.unix_us()) * 1e-6;
    }

    /// An orbit's open angles are filled in, so that the scene says which they are.
    void look(scene::View view) {
        if (!view.eye && (!view.orbit.azimuth_deg || !view.orbit.elevation_deg)) {
            framing = scene::frame_ground(view.orbit, to_show.net, *day);
            view.orbit = framing->orbit;
        }
        inputs.camera = standing(view, drawn_ground(), keep_above_m);
        scene.view = view;
    }

    DrawnGround drawn_ground() {
        const auto camera_of = [this](const scene::View& view) {
            return scene::make_camera(
                view, heights_to_aim_at(), ground->frame, view.eye ? scene::Outline() : outline(),
                static_cast<double>(scene.width_px) / scene.height_px, scene.exaggeration);
        };
        return {ground->frame, scene.exaggeration,
                [this](const scene::Camera& camera) { return drawn_height_m(camera); }, camera_of};
    }

    /// Height of the ground as it is drawn below a camera's eye, exaggerated; none where the eye is
    /// above all ground.
    std::optional<double> drawn_height_m(const scene::Camera& camera) {
        const auto [lowest_m, highest_m] =
            drawn.renderer->displacement().range_m(ground->lowest_m, ground->highest_m);
        const double eye_m = ground->frame.to_geodetic(camera.eye_m).height_m;
        if (eye_m > highest_m * scene.exaggeration + scene::kClearance_m) return std::nullopt;
        context->make_current();
        render::FrameInputs frame = inputs;
        frame.camera = camera;
        return drawn.renderer->drawn_height_m(*terrain, *ground, frame);
    }

    /// Of a scene that is given; where a user moves the eye, they see where it is.
    void warn_of_eye() {
        const auto drawn_m = [this](const geo::Geodetic&) {
            const std::optional<double> height_m = drawn_height_m(inputs.camera);
            return height_m ? *height_m / scene.exaggeration : std::nan("");
        };
        scene::warn_of_eye_below_ground(scene.view, drawn_m, ground->frame, scene.exaggeration);
    }

    scene::GroundHeight heights_to_aim_at() const {
        return session::heights_to_aim_at(loaded, drawn.renderer->displacement());
    }

    scene::Outline outline() {
        scene::Outline outline{to_show.points, moved_points()};
        if (drawn.renderer->shows_block()) {
            const auto base = render::block_below(to_show.rim, *ground, scene.exaggeration);
            outline.points.insert(outline.points.end(), base.begin(), base.end());
        }
        return outline;
    }

    /// The ground's points where effects move them to: the same for every camera.
    const std::vector<glm::dvec3>& moved_points() {
        const render::Displacement displacement = drawn.renderer->displacement();
        if (!moved || moved->by != displacement)
            moved = {displacement, render::points_moved_to(to_show.points, *ground,
                                                           scene.exaggeration, displacement)};
        return moved->points;
    }

    /// The eye where the sun that is told of is seen from, as `relevo sun position` has it; none
    /// where it is the DEM's middle, also of eyes so high that no sun is told of there.
    std::optional<geo::Geodetic> eye() const {
        if (!scene.view.eye) return std::nullopt;
        return session::told_eye(ground->frame, inputs.camera, scene.exaggeration);
    }

    /// What effects show that the DEM does not have, of ground as near as that below the eye.
    std::vector<std::string> inventions() const {
        std::vector<std::string> told;
        const std::optional<geo::Geodetic> from = eye();
        if (!from) return told;
        const double ground_m = loaded->height_m(*from);
        if (std::isnan(ground_m)) return told;
        const glm::dvec2 spacing_m = terrain->grid().post_spacing_m();
        const double pixel_rad = 2 * std::tan(inputs.camera.fov_y_rad / 2) / scene.height_px;
        const double pixel_posts = (from->height_m - ground_m) * scene.exaggeration * pixel_rad /
                                   std::sqrt(spacing_m.x * spacing_m.y);
        for (const effect::Effect* const effect : drawn.effects->loaded.selection.effects) {
            const auto& invents = effect->manifest.invents;
            if (!invents || pixel_posts >= invents->pixel_posts) continue;
            if (drawn.effects->values.value(invents->address)[0] > 0)
                told.push_back(fmt::format("{}: {}; --set {}=0 removes it", effect->manifest.id,
                                           invents->what, invents->address));
        }
        return told;
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

void Session::look(const scene::View& view, std::optional<double> keep_above_m) {
    impl_->keep_above_m = keep_above_m;
    impl_->look(view);
}

scene::GroundHeight Session::heights_to_aim_at() const {
    return impl_->heights_to_aim_at();
}

void Session::set_moment(sun::Instant utc) {
    impl_->set_moment(utc);
    impl_->scene.moment.time = sun::exact_iso(utc);
    impl_->scene.moment.date.clear();
}

void Session::take(std::shared_ptr<const LoadedDem> dem, const scene::Scene& given) {
    impl_->take(std::move(dem), given);
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
    const render::Displacement before = impl_->drawn.renderer->displacement();
    impl_->set_value(address, value);
    if (impl_->drawn.renderer->displacement() != before) impl_->look(impl_->scene.view);
}

void Session::show(const scene::Scene& scene, sun::Instant utc) {
    impl_->show(scene, utc);
}

void Session::resize(int width_px, int height_px) {
    if (width_px == impl_->scene.width_px && height_px == impl_->scene.height_px) return;
    impl_->context->make_current();
    impl_->resize(width_px, height_px);
    impl_->look(impl_->scene.view);
}

void Session::draw(render::PassTimes* times) {
    impl_->draw(render::Loading::Wait, times);
}

void Session::drape(std::shared_ptr<const render::Drape> drape) {
    impl_->lay(std::move(drape));
}

std::vector<chart::Legend> Session::colour_legends() const {
    return session::colour_legends(effects(), {impl_->ground->lowest_m, impl_->ground->highest_m,
                                               impl_->loaded->drawn.water.has_sea_floor});
}

std::vector<chart::Legend> Session::legends() const {
    std::vector<chart::Legend> all = colour_legends();
    if (impl_->overlay)
        all.insert(all.begin(), dated_legend(*impl_->overlay, impl_->scene.moment.zone,
                                             impl_->ground->frame.origin()));
    return all;
}

const std::vector<std::string>& Session::compared() const {
    return impl_->options.compared;
}

const std::optional<OverlayTime>& Session::overlay_time() const {
    return impl_->overlay_time;
}

const std::vector<std::string>& Session::stamp_notes() const {
    return impl_->stamp_notes;
}

void Session::keep_native(bool keep) {
    impl_->inputs.keep_native = keep;
}

bool Session::draw_what_is_there() {
    impl_->draw(render::Loading::Beside);
    return impl_->terrain->is_complete();
}

bool Session::is_loading() const {
    return impl_->terrain->is_making_pages();
}

void Session::draw_alone() {
    impl_->context->make_current();
    impl_->drawn.renderer->render_frame(*impl_->terrain, *impl_->ground, impl_->inputs);
    impl_->context->finish();
}

image::Image8 Session::picture() const {
    impl_->context->make_current();
    image::Image8 picture = impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_picture(count); },
        std::uint8_t{255});
    impl_->stamp_notes = add_stamps(*this, legends(), picture);
    return picture;
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
    return std::ranges::any_of(depths_m, [](float depth_m) { return std::isfinite(depth_m); });
}

void Session::read_depths(std::vector<float>& depths_m) const {
    impl_->context->make_current();
    impl_->drawn.renderer->read_depths(depths_m);
}

std::vector<render::SunSeen> Session::read_sun_seen() const {
    impl_->context->make_current();
    return impl_->drawn.renderer->read_sun_seen();
}

const render::SunLight& Session::sun_light() const {
    return impl_->inputs.sun;
}

const scene::Camera& Session::camera() const {
    return impl_->inputs.camera;
}

scene::Outline Session::outline() const {
    return impl_->outline();
}

const std::shared_ptr<const LoadedDem>& Session::dem() const {
    return impl_->loaded;
}

const render::Ground& Session::ground() const {
    return *impl_->ground;
}

std::vector<std::string> Session::ground_notes() const {
    std::vector<std::string> notes;
    const LoadedDem::Drawn& drawn = impl_->loaded->drawn;
    if (!drawn.holes_text.empty()) notes.push_back(drawn.holes_text);
    for (const std::string& assumption : drawn.water.assumptions)
        notes.push_back(assumption);
    for (std::string& invention : impl_->inventions())
        notes.push_back(std::move(invention));
    return notes;
}

std::string Session::place_text() const {
    const std::optional<geo::Geodetic> eye = impl_->eye();
    return eye ? geo::degrees_text(*eye) + " (the eye)"
               : geo::degrees_text(impl_->ground->frame.origin());
}

std::string Session::clock_text() const {
    return session::clock_text(impl_->utc, impl_->scene.moment.zone, impl_->ground->frame.origin());
}

std::string Session::sun_text() const {
    const std::optional<geo::Geodetic> eye = impl_->eye();
    if (!eye) return session::sun_text(impl_->position, impl_->air);
    return session::sun_text(sun::position(impl_->utc, *eye),
                             refraction_at(impl_->scene.refraction, *eye));
}

std::string Session::view_reason() const {
    return impl_->framing ? impl_->framing->reason() : std::string();
}

const std::string& Session::moment_reason() const {
    return impl_->moment_reason;
}

std::string Session::climate_text() const {
    if (!impl_->drawn.renderer->reads_climate()) return {};
    impl_->context->make_current();
    const ClimateReport report =
        climate_report(impl_->terrain->climate_map(), middle_of(*impl_->ground), impl_->utc);
    return session::climate_text(report) + "; " + ground_text(report);
}

int Session::linked_programs() const {
    return impl_->programs.links();
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

#include "session/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "dem/files_of.h"
#include "session/active_effects.h"
#include "session/climate_words.h"
#include "session/colour_legends.h"
#include "session/drawn_effects.h"
#include "session/non_finite.h"
#include "session/overlay.h"
#include "session/scene_state.h"
#include "session/stamps.h"
#include "session/standing.h"
#include "session/words.h"
#include "sun/zone_of_place.h"

namespace relevo::session {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

std::shared_ptr<const LoadedDem> load(const scene::Scene& scene, bool allow_preview) {
    auto source = std::make_shared<const dem::Source>(dem::Source::open(scene.dems, scene.dem));
    if (allow_preview)
        if (auto preview = load_preview(source, scene)) return preview;
    return load_dem(std::move(source), scene);
}

constexpr int kDivider_px = 2;

/// Joins the left half of one image and the right half of another, with a dividing line.
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

struct Session::Impl {
    Options options;
    SceneState state;
    StageTimes stages;

    // In order of dependency.
    std::optional<gl::Context> context;
    render::SharedResources shared;
    render::SkyAhead sky_ahead;  // for the first DEM
    RecentEffects recent;
    std::optional<DrawnEffects> drawn;
    std::optional<render::Terrain> terrain;

    std::shared_ptr<const render::Drape> drape;
    std::optional<Overlay> overlay;  // of the scene
    std::optional<OverlayTime> overlay_time;
    std::vector<std::string> stamp_notes;

    Impl(scene::Scene given, Options o, FilesInUse& files)
        : options(std::move(o)), state(std::move(given)) {
        const scene::Scene& scene = state.scene;
        if (scene.overlay) {
            add_files(*scene.overlay, files);
            overlay_time = time_of(*scene.overlay);
        }
        std::optional<sun::ParsedTime> time;
        const bool timed = !scene.moment.time.empty();
        if (timed && !needs_dem(scene.moment)) time = parse(scene.moment);
        // Deferred to get() if no thread can be created.
        auto loading = std::async(std::launch::async | std::launch::deferred,
                                  [this] { return options.dem ? options.dem : load_own(); });
        open_device(files);
        const std::shared_ptr<const LoadedDem> loaded = loading.get();
        dem::add_all(scene.dems, files);
        // Which effects are on may depend on the DEM.
        drawn->take_ground(loaded->ground_words(scene.holes));
        const auto began = Clock::now();
        compile(*drawn, loaded.get());
        stages.emplace_back("compile", milliseconds_since(began));
        stages.emplace_back("load", options.dem ? 0 : loaded->took_ms);
        if (timed && !time) time = parse_over(scene.moment, *loaded->source, loaded->field);
        upload(loaded);
        look(scene.view);
        warn_of_eye();
        state.set_time(time ? time->utc : state.default_time());
    }

    /// Events that depend on terrain need all posts, not a preview.
    std::shared_ptr<const LoadedDem> load_own() const {
        const bool timed = !state.scene.moment.time.empty();
        return load(state.scene,
                    options.allow_preview && !(timed && needs_dem(state.scene.moment)));
    }

    void open_device(FilesInUse& files) {
        const auto began = Clock::now();
        drawn = DrawnEffects::load(request(state.scene.effects), /*report=*/true);
        drawn->effects().add_inputs(files);
        take_effects();
        context.emplace(options.context
                            ? options.context()
                            : gl::Context(gl::ContextOptions{.device = options.device}));
        drawn->fit(context->info());
        stages.emplace_back("device", milliseconds_since(began));
    }

    EffectsRequest request(const scene::Effects& effects) const {
        EffectsRequest request{.effects = effects, .compared = options.compared};
        if (state.dem()) request.ground = state.dem()->ground_words(state.scene.holes);
        request.draped = is_draped();
        request.overlay_has_time = overlay_time.has_value();
        return request;
    }

    bool is_draped() const { return drape || (state.scene.overlay && !terrain); }

    /// Copies the drawn effects into the scene.
    void take_effects() {
        state.scene.effects = drawn->request().effects;
        state.scene.effects.settings = effect::with_absolute_files(
            std::move(state.scene.effects.settings), drawn->effects().values);
    }

    render::RendererOptions renderer_options() {
        return {.width_px = state.scene.width_px,
                .height_px = state.scene.height_px,
                .radiance = options.radiance,
                .draped = is_draped(),
                .outside = !state.scene.view.eye,
                .audited = options.audited,
                .shared = &shared};
    }

    /// @param first_dem  the DEM before its terrain is created; else null
    void compile(DrawnEffects& effects, const LoadedDem* first_dem = nullptr) {
        effects.compile(*context, [&] {
            render::RendererOptions with_texts = renderer_options();
            with_texts.stitched = [this, first_dem](const render::StitchedFrames& frames) {
                if (options.stitched) options.stitched(frames);
                if (first_dem) compute_sky(*first_dem, frames.programs);
            };
            return with_texts;
        });
    }

    /// Computes the sky-view factor on the CPU while the driver compiles programs that read it.
    void compute_sky(const LoadedDem& dem, const std::vector<render::ProgramText>& texts) {
        const auto reads_sky = [](const render::ProgramText& text) {
            return std::ranges::any_of(text.stitched.textures, [](const auto& unit) {
                return unit.resource == "light_sky";
            });
        };
        if (!sky_ahead.valid() && thread_count() > 1 && std::ranges::any_of(texts, reads_sky))
            sky_ahead = render::find_sky_ahead(dem.to_draw(), state.scene.exaggeration);
    }

    void set_effects(const scene::Effects& asked) {
        context->make_current();
        switch_to(request(asked));
        take_effects();
        look(state.scene.view);  // displacement may move the ground under the eye
    }

    /// Draws a request: with the current effects, with recent ones, or with newly loaded ones.
    void switch_to(const EffectsRequest& wanted) {
        if (drawn->take(wanted)) return;
        if (std::optional<DrawnEffects> known = recent.take(wanted)) {
            known->resize(state.scene.width_px, state.scene.height_px);
            recent.keep(std::exchange(*drawn, std::move(*known)));
            return;
        }
        DrawnEffects fresh = DrawnEffects::load(wanted, /*report=*/false);
        fresh.fit(context->info());
        compile(fresh);
        // Drivers may reject a program at its first draw, and modules fail at their first frame.
        if (fresh.is_watched() || fresh.has_modules())
            fresh.render(*terrain, state.ground(), state.inputs);
        recent.keep(std::exchange(*drawn, std::move(fresh)));
        shared.targets.trim();  // sets of targets differ between effects
    }

    void resize(int width_px, int height_px) {
        state.scene.width_px = width_px;
        state.scene.height_px = height_px;
        drawn->resize(width_px, height_px);
    }

    void show(const scene::Scene& next, sun::Instant utc) {
        context->make_current();
        state.inputs.deterministic = true;
        if (const EffectsRequest wanted = request(next.effects); wanted != drawn->request()) {
            switch_to(wanted);
            take_effects();
        }
        resize(next.width_px, next.height_px);
        scene::Scene& scene = state.scene;
        scene.exposure_ev = next.exposure_ev;
        scene.refraction = next.refraction;
        const bool other_shape = next.exaggeration != scene.exaggeration;
        scene.exaggeration = next.exaggeration;
        if (next.pixel_error != scene.pixel_error) {
            scene.pixel_error = next.pixel_error;
            upload(state.dem());
        } else {
            state.take_shape(other_shape);
        }
        scene.stamps = next.stamps;
        scene.moment = next.moment;
        state.set_time(utc);
        look(next.view);
        warn_of_eye();
    }

    void upload(const std::shared_ptr<const LoadedDem>& dem) {
        const auto began = Clock::now();
        terrain.reset();  // refers to the previous DEM
        state.take_dem(dem);
        terrain.emplace(
            dem->to_draw(), state.ground().frame,
            render::TerrainOptions{
                .pixel_error = state.scene.pixel_error,
                .max_array_layers = context->info().max_array_layers,
                .pyramid = dem->pyramid ? &*dem->pyramid : nullptr,
                .water = &dem->drawn.water,
                .filled = dem->drawn.is_filled.empty() ? nullptr : &dem->drawn.is_filled,
                .sky = std::exchange(sky_ahead, {}),
                .shadows_on = context->info().device.software ? render::ShadowsOn::Processor
                                                              : render::ShadowsOn::Device},
            dem->source.get());
        if (state.scene.overlay) {
            overlay = read_overlay(*state.scene.overlay, terrain->grid());
            drape = overlay->drape;
        }
        terrain->drape(drape);
        stages.emplace_back("upload", milliseconds_since(began));
        state.take_shape(/*other=*/true);
    }

    void take(const std::shared_ptr<const LoadedDem>& dem, const scene::Scene& given) {
        context->make_current();
        upload(dem);
        look(given.view);
        state.set_time(given.moment.time.empty() ? state.default_time() : state.utc());
        const scene::Effects effects = drawn->request().effects;
        if (request(effects).ground != drawn->request().ground) set_effects(effects);
    }

    void set_drape(std::shared_ptr<const render::Drape> wanted) {
        context->make_current();
        std::swap(drape, wanted);
        terrain->drape(drape);
        try {
            const EffectsRequest with_drape = request(drawn->request().effects);
            if (with_drape != drawn->request()) switch_to(with_drape);
        } catch (...) {
            std::swap(drape, wanted);
            terrain->drape(drape);
            throw;
        }
    }

    void look(const scene::View& view) {
        check_eye_height(view, state.dem()->field.about.path);
        state.look(view, shape());
    }

    DrawnShape shape() {
        return {drawn->renderer().displacement(), drawn->renderer().shows_block(),
                [this](const scene::Camera& camera) { return drawn_height_m(camera); }};
    }

    std::optional<double> drawn_height_m(const scene::Camera& camera) {
        const render::Ground& ground = state.ground();
        const auto [lowest_m, highest_m] =
            drawn->renderer().displacement().range_m(ground.lowest_m, ground.highest_m);
        const double eye_m = ground.frame.to_geodetic(camera.eye_m).height_m;
        if (eye_m > highest_m * state.scene.exaggeration + scene::kClearance_m) return std::nullopt;
        context->make_current();
        render::FrameInputs frame = state.inputs;
        frame.camera = camera;
        return drawn->renderer().drawn_height_m(*terrain, ground, frame);
    }

    /// For scenes as given, not while a user moves the eye.
    void warn_of_eye() { state.warn_of_eye(shape()); }

    void draw(render::Loading loading, render::PassTimes* times = nullptr) {
        context->make_current();
        render::FrameInputs frame = state.inputs;
        frame.loading = loading;
        drawn->render(*terrain, state.ground(), frame, times);
    }

    /// @throws Error (Failed) if count > 0, the number of non-finite pixels
    void check_numbers(int count, const ActiveEffects& shown) {
        if (count > 0)
            report_non_finite({state.scene.effects, shown, *context, renderer_options(), *terrain,
                               state.ground(), state.inputs, count});
    }

    template <typename Read, typename Value>
    auto read(const Read& read_of, Value line) {
        context->make_current();
        int non_finite = 0, others_non_finite = 0;
        auto picture = read_of(drawn->renderer(), &non_finite);
        if (const render::Renderer* const without = drawn->without())
            picture = side_by_side(picture, read_of(*without, &others_non_finite), line);
        check_numbers(non_finite, drawn->effects());
        if (drawn->without()) check_numbers(others_non_finite, drawn->others());
        return picture;
    }
};

Session::Session(scene::Scene scene, Options options, FilesInUse& files)
    : impl_(std::make_unique<Impl>(std::move(scene), std::move(options), files)) {}

Session::~Session() {
    // Device objects are deleted in the session's own context.
    try {
        impl_->context->make_current();
    } catch (const Error& error) {
        log::warning(error.what());
    }
}

const scene::Scene& Session::scene() const {
    return impl_->state.scene;
}

void Session::look(const scene::View& view, std::optional<double> keep_above_m) {
    impl_->state.keep_above_m = keep_above_m;
    impl_->look(view);
}

scene::GroundHeight Session::heights_to_aim_at() const {
    return session::heights_to_aim_at(impl_->state.dem(), impl_->drawn->renderer().displacement());
}

void Session::set_moment(sun::Instant utc) {
    impl_->state.set_time(utc);
    impl_->state.scene.moment.time = sun::exact_iso(utc);
    impl_->state.scene.moment.date.clear();
}

void Session::take(std::shared_ptr<const LoadedDem> dem, const scene::Scene& given) {
    impl_->take(dem, given);
}

sun::Instant Session::moment() const {
    return impl_->state.utc();
}

void Session::set_effects(const scene::Effects& effects) {
    impl_->set_effects(effects);
}

const ActiveEffects& Session::effects() const {
    return impl_->drawn->effects();
}

void Session::set(const std::string& address, const std::string& value) {
    impl_->context->make_current();
    const render::Displacement before = impl_->drawn->renderer().displacement();
    impl_->drawn->set(address, value);
    scene::Effects change;
    change.settings = {{address, value}};
    scene::Effects& effects = impl_->state.scene.effects;
    effects = scene::merge(std::move(effects), change);
    if (impl_->drawn->renderer().displacement() != before) impl_->look(impl_->state.scene.view);
}

void Session::show(const scene::Scene& scene, sun::Instant utc) {
    impl_->show(scene, utc);
}

void Session::resize(int width_px, int height_px) {
    const scene::Scene& now = impl_->state.scene;
    if (width_px == now.width_px && height_px == now.height_px) return;
    impl_->context->make_current();
    impl_->resize(width_px, height_px);
    impl_->look(now.view);
}

void Session::draw(render::PassTimes* times) {
    impl_->draw(render::Loading::Wait, times);
}

void Session::drape(std::shared_ptr<const render::Drape> drape) {
    impl_->set_drape(std::move(drape));
}

std::vector<chart::Legend> Session::colour_legends() const {
    const render::Ground& of = ground();
    return session::colour_legends(
        effects(), {of.lowest_m, of.highest_m, impl_->state.dem()->drawn.water.has_sea_floor});
}

std::vector<chart::Legend> Session::legends() const {
    std::vector<chart::Legend> all = colour_legends();
    if (impl_->overlay)
        all.insert(all.begin(),
                   dated_legend(*impl_->overlay, scene().moment.zone, ground().frame.origin()));
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

void Session::freeze_native(bool freeze) {
    impl_->state.inputs.freeze_native = freeze;
}

bool Session::draw_available() {
    impl_->draw(render::Loading::Background);
    return impl_->terrain->is_complete();
}

bool Session::is_loading() const {
    return impl_->terrain->is_making_pages();
}

void Session::draw_alone() {
    impl_->context->make_current();
    impl_->drawn->renderer().render_frame(*impl_->terrain, ground(), impl_->state.inputs);
    impl_->context->finish();
}

image::Image8 Session::picture() const {
    image::Image8 picture = impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_picture(count); },
        std::uint8_t{255});
    impl_->stamp_notes = add_stamps(*this, legends(), picture);
    return picture;
}

image::ImageF Session::radiance() const {
    return impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_radiance(count); },
        0.0f);
}

const gl::Texture& Session::texture() const {
    return impl_->drawn->renderer().picture();
}

const gl::Texture& Session::depth() const {
    return impl_->drawn->renderer().depth();
}

bool Session::shows_ground() const {
    std::vector<float> depths_m;
    read_depths(depths_m);
    return std::ranges::any_of(depths_m, [](float depth_m) { return std::isfinite(depth_m); });
}

void Session::read_depths(std::vector<float>& depths_m) const {
    impl_->context->make_current();
    impl_->drawn->renderer().read_depths(depths_m);
}

std::vector<render::SunSeen> Session::read_sun_seen() const {
    impl_->context->make_current();
    return impl_->drawn->renderer().read_sun_seen();
}

const render::SunLight& Session::sun_light() const {
    return impl_->state.inputs.sun;
}

const scene::Camera& Session::camera() const {
    return impl_->state.inputs.camera;
}

scene::Outline Session::outline() const {
    return impl_->state.outline(impl_->shape());
}

const std::shared_ptr<const LoadedDem>& Session::dem() const {
    return impl_->state.dem();
}

const render::Ground& Session::ground() const {
    return impl_->state.ground();
}

std::vector<std::string> Session::ground_notes() const {
    std::vector<std::string> notes;
    const LoadedDem::Drawn& drawn = impl_->state.dem()->drawn;
    if (!drawn.holes_text.empty()) notes.push_back(drawn.holes_text);
    for (const std::string& assumption : drawn.water.assumptions)
        notes.push_back(assumption);
    for (std::string& detail :
         impl_->state.synthetic_detail(effects(), impl_->terrain->grid().post_spacing_m()))
        notes.push_back(std::move(detail));
    return notes;
}

std::string Session::place_text() const {
    return impl_->state.place_text();
}

std::string Session::clock_text() const {
    return session::clock_text(moment(), scene().moment.zone, ground().frame.origin());
}

std::string Session::sun_text() const {
    return impl_->state.sun_text();
}

std::string Session::view_reason() const {
    return impl_->state.view_reason();
}

const std::string& Session::moment_reason() const {
    return impl_->state.time_reason();
}

std::string Session::climate_text() const {
    if (!impl_->drawn->renderer().reads_climate()) return {};
    impl_->context->make_current();
    const ClimateReport report =
        climate_report(impl_->terrain->climate_map(), impl_->state.middle(), moment());
    return session::climate_text(report) + "; " + ground_text(report);
}

void Session::link_rest() {
    impl_->drawn->renderer().link_rest();
}

int Session::linked_programs() const {
    return impl_->shared.programs.links();
}

const StageTimes& Session::stages() const {
    return impl_->stages;
}

int Session::triangles() const {
    return impl_->drawn->renderer().triangles();
}

const gl::DeviceInfo& Session::device() const {
    return impl_->context->info();
}

}  // namespace relevo::session

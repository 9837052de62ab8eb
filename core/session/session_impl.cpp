#include "session/session_impl.h"

#include <cmath>
#include <future>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "base/parallel_for.h"
#include "dem/files_of.h"
#include "scene/panorama.h"
#include "session/climate_words.h"
#include "session/land_cover.h"
#include "session/non_finite.h"
#include "session/picture_maker.h"
#include "session/standing.h"
#include "session/stopwatch.h"
#include "session/unseen_effects.h"
#include "session/words.h"
#include "sun/zone_of_place.h"

namespace relevo::session {
namespace {

/// @param source  null: it is opened
std::shared_ptr<const LoadedDem> load(const scene::Scene& scene,
                                      std::shared_ptr<const dem::Source> source,
                                      bool allow_preview) {
    if (!source)
        source = std::make_shared<const dem::Source>(dem::Source::open(scene.dems, scene.dem));
    if (allow_preview)
        if (auto preview = load_preview(source, scene)) return preview;
    return load_dem(std::move(source), scene);
}

}  // namespace

Session::Impl::Impl(scene::Scene given, Options o, FilesInUse& files)
    : options(std::move(o)), state(std::move(given), options.format.has_value()) {
    const scene::Scene& scene = state.scene;
    for (const scene::Layer& layer : scene::layers_of(scene)) {
        dem::add_all(std::span(&layer.raster, 1), files, layer.role);
        if (!layer.table.empty()) files.add_input(layer.table, layer.role_of_table);
    }
    if (scene.overlay) {
        overlay_time = time_of(*scene.overlay);
        laid.without_shadows = overlay_time && !scene.overlay->shadows;
    }
    std::optional<sun::ParsedTime> time;
    const bool timed = !scene.time.at.empty();
    if (timed && !needs_dem(scene.time)) time = parse(scene.time);
    // Deferred to get() if no thread can be created.
    auto loading = std::async(std::launch::async | std::launch::deferred,
                              [this] { return options.dem ? options.dem : load_own(); });
    std::shared_ptr<const LoadedDem> loaded;
    if (!scene.weather.empty() || !scene.forecast.empty()) {  // its clouds need the ground
        loaded = loading.get();
        if (!scene.forecast.empty())
            dem::add_all(std::span(&scene.forecast, 1), files, "the weather");
        state.weather = weather_of(scene, *loaded);
    }
    open_device(files);
    if (!loaded) loaded = loading.get();
    dem::add_all(scene.dems, files);
    // Which effects are on may depend on the DEM.
    drawn->take_ground(loaded->ground_words(scene.holes));
    const bool chooses = scene.chooses_exaggeration;
    state.choose_exaggeration(*loaded);
    const auto began = Clock::now();
    first_dem = loaded;  // which outlives sky_view if an effect does not compile
    compile(*drawn, loaded.get());
    stages.emplace_back("compile", milliseconds_since(began));
    stages.emplace_back("load", options.dem ? 0 : loaded->took_ms);
    if (timed && !time) time = parse_over(scene.time, *loaded->source, loaded->field);
    upload(loaded);
    first_dem.reset();
    look(scene.view);
    warn_of_eye();
    set_time(time ? time->utc : state.default_time());
    if (chooses) choose_exposure();
    if (state.weather) log::info(state.weather->notice(timed, is_seen_from_outside()));
    say_unseen(scene.effects);
}

void Session::Impl::choose_exposure() {
    scene::Scene& scene = state.scene;
    if (scene.exposure_ev != 0 || scene.ev100 || !drawn->renderer().reads_climate()) return;
    const double share =
        snowy_share(terrain->natural().climate_map(), state.dem()->to_frame(), state.utc());
    if (share < 0.5) return;
    scene.exposure_ev = state.inputs.exposure_ev = -std::round(14 * share) / 10;
    log::info(fmt::format("snow and ice: {:g} EV; --exposure sets another", scene.exposure_ev));
}

void Session::Impl::say_unseen(const scene::Effects& asked) const {
    const bool outside = is_seen_from_outside();
    const std::string text = unseen_text(unseen_effects(drawn->effects(), asked, outside), outside);
    if (!text.empty()) log::info(text);
}

bool Session::Impl::is_seen_from_outside() const {
    return state.is_map() || render::is_outside(state.ground(), state.inputs);
}

std::shared_ptr<const LoadedDem> Session::Impl::load_own() const {
    const bool timed = !state.scene.time.at.empty();
    return load(state.scene, options.source,
                options.allow_preview && !(timed && needs_dem(state.scene.time)));
}

void Session::Impl::open_device(FilesInUse& files) {
    const auto began = Clock::now();
    drawn = DrawnEffects::load(request(state.scene.effects), /*report=*/true);
    drawn->effects().add_inputs(files);
    take_effects();
    context.emplace(options.context ? options.context()
                                    : gl::Context(gl::ContextOptions{.device = options.device}));
    drawn->fit(context->info());
    stages.emplace_back("device", milliseconds_since(began));
}

EffectsRequest Session::Impl::request(const scene::Effects& effects) const {
    EffectsRequest request{.effects = effects, .compared = options.compared};
    request.allow_unmet = options.allow_unmet;
    // By the scene alone, so that each picture can be made again with the same bytes.
    request.constants = options.format && effects.settings.empty();
    request.mapped = !state.scene.land_cover.file.empty();
    request.houses = state.scene.land_cover.surface;
    request.effects.weather = state.weather ? state.weather->facts : weather::Facts{};
    if (state.dem()) request.ground = state.dem()->ground_words(state.scene.holes);
    request.overlay_raster = has_overlay_raster();
    request.hides_shadows = has_overlay_raster() && laid.without_shadows;
    return request;
}

void Session::Impl::take_effects() {
    state.scene.effects = drawn->request().effects;
    state.scene.effects.settings = effect::with_absolute_files(
        std::move(state.scene.effects.settings), drawn->effects().values);
}

render::RendererOptions Session::Impl::renderer_options() {
    const RendererNeeds needs =
        options.format ? needs_of(state.scene, *options.format) : RendererNeeds{};
    const glm::ivec2 frame = frame_px();
    return {.width_px = frame.x,
            .height_px = frame.y,
            .antialias = needs.antialias,
            .radiance = options.radiance,
            .deep = needs.deep,
            .orthographic = needs.orthographic,
            .data = needs.data,
            .albedo = needs.albedo,
            .overlay_raster = has_overlay_raster(),
            .outside = !state.scene.view.eye,
            .audited = options.audited,
            .shared = &shared};
}

void Session::Impl::compile(DrawnEffects& effects, const LoadedDem* first_dem) {
    const auto options_of = [&] {
        render::RendererOptions with_texts = renderer_options();
        with_texts.stitched = [this, first_dem](const render::StitchedFrames& frames) {
            if (options.stitched) options.stitched(frames);
            if (first_dem) compute_sky(*first_dem, frames.programs);
        };
        return with_texts;
    };
    effects.compile(*context, options_of, drawn->marks());
}

void Session::Impl::compute_sky(const LoadedDem& dem,
                                const std::vector<render::ProgramText>& texts) {
    const auto reads_sky = [](const render::ProgramText& text) {
        return std::ranges::any_of(text.stitched.textures,
                                   [](const auto& unit) { return unit.resource == "light_sky"; });
    };
    if (!sky_view.valid() && thread_count() > 1 && std::ranges::any_of(texts, reads_sky))
        sky_view = render::compute_sky_view_async(dem.to_draw(), state.scene.exaggeration);
}

void Session::Impl::switch_to(const EffectsRequest& wanted) {
    if (drawn->take(wanted)) return;
    const EffectRasters before = rasters;
    const EffectFields fields_before = fields;
    try {
        switch_effects(wanted);
    } catch (...) {
        rasters = before;
        terrain->set_rasters(rasters.named());
        fields = fields_before;
        lay_fields();
        throw;
    }
}

void Session::Impl::switch_effects(const EffectsRequest& wanted) {
    if (std::optional<DrawnEffects> known = recent.take(wanted)) {
        lay_rasters(*known);
        known->resize(frame_px().x, frame_px().y);
        recent.keep(std::exchange(*drawn, std::move(*known)));
        return;
    }
    DrawnEffects fresh = DrawnEffects::load(wanted, /*report=*/false);
    fresh.fit(context->info());
    lay_rasters(fresh);
    compile(fresh);
    // Drivers may reject a program at its first draw. Modules, and files of lines, which are read
    // for the grid, fail at their first frame.
    if (fresh.is_watched() || fresh.has_modules() || fresh.has_lines())
        fresh.render(*terrain, state.ground(), state.inputs);
    recent.keep(std::exchange(*drawn, std::move(fresh)));
    shared.targets.trim();  // sets of targets differ between effects
}

void Session::Impl::lay_rasters(const DrawnEffects& of) {
    rasters = EffectRasters(of.effects(), terrain->grid(), rasters);
    terrain->set_rasters(rasters.named());
    fields = EffectFields(of.effects(), terrain->grid(), fields);
    lay_fields();
}

void Session::Impl::lay_fields() {
    terrain->set_fields(fields.named(state.weather ? state.weather->fields : WeatherFields{}));
}

void Session::Impl::set_time(sun::Instant utc) {
    state.set_time(utc);
    lay_fields();
}

void Session::Impl::resize(int width_px, int height_px) {
    state.scene.width_px = width_px;
    state.scene.height_px = height_px;
    drawn->resize(frame_px().x, frame_px().y);
}

void Session::Impl::show(const scene::Scene& next, sun::Instant utc, const Hints& hints) {
    context->make_current();
    // First what may fail, so that the scene is still the one before.
    const bool other_cover = next.land_cover != state.scene.land_cover;
    const std::shared_ptr<const overlay::Photo> cover =
        other_cover ? open_land_cover(next.land_cover, state.dem()->source->grid()) : land_cover;
    if (next.land_cover.surface) check_houses(*state.dem());
    const bool other_air = show_weather(next) || next.refraction != state.scene.refraction;
    const bool other_effects = show_effects(next, hints);
    state.inputs.deterministic = hints.exact;
    state.keep_above_m = hints.keep_above_m;
    const scene::Scene before = std::exchange(state.scene, next);
    scene::Scene& scene = state.scene;
    scene.dems = before.dems;
    scene.dem = before.dem;
    scene.holes = before.holes;
    scene.overlay = before.overlay;
    scene.effects = before.effects;
    scene.time = before.time;
    scene.view = before.view;
    resize(next.width_px, next.height_px);
    part.reset();
    const bool other_ground = other_cover || next.pixel_error != before.pixel_error;
    if (other_ground) {
        land_cover = cover;
        upload(state.dem());
    } else {
        state.take_shape(next.exaggeration != before.exaggeration);
    }
    if (other_air || other_ground || utc != state.utc()) set_time(utc);
    scene.time = next.time;
    look(next.view);
    if (hints.exact)
        warn_of_eye();
    else if (other_effects)
        say_unseen(next.effects);
}

bool Session::Impl::show_weather(const scene::Scene& next) {
    scene::Scene& now = state.scene;
    if (next.weather == now.weather && next.forecast == now.forecast &&
        next.station_height_m == now.station_height_m)
        return false;
    state.weather = weather_of(next, *state.dem());
    now.weather = next.weather;
    now.forecast = next.forecast;
    now.station_height_m = next.station_height_m;
    return true;
}

bool Session::Impl::show_effects(const scene::Scene& next, const Hints& hints) {
    LaidOverlay other = hints.overlay.value_or(laid);
    lay(other);
    EffectsRequest wanted = request(next.effects);
    wanted.mapped = !next.land_cover.file.empty();
    wanted.houses = next.land_cover.surface;
    if (!hints.reload_effects && wanted == drawn->request()) return false;
    const bool other_effects = hints.reload_effects || !wanted.has_selection_of(drawn->request());
    try {
        switch_to(wanted);
    } catch (...) {
        lay(other);
        throw;
    }
    take_effects();
    return other_effects;
}

void Session::Impl::lay(LaidOverlay& other) {
    if (other == laid) return;
    std::swap(laid, other);
    terrain->set_overlay(laid.raster);
}

void Session::Impl::upload(const std::shared_ptr<const LoadedDem>& dem) {
    const auto began = Clock::now();
    if (state.dem() != dem) {
        rasters = {};
        fields = {};
        if (!state.dem() || state.dem()->source != dem->source)
            land_cover = open_land_cover(state.scene.land_cover, dem->source->grid());
        houses = nullptr;
    }
    if (!state.scene.land_cover.surface)
        houses = nullptr;
    else if (!houses)
        houses = houses_on(*dem);
    terrain.reset();  // refers to the previous DEM
    state.take_dem(dem);
    terrain.emplace(dem->to_draw(), state.ground().frame,
                    render::TerrainOptions{
                        .pixel_error = state.scene.pixel_error,
                        .max_array_layers = context->info().max_array_layers,
                        .memory = state.scene.dem.memory,
                        .pyramid = dem->pyramid ? &*dem->pyramid : nullptr,
                        .water = &dem->drawn.water,
                        .filled = dem->drawn.is_filled.empty() ? nullptr : &dem->drawn.is_filled,
                        .land_cover = land_cover,
                        .houses = houses,
                        .climate_alone = state.scene.land_cover.climate_alone,
                        .sky = std::exchange(sky_view, {}),
                        .shadows_on = context->info().device.software ? render::ShadowsOn::Processor
                                                                      : render::ShadowsOn::Device},
                    dem->source.get());
    if (state.scene.overlay) {
        overlay = read_overlay(*state.scene.overlay, terrain->grid());
        laid.raster = overlay->raster;
    }
    terrain->set_overlay(laid.raster);
    lay_rasters(*drawn);
    stages.emplace_back("upload", milliseconds_since(began));
    state.take_shape(/*other=*/true);
}

void Session::Impl::take(const std::shared_ptr<const LoadedDem>& dem, const scene::Scene& given) {
    context->make_current();
    upload(dem);
    state.weather = weather_of(state.scene, *dem);
    look(given.view);
    set_time(given.time.at.empty() ? state.default_time() : state.utc());
    const scene::Effects effects = drawn->request().effects;
    const EffectsRequest wanted = request(effects);
    if (wanted.ground != drawn->request().ground ||
        wanted.effects.weather != drawn->request().effects.weather) {
        switch_to(wanted);
        take_effects();
        look(state.scene.view);  // displacement may move the ground under the eye
    }
}

void Session::Impl::look(const scene::View& view) {
    check_eye_height(view, state.dem()->field.about.path);
    if (!options.format || view.panorama == scene::Panorama::None)
        return state.look(view, shape(/*around=*/false));
    // Levels of detail, and the height of the ground below the eye, depend on the size of pixels.
    scene::View as_fine = view;
    as_fine.fov_y_rad = scene::perspective_fov_y_rad(
        view, static_cast<double>(state.scene.width_px) / state.scene.height_px);
    state.look(as_fine, shape(/*around=*/true));
    state.scene.view.take_lens_of(view);
}

DrawnShape Session::Impl::shape() {
    return shape(options.format && state.scene.view.panorama != scene::Panorama::None);
}

DrawnShape Session::Impl::shape(bool around) {
    const bool has_air = std::ranges::any_of(drawn->effects().loaded.selection.snippets(),
                                             [](const shader::Snippet* const snippet) {
                                                 return snippet->find("atmosphere") != nullptr;
                                             });
    return {drawn->renderer().displacement(), drawn->renderer().shows_block(), has_air,
            [this, around](const scene::Camera& camera) { return drawn_height_m(camera, around); }};
}

std::optional<double> Session::Impl::drawn_height_m(const scene::Camera& camera, bool around) {
    const render::Ground& ground = state.ground();
    const auto [lowest_m, highest_m] =
        drawn->renderer().displacement().range_m(ground.lowest_m, ground.highest_m);
    const double eye_m = ground.frame.to_geodetic(camera.eye_m).height_m;
    if (eye_m > highest_m * state.scene.exaggeration + scene::kClearance_m) return std::nullopt;
    context->make_current();
    render::FrameInputs frame = state.inputs;
    frame.camera = camera;
    frame.part = render::PicturePart{.picture_px = {state.scene.width_px, state.scene.height_px},
                                     .corner_px = {0, 0},
                                     .of_panorama = around};
    return drawn->renderer().drawn_height_m(*terrain, ground, frame);
}

void Session::Impl::draw(render::Loading loading, render::PassTimes* times) {
    context->make_current();
    render::FrameInputs frame = state.inputs;
    frame.loading = loading;
    frame.part = part;
    drawn->render(*terrain, state.ground(), frame, times);
}

std::vector<Marks> Session::Impl::marks(const std::vector<LoadedMarks>& loaded,
                                        const ActiveEffects& effects,
                                        const render::Renderer& renderer) {
    std::vector<Marks> result;
    for (const LoadedMarks& list : loaded) {
        std::shared_ptr<const MarkPlaces> places = list.places;
        if (const auto set = renderer.module_marks(list.plugin, list.spec->name))
            places = marks_on_ground.places(set);
        if (list.spec->summits) places = marks_on_ground.summits(state.dem());
        if (!places || places->places.empty()) continue;
        result.push_back(marks_of(
            list,
            marks_on_ground.of(places, state.dem(), state.ground().frame, state.scene.exaggeration),
            effects.values, renderer.displacement(), state.scene));
    }
    return result;
}

glm::ivec2 Session::Impl::frame_px() const {
    if (!options.format) return {state.scene.width_px, state.scene.height_px};
    return session::frame_px(state.scene, *options.format, context->info().max_picture_size);
}

bool Session::Impl::has_marks() const {
    const auto any = [](const std::vector<LoadedMarks>& lists) {
        return std::ranges::any_of(
            lists, [](const LoadedMarks& list) { return list.places || list.spec->from.empty(); });
    };
    return any(drawn->marks()) || any(drawn->other_marks());
}

std::vector<chart::Drawing> Session::Impl::mark_drawings(const glm::ivec2& size_px,
                                                         std::span<const chart::Rect> taken,
                                                         const std::vector<float>* given_m) {
    const double width = size_px.x, height = size_px.y;
    std::vector<chart::Drawing> drawings;
    const auto draw = [&](const std::vector<Marks>& lists, const render::Renderer& renderer,
                          const chart::Rect& within) {
        if (lists.empty()) return;
        std::vector<float> depths_m;
        if (!given_m) renderer.read_depths(depths_m);
        draw_marks(
            lists,
            view_of(state.inputs.camera, size_px.x, size_px.y, given_m ? *given_m : depths_m),
            within, taken, drawings.emplace_back(width, height));
    };
    const render::Renderer* const without = drawn->without();
    const double half = without ? std::floor((width - kDivider_px) / 2) : width;
    draw(marks(drawn->marks(), drawn->effects(), drawn->renderer()), drawn->renderer(),
         {0, 0, half, height});
    if (without)
        draw(marks(drawn->other_marks(), drawn->others(), *without), *without,
             {half + kDivider_px, 0, width - half - kDivider_px, height});
    return drawings;
}

void Session::Impl::draw_marks_on(image::Image8& picture, std::span<const chart::Rect> taken,
                                  const std::vector<float>* given_m) {
    for (const chart::Drawing& drawing :
         mark_drawings({picture.width, picture.height}, taken, given_m))
        chart::paint(drawing, 0, 0, 1, picture);
}

FaultyPicture Session::Impl::faulty(const ActiveEffects& shown, int count) {
    return {state.scene.effects, shown,        *context, renderer_options(), *terrain,
            state.ground(),      state.inputs, count};
}

void Session::Impl::check_numbers(int count, const ActiveEffects& shown) {
    if (count > 0) report_non_finite(faulty(shown, count));
}

}  // namespace relevo::session

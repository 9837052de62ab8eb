#include "session/scene_times.h"

#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/log.h"
#include "dem/posts.h"
#include "render/ground.h"
#include "scene/default_time.h"
#include "scene/framing.h"
#include "scene/map_view.h"
#include "scene/stereo.h"
#include "session/overlay.h"
#include "session/standing.h"
#include "session/words.h"
#include "sun/event_time.h"

namespace relevo::session {

namespace {

/// Exaggerations of a DEM, and angles of each, whose default views are kept.
constexpr std::size_t kMostShown = 1000;

/// The part of a scene that dem_key() depends on.
scene::Scene dem_of_scene(const scene::Scene& scene) {
    scene::Scene only;
    only.dems = scene.dems;
    only.dem = scene.dem;
    only.holes = scene.holes;
    only.overlay = scene.overlay;
    return only;
}

}  // namespace

std::string dem_key(const scene::Scene& scene) {
    return scene::whole_scene_line(dem_of_scene(scene));
}

/// What default view angles depend on.
struct SceneTimes::Shown {
    scene::GroundNet net;
    scene::AerialGround aerial;
    scene::DefaultDay day;
    /// Framed views by what is given (aerial, azimuth, elevation). Framing takes milliseconds, and
    /// many pictures of a job share it.
    using Given = std::tuple<bool, std::optional<double>, std::optional<double>>;
    std::map<Given, scene::Orbit> framed{};
};

struct SceneTimes::Dem {
    std::shared_ptr<const dem::Source> source;
    std::shared_ptr<const LoadedDem> loaded;
    std::optional<dem::Posts> posts;  ///< of `loaded`
    /// Zones at the DEM's centre, by the requested names.
    std::map<std::string, std::string> zones;
    std::optional<Shown> shown;

    const dem::Source& open() const { return *source; }
};

SceneTimes::SceneTimes() = default;
SceneTimes::~SceneTimes() = default;

void SceneTimes::before_reading(std::function<void(const scene::Scene&)> call) {
    before_reading_ = std::move(call);
}

void SceneTimes::use(const scene::Scene& scene, std::shared_ptr<const LoadedDem> dem) {
    auto known = std::make_unique<Dem>();
    known->source = dem->source;
    known->loaded = std::move(dem);
    dems_[key_of(scene)] = std::move(known);
}

scene::Scene SceneTimes::with_absolute_paths(scene::Scene scene) {
    std::vector<std::string> given = std::exchange(scene.dems, {});
    scene = scene::with_absolute_paths(std::move(scene));
    const auto [known, fresh] = absolute_.try_emplace(std::move(given));
    if (fresh) {
        scene::Scene only;
        only.dems = known->first;
        known->second = scene::with_absolute_paths(std::move(only)).dems;
    }
    scene.dems = known->second;
    return scene;
}

std::string SceneTimes::key_of(const scene::Scene& scene) {
    return scene::whole_scene_line(with_absolute_paths(dem_of_scene(scene)));
}

SceneTimes::Dem& SceneTimes::dem_of(const scene::Scene& scene) {
    std::unique_ptr<Dem>& dem = dems_[key_of(scene)];
    if (!dem) {
        auto opened = std::make_unique<Dem>();
        opened->source =
            std::make_shared<const dem::Source>(dem::Source::open(scene.dems, scene.dem));
        dem = std::move(opened);
    }
    return *dem;
}

std::shared_ptr<const dem::Source> SceneTimes::source(const scene::Scene& scene) {
    return dem_of(scene).source;
}

std::shared_ptr<const LoadedDem> SceneTimes::loaded(const scene::Scene& scene) {
    Dem& dem = dem_of(scene);
    if (dem.loaded) return dem.loaded;
    // Jobs process their DEMs one after the other; only small results of earlier ones are kept.
    for (auto& [key, other] : dems_) {
        other->posts.reset();
        other->loaded.reset();
    }
    if (before_reading_) before_reading_(with_absolute_paths(scene));
    dem.loaded = load_dem(dem.source, scene);
    if (!scene.view.eye) shown_of(scene);
    return dem.loaded;
}

SceneTimes::Shown& SceneTimes::shown_of(const scene::Scene& scene) {
    const auto heights = loaded(scene);
    std::optional<Shown>& shown = dem_of(scene).shown;
    if (shown) return *shown;
    const render::Ground ground = ground_of(*heights);
    render::GroundToShow to_show = render::ground_to_show(heights->field, ground, 1);
    shown.emplace(Shown{std::move(to_show.net), std::move(to_show.true_aerial),
                        scene::DefaultDay(ground.frame.origin(), ground.block_m <= 0)});
    return *shown;
}

scene::View SceneTimes::settled_view(const scene::Scene& scene) {
    scene::View view = scene.view;
    if (scene.ortho) return view;  // which has none
    if (view.eye || (view.orbit.azimuth_deg && view.orbit.elevation_deg)) return view;
    Dem& dem = dem_of(scene);
    Shown& shown = dem.shown ? *dem.shown : shown_of(scene);
    if (shown.framed.size() >= kMostShown) shown.framed.clear();
    const auto [framed, fresh] = shown.framed.try_emplace(
        {view.orbit.aerial, view.orbit.azimuth_deg, view.orbit.elevation_deg});
    if (fresh)
        framed->second = scene::frame_ground(view.orbit, shown.net, shown.aerial, shown.day).orbit;
    view.orbit.aerial = framed->second.aerial;
    view.orbit.azimuth_deg = framed->second.azimuth_deg;
    view.orbit.elevation_deg = framed->second.elevation_deg;
    return view;
}

/// Default time of a scene.
sun::Instant SceneTimes::default_time(const scene::Scene& scene) {
    if (const std::optional<sun::Instant> of_overlay = instant_of_overlay(scene))
        return *of_overlay;
    const auto heights = loaded(scene);
    const render::Ground ground = ground_of(*heights);
    const scene::DefaultDay day(ground.frame.origin(), ground.block_m <= 0);
    if (scene.ortho) return day.time(scene::kMapSide_deg).utc;
    const render::GroundToShow to_show =
        render::ground_to_show(heights->field, ground, scene.exaggeration);
    const scene::Camera camera = scene::make_camera(
        settled_view(scene), [&](const geo::Geodetic& at) { return heights->height_m(at); },
        ground.frame, {to_show.points, {}, to_show.aerial},
        static_cast<double>(scene.width_px) / scene.height_px, scene.exaggeration);
    return day.time(scene::side_of_deg(camera)).utc;
}

void SceneTimes::fit_map(scene::Scene& scene) {
    if (scene.ortho || scene.resolution > 0) scene::fit_map(scene, dem_of(scene).open().grid());
}

scene::MotionGround SceneTimes::motion_ground(const scene::Scene& scene) {
    const auto heights = loaded(scene);
    const render::Ground ground = ground_of(*heights);
    const render::GroundToShow to_show =
        render::ground_to_show(heights->field, ground, scene.exaggeration);
    // Seas lie at level 0, whatever their bottom.
    render::Displacement seas;
    seas.to_m = {0};
    scene::MotionGround result{.height_m = heights_to_aim_at(heights, seas),
                               .frame = ground.frame,
                               .exaggeration = scene.exaggeration,
                               .points = to_show.points,
                               .aspect = scene::view_aspect(scene)};
    const auto base = render::block_below(to_show.rim, ground, scene.exaggeration);
    result.points.insert(result.points.end(), base.begin(), base.end());
    result.camera = [this, scene, height_m = result.height_m, frame = ground.frame,
                     outline = scene::Outline{to_show.points, {}, to_show.aerial},
                     aspect = result.aspect](const scene::View& view) {
        scene::Scene seen = scene;
        seen.view = view;
        return scene::make_camera(settled_view(seen), height_m, frame, outline, aspect,
                                  scene.exaggeration);
    };
    return result;
}

void SceneTimes::keep_only(const scene::Scene& scene) {
    std::erase_if(dems_, [key = key_of(scene)](const auto& dem) { return dem.first != key; });
}

/// Time zone at the DEM's centre, by a name that needs no map of zones.
std::string SceneTimes::zone_of_middle(const std::string& words, Dem& dem) {
    const auto [known, fresh] = dem.zones.try_emplace(words);
    if (!fresh) return known->second;
    const sun::ChosenZone chosen = sun::choose_zone(words, dem.open().grid().center());
    const std::string notice = chosen.assumption + "; --tz sets another";
    if (notice != std::exchange(logged_, notice) && !chosen.assumption.empty())
        chosen.missing ? log::warning(notice) : log::info(notice);
    // Mean solar time is not in the zone database.
    if (sun::is_solar_zone(words))
        known->second = words;
    else
        known->second = chosen.missing ? "" : chosen.zone.name();
    return known->second;
}

sun::ParsedTime SceneTimes::of(const scene::Scene& scene) {
    Dem& dem = dem_of(scene);
    scene::TimeSpec spec = scene.time;
    const bool event = sun::is_event_time(spec.at);
    const bool of_middle = !event || spec.at.find('@') == std::string::npos;
    if (sun::is_zone_by_place(spec.zone) && of_middle) spec.zone = zone_of_middle(spec.zone, dem);
    if (spec.at.empty()) {
        sun::ParsedTime morning;
        const geo::Geodetic middle = dem.open().grid().center();
        morning.utc = default_time(scene);
        morning.zone = sun::choose_zone(spec.zone, middle).zone;
        return morning;
    }
    sun::ParsedTime time = parse_quietly(
        spec, {.middle = [&] { return dem.open().grid().center(); },
               .posts = [&]() -> const dem::Posts& {
                   const auto heights = loaded(scene);
                   if (dem.posts) return *dem.posts;
                   if (heights->field.reduction == 1)
                       dem.posts.emplace(heights->field);
                   else
                       dem.posts.emplace(*heights->source,
                                         static_cast<std::int64_t>(heights->field.height_m.size()));
                   return *dem.posts;
               }});
    if (!time.note.empty()) log::info(time.note);
    return time;
}

}  // namespace relevo::session

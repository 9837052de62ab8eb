#include "session/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "session/climate_words.h"
#include "session/colour_legends.h"
#include "session/non_finite.h"
#include "session/picture_maker.h"
#include "session/session_impl.h"
#include "session/stamps.h"
#include "session/standing.h"
#include "session/words.h"
#include "sun/daylight.h"

namespace relevo::session {

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

scene::GroundHeight Session::heights_to_aim_at() const {
    return session::heights_to_aim_at(impl_->state.dem(), impl_->drawn->renderer().displacement());
}

void Session::take(std::shared_ptr<const LoadedDem> dem, const scene::Scene& given) {
    impl_->take(dem, given);
}

sun::Instant Session::time() const {
    return impl_->state.utc();
}

const ActiveEffects& Session::effects() const {
    return impl_->drawn->effects();
}

void Session::show(scene::Scene scene, sun::Instant utc, const Hints& hints) {
    impl_->show(scene, utc, hints);
}

void Session::draw(render::PassTimes* times) {
    impl_->draw(render::Loading::Wait, times);
}

std::vector<chart::Legend> Session::colour_legends() const {
    const render::Ground& of = ground();
    std::vector<chart::Legend> all = session::colour_legends(
        effects(), {of.lowest_m, of.highest_m, impl_->state.dem()->drawn.water.has_sea_floor});
    const std::vector<chart::Legend> of_rasters =
        impl_->rasters.legends(scene().time.zone, of.frame.origin());
    all.insert(all.end(), of_rasters.begin(), of_rasters.end());
    return all;
}

std::vector<chart::Legend> Session::legends() const {
    std::vector<chart::Legend> all = colour_legends();
    if (const std::optional<chart::Legend> legend = overlay_legend())
        all.insert(all.begin(), *legend);
    return all;
}

std::optional<chart::Legend> Session::overlay_legend() const {
    if (!impl_->overlay) return std::nullopt;
    return dated_legend(*impl_->overlay, scene().time.zone, ground().frame.origin());
}

const std::vector<std::string>& Session::compared() const {
    return impl_->options.compared;
}

const std::optional<OverlayTime>& Session::overlay_time() const {
    return impl_->overlay_time;
}

render::NonFinite Session::non_finite() const {
    impl_->context->make_current();
    return impl_->drawn->renderer().non_finite();
}

std::optional<NonFiniteCause> Session::non_finite_cause(const std::string& id) const {
    impl_->context->make_current();
    return find_cause(impl_->faulty(impl_->drawn->effects(), non_finite().count), id);
}

const std::vector<std::string>& Session::stamp_notes() const {
    return impl_->stamp_notes;
}

bool Session::is_animated() const {
    const render::Renderer* const without = impl_->drawn->without();
    return impl_->drawn->renderer().is_animated() || (without && without->is_animated());
}

bool Session::draw_available(bool freezes_native) {
    impl_->state.inputs.freeze_native = freezes_native;
    impl_->draw(render::Loading::Background);
    impl_->state.inputs.freeze_native = false;
    return impl_->terrain->is_complete();
}

bool Session::is_loading() const {
    return impl_->terrain->is_making_pages();
}

void Session::draw_alone(render::PassTimes* times) {
    impl_->context->make_current();
    impl_->drawn->renderer().render_frame(*impl_->terrain, ground(), impl_->state.inputs, times);
    impl_->context->finish();
}

image::Image8 Session::picture() const {
    image::Image8 picture = impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_output(count); },
        std::uint8_t{255});
    std::vector<chart::Rect> taken;
    impl_->stamp_notes = add_stamps(*this, legends(), picture, taken);
    impl_->draw_marks_on(picture, taken);
    return picture;
}

image::Picture Session::make_picture(render::PassTimes* times) {
    return impl_->make_picture(*this, times);
}

void Session::make_bands(const std::function<void(const image::Picture&)>& take) {
    impl_->make_bands(take, scene().stamps.legend && !legends().empty());
}

const std::optional<PictureFormat>& Session::format() const {
    return impl_->options.format;
}

std::vector<Marks> Session::marks() const {
    const DrawnEffects& drawn = *impl_->drawn;
    return impl_->marks(drawn.marks(), drawn.effects(), drawn.renderer());
}

image::ImageF Session::radiance() const {
    return impl_->read(
        [](const render::Renderer& renderer, int* count) { return renderer.read_radiance(count); },
        0.0f);
}

const gl::Texture& Session::texture() const {
    return impl_->drawn->renderer().output();
}

const gl::Texture& Session::depth() const {
    return impl_->drawn->renderer().depth();
}

glm::ivec2 Session::map_corner_px() const {
    return impl_->map_corner_px;
}

std::shared_ptr<const chart::PaperSheet> Session::paper_sheet() const {
    return impl_->paper_sheet;
}

bool Session::shows_ground() const {
    if (impl_->picture_shows_ground) return *impl_->picture_shows_ground;
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
    return impl_->state.inputs.direct_light();
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
    if (drawn.has_houses && !scene().land_cover.surface)
        notes.emplace_back(
            "houses seem to be in the heights; --surface draws them and their streets");
    for (std::string& detail :
         impl_->state.synthetic_detail(effects(), impl_->terrain->grid().post_spacing_m()))
        notes.push_back(std::move(detail));
    return notes;
}

std::string Session::place_text() const {
    return impl_->state.place_text();
}

std::string Session::clock_text() const {
    return session::clock_text(time(), scene().time.zone, ground().frame.origin());
}

std::string Session::sun_text() const {
    return impl_->state.sun_text();
}

sun::Refraction Session::refraction(const geo::Geodetic& place) const {
    return impl_->state.refraction(place);
}

const SceneWeather* Session::weather() const {
    return impl_->state.weather ? &*impl_->state.weather : nullptr;
}

std::string Session::view_reason() const {
    return impl_->state.view_reason();
}

const std::string& Session::time_reason() const {
    return impl_->state.time_reason();
}

std::string Session::climate_text() const {
    if (!impl_->drawn->renderer().reads_climate()) return {};
    impl_->context->make_current();
    const ClimateReport report =
        climate_report(impl_->terrain->natural().climate_map(), impl_->state.middle(), time());
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

double Session::ev100() const {
    return sun::ev100_of_exposure(impl_->drawn->renderer().exposure());
}

int Session::triangles() const {
    return impl_->drawn->renderer().triangles();
}

const gl::DeviceInfo& Session::device() const {
    return impl_->context->info();
}

}  // namespace relevo::session

#include "session/drawn_effects.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"

namespace relevo::session {

bool EffectsRequest::has_selection_of(const EffectsRequest& other) const {
    return effects.switches == other.effects.switches && effects.presets == other.effects.presets &&
           effects.plugin_path == other.effects.plugin_path &&
           effects.weather == other.effects.weather && compared == other.compared &&
           constants == other.constants && mapped == other.mapped && houses == other.houses &&
           ground == other.ground && overlay_raster == other.overlay_raster &&
           hides_shadows == other.hides_shadows;
}

DrawnEffects DrawnEffects::load(EffectsRequest request, bool report) {
    DrawnEffects drawn;
    drawn.request_ = std::move(request);
    const EffectsRequest& asked = drawn.request_;
    const bool compared = !asked.compared.empty();
    drawn.effects_ =
        ActiveEffects::of(compared ? with(asked.effects, asked.compared) : asked.effects,
                          /*report=*/true, asked.ground);
    const std::vector<std::string>& refused = drawn.effects_->loaded.selection.refused;
    if (!asked.allow_unmet && !refused.empty()) bad_input(refused.front());
    if (asked.hides_shadows)
        for (const std::string& id : drawn.effects_->switch_off_unasked("shadow"))
            if (report)
                log::info(fmt::format(
                    "{} is off: the overlay shows sunlight of its own time; --overlay-shadows "
                    "switches it on",
                    id));
    if (compared)
        drawn.others_ =
            ActiveEffects::of(session::without(asked.effects, asked.compared, *drawn.effects_),
                              /*report=*/false, asked.ground);
    for (const Half& half : drawn.halves()) {
        half.effects.constants = asked.constants;
        half.effects.mapped = asked.mapped;
        half.effects.houses = asked.houses;
    }
    drawn.stamp_files();
    return drawn;
}

void DrawnEffects::stamp_files() {
    for (const Half& half : halves())
        for (const std::filesystem::path& path : half.effects.files_and_folders())
            files_.add(path);
}

std::vector<DrawnEffects::Half> DrawnEffects::halves() const {
    std::vector<Half> halves = {{*effects_, renderer_.get(), true}};
    if (others_) halves.push_back({*others_, without_.get(), false});
    return halves;
}

void DrawnEffects::take_ground(const effect::GroundWords& words) {
    request_.ground = words;
    for (const Half& half : halves())
        half.effects.take_ground(words, request_.effects, half.report);
}

void DrawnEffects::fit(const gl::DeviceInfo& device) {
    for (const Half& half : halves())
        half.effects.fit(device, half.report);
}

void DrawnEffects::compile(gl::Context& context, const OptionsOf& options,
                           const std::vector<LoadedMarks>& earlier) {
    marks_ = load_marks(effects_->loaded.selection, effects_->values, earlier, /*report=*/true);
    renderer_ = std::make_unique<render::Renderer>(context, effects_->inputs(), options());
    if (!others_) return;
    other_marks_ = load_marks(others_->loaded.selection, others_->values, marks_, /*report=*/false);
    render::RendererOptions of_others = options();
    of_others.stitched = {};
    without_ = std::make_unique<render::Renderer>(context, others_->inputs(), of_others);
}

bool DrawnEffects::take(const EffectsRequest& request) {
    if (!request_.has_selection_of(request) || !files_.hold()) return false;
    std::vector<shader::ParamStore> values;
    for (const Half& half : halves()) {
        auto changed = half.effects.values_with(request.effects.settings, half.report);
        if (!changed) return false;
        values.push_back(std::move(*changed));
    }
    std::size_t i = 0;
    for (const Half& half : halves()) {
        half.effects.values = std::move(values[i++]);
        half.renderer->set_values(half.effects.values);
    }
    request_ = request;
    return true;
}

void DrawnEffects::resize(int width_px, int height_px) {
    for (const Half& half : halves())
        half.renderer->resize(width_px, height_px);
}

void DrawnEffects::render(render::Terrain& terrain, const render::Ground& ground,
                          const render::FrameInputs& inputs, render::PassTimes* times) {
    renderer_->render_frame(terrain, ground, inputs, times);
    if (without_) without_->render_frame(terrain, ground, inputs);
}

bool DrawnEffects::has_modules() const {
    return std::ranges::any_of(
        halves(), [](const Half& half) { return !half.effects.loaded.modules.empty(); });
}

bool DrawnEffects::has_lines() const {
    return std::ranges::any_of(halves(), [](const Half& half) {
        return std::ranges::any_of(
            half.effects.loaded.selection.effects,
            [](const effect::Effect* effect) { return !effect->manifest.lines.empty(); });
    });
}

bool DrawnEffects::is_watched() const {
    return renderer_->is_watched() || (without_ && without_->is_watched());
}

void DrawnEffects::release_targets() {
    for (const Half& half : halves())
        half.renderer->release_targets();
}

std::optional<DrawnEffects> RecentEffects::take(const EffectsRequest& request) {
    for (auto kept = kept_.begin(); kept != kept_.end(); ++kept) {
        if (!kept->take(request)) continue;
        std::optional<DrawnEffects> found = std::move(*kept);
        kept_.erase(kept);
        return found;
    }
    return std::nullopt;
}

void RecentEffects::keep(DrawnEffects drawn) {
    // A module that is written again cannot be loaded while its former library is, and keeps
    // textures of its own.
    if (drawn.has_modules()) return;
    drawn.release_targets();
    kept_.push_front(std::move(drawn));
    if (kept_.size() > kMost) kept_.pop_back();
}

}  // namespace relevo::session

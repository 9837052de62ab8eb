#include "viewer/point_query.h"

#include <cmath>
#include <utility>

#include "viewer/window.h"

namespace relevo::viewer {

PointQuery::PointQuery(State& state) : state_(state), work_(&Window::wake) {}

bool PointQuery::choose(const glm::dvec3& point_m) {
    geo::Geodetic place = state_.land.frame->to_geodetic(point_m);
    place.height_m = state_.land.height_m(place);
    if (std::isnan(place.height_m)) return false;
    state_.chosen = place;
    requested_.reset();
    return true;
}

void PointQuery::clear() {
    work_.forget();
    state_.chosen.reset();
    state_.point.reset();
}

void PointQuery::update(const Opened& opened, double px_a_unit) {
    if (!state_.chosen || opened.dem->is_preview) return;
    const bool is_requested = requested_ && requested_->date == state_.day.date &&
                              requested_->zone.name() == state_.document.zone.name() &&
                              requested_->chart_px == state_.chart_px &&
                              requested_->px_a_unit == px_a_unit;
    if (is_requested) return;
    PointWanted wanted;
    wanted.dem = opened.dem;
    wanted.dems = opened.scene.dems;
    wanted.options = opened.scene.dem;
    wanted.refraction = opened.scene.refraction;
    wanted.place = *state_.chosen;
    wanted.date = state_.day.date;
    wanted.zone = state_.document.zone;
    wanted.chart_px = state_.chart_px;
    wanted.px_a_unit = px_a_unit;
    requested_ = wanted;
    work_.want(std::move(wanted));
}

bool PointQuery::poll() {
    const std::shared_ptr<const PointLight> answer = work_.answer();
    state_.point_in_work = !work_.is_done();
    if (answer == state_.point) return false;
    // An answer for another date stays until there is a new one.
    state_.point = answer;
    return true;
}

}  // namespace relevo::viewer

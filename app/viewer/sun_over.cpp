#include "viewer/sun_over.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "light/point/alignment.h"
#include "light/point/direct_light.h"
#include "light/point/refraction_at.h"
#include "sun/position.h"
#include "viewer/overlay.h"
#include "viewer/sun_model.h"
#include "viewer/translation.h"
#include "viewer/window.h"

namespace relevo::viewer {

namespace {

SunOverAnswer moonrise(const SunOverQuestion& question, const light::TerrainHorizon& horizon,
                       sun::Date first, sun::Date last) {
    const double night_rad = radians(-6);
    light::LightOptions options{.body = sun::Body::Moon};
    options.refraction = light::refraction_at(question.scene.refraction, horizon.place());
    const light::DirectLight moon(horizon, options);
    const auto counts = [&](const light::LitInterval& lit) {
        return !lit.begin.midnight && lit.begin.utc > question.after &&
               sun::position(lit.begin.utc, horizon.place()).elevation_rad < night_rad;
    };
    for (sun::Date date = first; date <= last; date = sun::add_days(date, 1))
        for (const light::LightDay& day : moon.days(date, date, question.zone))  // none: skipped
            if (const auto lit = std::ranges::find_if(day.lit, counts); lit != day.lit.end())
                return {lit->begin.utc,
                        tr_format("the moon rises on {} at {}, in the {}", day_label(date),
                                  clock_label(lit->begin.utc, question.zone),
                                  compass_text(degrees(lit->begin.azimuth_rad))),
                        /*looks_to_moon=*/true};
    return {{}, tr("within a year the moon does not rise here by night")};
}

}  // namespace

SunOverAnswer sun_over(const SunOverQuestion& question) {
    const dem::Heightfield& field = question.dem->field;
    const dem::Posts posts = field.reduction == 1
                                 ? dem::Posts(field)
                                 : dem::Posts::load(question.scene.dems, question.scene.dem);
    const light::TerrainHorizon horizon(posts, question.eye,
                                        {.eye_height_m = question.eye.height_m,
                                         .eye_above_ground = false,
                                         .few_directions = question.target.has_value()});
    const sun::Date first = question.zone.local(question.after).wall.date;
    const sun::Date last = std::min(sun::add_days(first, 366), sun::Date{sun::kLastYear, 12, 31});
    if (!question.target) return moonrise(question, horizon, first, last);
    const bool is_moon = question.body == sun::Body::Moon;
    light::AlignmentOptions options{.body = question.body};
    options.refraction = light::refraction_at(question.scene.refraction, horizon.place());
    const light::Alignments found =
        light::alignments(horizon, *question.target, first, last, question.zone, options);
    if (!found.sight.visible) return {{}, tr("ground hides that point from here")};
    const auto next = std::ranges::find_if(found.passages, [&](const light::Alignment& passage) {
        return passage.sun_visible && passage.utc > question.after;
    });
    if (next == found.passages.end())
        return {{},
                is_moon ? tr("within a year the moon does not stand over that point, seen from "
                             "here")
                        : tr("within a year the sun does not stand over that point, seen from "
                             "here")};
    const double right_deg = degrees(next->right_rad);
    return {next->utc, tr_format("{} stands over the point, {:.2f}° {} and {:.2f}° {} it",
                                 is_moon ? tr("the moon") : tr("the sun"), std::abs(right_deg),
                                 right_deg < 0 ? tr("to the left") : tr("to the right"),
                                 std::abs(degrees(next->above_rad)),
                                 next->above_rad < 0 ? tr("below") : tr("above"))};
}

bool SunOver::ask(SunOverQuestion question) {
    if (answer_.valid()) return false;
    dem_ = question.dem;
    answer_ = std::async(std::launch::async, [question = std::move(question)] {
        SunOverAnswer answer = sun_over(question);
        Window::wake();
        return answer;
    });
    return true;
}

std::optional<SunOverAnswer> SunOver::poll(const std::shared_ptr<const session::LoadedDem>& open) {
    using namespace std::chrono_literals;
    if (!answer_.valid() || answer_.wait_for(0s) != std::future_status::ready) return std::nullopt;
    const auto asked = std::exchange(dem_, nullptr);
    const SunOverAnswer answer = answer_.get();
    return asked == open ? std::optional(answer) : std::nullopt;
}

}  // namespace relevo::viewer

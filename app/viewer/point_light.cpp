#include "viewer/point_light.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "chart/carpet_chart.h"
#include "light/point/carpet.h"
#include "light/point/direct_light.h"
#include "light/point/doubt.h"
#include "light/point/horizon.h"
#include "light/point/refraction_at.h"
#include "session/words.h"

namespace relevo::viewer {
namespace {

/// Of a drawn horizon; time step of a year [s].
constexpr int kDirections = 3600;
constexpr int kLightStep_s = 240;

bool same_place(const geo::Geodetic& a, const geo::Geodetic& b) {
    return a.lat_rad == b.lat_rad && a.lon_rad == b.lon_rad;
}

bool same_ground(const PointWanted& a, const PointWanted& b) {
    return a.dem == b.dem && a.refraction == b.refraction;
}

bool same_point(const PointWanted& a, const PointWanted& b) {
    return same_ground(a, b) && same_place(a.place, b.place);
}

/// The same options as `relevo sun`.
light::LightOptions light_options(const PointWanted& wanted, const geo::Geodetic& place) {
    light::LightOptions options;
    options.refraction = light::refraction_at(wanted.refraction, place);
    if (wanted.refraction != scene::Scene{}.refraction)
        options.flat.rule = sun::RiseRule::seen(sun::Limb::Upper, *options.refraction, 0);
    return options;
}

void add_dark_days(const light::Carpet& carpet, YearPicture& to) {
    const auto count = static_cast<int>(carpet.days.size());
    const auto day = [&](int i) -> const light::LightDay& {
        return carpet.days[static_cast<std::size_t>(i % count)];
    };
    int row = 0;
    // Twice, so that runs continue past the end of the year.
    for (int i = 0; i < 2 * count; ++i) {
        row = day(i).lit_s == 0 ? std::min(row + 1, count) : 0;
        if (i < count) to.dark_days += row > 0;
        if (row <= to.dark_row) continue;
        to.dark_row = row;
        to.dark = {day(i + 1 - row + count).date, day(i).date};
    }
}

}  // namespace

/// Computes a point's light and caches intermediate results for the next day, size or year.
class PointWork::Worker {
  public:
    explicit Worker(const PointWanted& wanted, const Worker* before) : wanted_(wanted) {
        if (before && before->wanted_.dem == wanted.dem) posts_ = before->posts_;
        if (!posts_)
            posts_ = std::make_shared<const dem::Posts>(
                wanted.dem->field.reduction == 1 ? dem::Posts(wanted.dem->field)
                                                 : dem::Posts::load(wanted.dems, wanted.options));
    }

    bool serves(const PointWanted& other) const { return same_point(wanted_, other); }
    void want(const PointWanted& other) { wanted_ = other; }

    void add_day(PointLight& to) {
        const light::DirectLight& direct = light();
        const bool is_new = !day_ || day_->date != wanted_.date || day_zone_ != wanted_.zone.name();
        if (is_new) {
            day_ = direct.day(wanted_.date, wanted_.zone);
            day_zone_ = wanted_.zone.name();
        }
        for (const light::LitInterval& interval : day_->lit)
            to.lit.push_back({{interval.begin.utc, interval.end.utc},
                              interval.begin.midnight,
                              interval.end.midnight,
                              ridge_at(interval.begin.azimuth_rad),
                              ridge_at(interval.end.azimuth_rad)});
        to.lit_s = day_->lit_s;
        to.not_known_s = day_->not_known_s;
        to.flat_s = day_->flat.day_length_s;
        add_tomorrow(to, is_new);
        for (const light::OpenSector& open :
             light::doubt_of(direct, {*day_}, profile(), std::nullopt).open)
            to.open_deg.emplace_back(degrees(open.from_azimuth_rad), degrees(open.to_azimuth_rad));
    }

    void add_tomorrow(PointLight& to, bool is_new) {
        const sun::Date date = sun::add_days(wanted_.date, 1);
        to.tomorrow_is_known = date.year <= sun::kLastYear;
        if (!to.tomorrow_is_known) return;
        if (is_new || !tomorrow_) tomorrow_ = light().day(date, wanted_.zone);
        if (!tomorrow_->lit.empty()) to.tomorrow = tomorrow_->lit.front().begin.utc;
    }

    std::shared_ptr<const HorizonPicture> horizon_picture() {
        chart::HorizonPanorama panorama;
        panorama.horizon = &*horizon_;
        panorama.profile = &profile();
        panorama.year = wanted_.date.year;
        panorama.zone = wanted_.zone;
        panorama.refraction = light().refraction();
        panorama.day = day_;
        panorama.names = names();
        panorama.panel = panel();
        auto picture = std::make_shared<HorizonPicture>();
        picture->picture = chart::to_image(panorama.draw(&picture->axes), wanted_.px_a_unit);
        return picture;
    }

    std::shared_ptr<const YearPicture> year_picture() {
        if (!carpet_ || carpet_->year != wanted_.date.year ||
            carpet_->zone.name() != wanted_.zone.name())
            carpet_ = light::carpet(light(), wanted_.date.year, wanted_.zone, kLightStep_s);
        chart::CarpetChart chart;
        chart.carpet = &*carpet_;
        chart.place = horizon_->place();
        chart.panel = panel();
        auto picture = std::make_shared<YearPicture>();
        picture->picture = chart::to_image(chart.draw(), wanted_.px_a_unit);
        picture->plot = chart.plot();
        picture->days = carpet_->days;
        picture->lit_s = carpet_->lit_s;
        picture->level_s = carpet_->level_s;
        add_dark_days(*carpet_, *picture);
        return picture;
    }

  private:
    const light::DirectLight& light() {
        if (!horizon_) horizon_.emplace(*posts_, wanted_.place);
        if (!light_) light_.emplace(*horizon_, light_options(wanted_, horizon_->place()));
        return *light_;
    }
    Ridge ridge_at(double azimuth_rad) const {
        const light::HorizonPoint at = horizon_->at(azimuth_rad);
        return {degrees(azimuth_rad), degrees(at.elevation_rad), at.distance_m};
    }
    const std::vector<light::HorizonPoint>& profile() {
        if (profile_.empty()) profile_ = horizon_->profile(kDirections);
        return profile_;
    }
    const std::vector<chart::SkylineName>& names() {
        if (!names_) {
            names_.emplace();
            try {
                names_ = chart::names_on_skyline(*horizon_);
            } catch (const Error& error) {  // the light is the same without names
                static std::once_flag once;
                std::call_once(once, [&] { log::warning(error.what()); });
            }
        }
        return *names_;
    }
    chart::PanelSize panel() const {
        return {wanted_.chart_px.x / wanted_.px_a_unit, wanted_.chart_px.y / wanted_.px_a_unit};
    }

    PointWanted wanted_;
    std::shared_ptr<const dem::Posts> posts_;
    std::optional<light::TerrainHorizon> horizon_;  // from posts_
    std::optional<light::DirectLight> light_;       // from horizon_
    std::vector<light::HorizonPoint> profile_;
    std::optional<std::vector<chart::SkylineName>> names_;
    std::optional<light::LightDay> day_, tomorrow_;
    std::string day_zone_;
    std::optional<light::Carpet> carpet_;
};

bool PointLight::is_lit(sun::Instant utc) const {
    return std::ranges::any_of(
        lit, [&](const LitSpan& span) { return span.begin <= utc && utc < span.end; });
}

std::optional<sun::Instant> PointLight::next_change(sun::Instant utc) const {
    for (const LitSpan& span : lit) {
        if (utc < span.begin && !span.from_midnight) return span.begin;
        if (utc < span.end && !span.to_midnight) return span.end;
    }
    return std::nullopt;
}

PointWork::PointWork(std::function<void()> on_change)
    : LatestWork(std::move(on_change), &same_point) {}

PointWork::~PointWork() {
    end();
}

void PointWork::work_out(const PointWanted* wanted) {
    if (!wanted) return worker_.reset();  // also frees the posts of a DEM that may be closed
    PointLight light;
    light.of = *wanted;
    const auto publish_it = [&](bool done) {
        publish(std::make_shared<const PointLight>(light), done);
    };
    try {
        if (worker_ && worker_->serves(*wanted))
            worker_->want(*wanted);
        else
            worker_ = std::make_unique<Worker>(*wanted, worker_.get());
        if (is_given_up()) return;
        const bool drawn = wanted->chart_px.x > 0 && wanted->chart_px.y > 0;
        worker_->add_day(light);
        publish_it(!drawn);
        if (!drawn || is_given_up()) return;
        light.horizon = worker_->horizon_picture();
        publish_it(false);
        if (is_given_up()) return;
        light.year = worker_->year_picture();
        publish_it(true);
    } catch (const std::exception& error) {
        light.error = error.what();
        publish_it(true);
    }
}

}  // namespace relevo::viewer

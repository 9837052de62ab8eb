#include "viewer/point_light.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "base/units.h"
#include "chart/carpet_chart.h"
#include "light/carpet.h"
#include "light/direct_light.h"
#include "light/doubt.h"
#include "light/horizon.h"
#include "session/words.h"

namespace relevo::viewer {
namespace {

/// Of a horizon that is drawn, and of a year.
constexpr int kDirections = 3600;
constexpr int kStep_s = 240;

bool same_place(const geo::Geodetic& a, const geo::Geodetic& b) {
    return a.lat_rad == b.lat_rad && a.lon_rad == b.lon_rad;
}

bool same_ground(const PointWanted& a, const PointWanted& b) {
    return a.dem == b.dem && a.refraction == b.refraction;
}

/// As the options of `relevo sun` have it.
light::LightOptions light_options(const PointWanted& wanted, const geo::Geodetic& place) {
    light::LightOptions options;
    options.refraction = session::refraction_at(wanted.refraction, place);
    if (wanted.refraction != scene::Scene{}.refraction)
        options.flat.rule = sun::RiseRule::seen(sun::Limb::Upper, *options.refraction, 0);
    return options;
}

/// A point's light, and what it was made from: kept for the next day, size or year.
class Worker {
  public:
    explicit Worker(const PointWanted& wanted, const Worker* before) : wanted_(wanted) {
        if (before && before->wanted_.dem == wanted.dem) posts_ = before->posts_;
        if (!posts_)
            posts_ = std::make_shared<const dem::Posts>(
                wanted.dem->field.reduction == 1 ? dem::Posts(wanted.dem->field)
                                                 : dem::Posts::load(wanted.dems, wanted.options));
    }

    bool serves(const PointWanted& other) const {
        return same_ground(wanted_, other) && same_place(wanted_.place, other.place);
    }
    void want(const PointWanted& other) { wanted_ = other; }

    void add_day(PointLight& to) {
        const light::DirectLight& direct = light();
        if (!day_ || day_->date != wanted_.date || day_zone_ != wanted_.zone.name()) {
            day_ = direct.day(wanted_.date, wanted_.zone);
            day_zone_ = wanted_.zone.name();
        }
        for (const light::LitInterval& interval : day_->lit)
            to.lit.push_back({{interval.begin.utc, interval.end.utc},
                              interval.begin.midnight,
                              interval.end.midnight});
        to.lit_s = day_->lit_s;
        to.not_known_s = day_->not_known_s;
        to.flat_s = day_->flat.day_length_s;
        for (const light::OpenSector& open :
             light::doubt_of(direct, {*day_}, profile(), std::nullopt).open)
            to.open_deg.emplace_back(degrees(open.from_azimuth_rad), degrees(open.to_azimuth_rad));
    }

    std::shared_ptr<const HorizonPicture> horizon_picture() {
        chart::HorizonPanorama panorama;
        panorama.horizon = &*horizon_;
        panorama.profile = &profile();
        panorama.year = wanted_.date.year;
        panorama.zone = wanted_.zone;
        panorama.refraction = light().refraction();
        panorama.day = day_;
        panorama.panel = panel();
        auto picture = std::make_shared<HorizonPicture>();
        picture->picture = chart::to_image(panorama.draw(&picture->axes), wanted_.px_a_unit);
        return picture;
    }

    std::shared_ptr<const YearPicture> year_picture() {
        if (!carpet_ || carpet_->year != wanted_.date.year ||
            carpet_->zone.name() != wanted_.zone.name())
            carpet_ = light::carpet(light(), wanted_.date.year, wanted_.zone, kStep_s);
        chart::CarpetChart chart;
        chart.carpet = &*carpet_;
        chart.place = horizon_->place();
        chart.panel = panel();
        auto picture = std::make_shared<YearPicture>();
        picture->picture = chart::to_image(chart.draw(), wanted_.px_a_unit);
        picture->plot = chart.plot();
        picture->lit_s = carpet_->lit_s;
        picture->level_s = carpet_->level_s;
        return picture;
    }

  private:
    const light::DirectLight& light() {
        if (!horizon_) horizon_.emplace(*posts_, wanted_.place);
        if (!light_) light_.emplace(*horizon_, light_options(wanted_, horizon_->place()));
        return *light_;
    }
    const std::vector<light::HorizonPoint>& profile() {
        if (profile_.empty()) profile_ = horizon_->profile(kDirections);
        return profile_;
    }
    chart::PanelSize panel() const {
        return {wanted_.chart_px.x / wanted_.px_a_unit, wanted_.chart_px.y / wanted_.px_a_unit};
    }

    PointWanted wanted_;
    std::shared_ptr<const dem::Posts> posts_;
    std::optional<light::TerrainHorizon> horizon_;  // of posts_
    std::optional<light::DirectLight> light_;       // of horizon_
    std::vector<light::HorizonPoint> profile_;
    std::optional<light::LightDay> day_;
    std::string day_zone_;
    std::optional<light::Carpet> carpet_;
};

}  // namespace

bool PointLight::is_lit(sun::Instant utc) const {
    return std::any_of(lit.begin(), lit.end(),
                       [&](const LitSpan& span) { return span.begin <= utc && utc < span.end; });
}

std::optional<sun::Instant> PointLight::next_change(sun::Instant utc) const {
    for (const LitSpan& span : lit) {
        if (utc < span.begin && !span.from_midnight) return span.begin;
        if (utc < span.end && !span.to_midnight) return span.end;
    }
    return std::nullopt;
}

struct PointWork::Impl {
    std::function<void()> on_change;

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::optional<PointWanted> wanted;
    bool is_new = false, ends = false, is_done = true;
    std::shared_ptr<const PointLight> answer;

    std::unique_ptr<Worker> worker;  // the thread's own
    std::thread thread;

    void run() {
        std::unique_lock lock(mutex);
        while (true) {
            changed.wait(lock, [&] { return ends || is_new; });
            if (ends) return;
            is_new = false;
            const std::optional<PointWanted> now = wanted;
            lock.unlock();
            if (now)
                work_out(*now);
            else
                worker.reset();  // and with it the posts of a DEM that may be gone
            lock.lock();
        }
    }

    bool is_given_up() const {
        const std::lock_guard lock(mutex);
        return is_new || ends;
    }

    void publish(const PointLight& light, bool done) {
        {
            const std::lock_guard lock(mutex);
            if (is_new || ends) return;
            answer = std::make_shared<const PointLight>(light);
            is_done = done;
        }
        on_change();
    }

    void work_out(const PointWanted& now) {
        PointLight light;
        light.of = now;
        try {
            if (worker && worker->serves(now))
                worker->want(now);
            else
                worker = std::make_unique<Worker>(now, worker.get());
            if (is_given_up()) return;
            const bool drawn = now.chart_px.x > 0 && now.chart_px.y > 0;
            worker->add_day(light);
            publish(light, !drawn);
            if (!drawn || is_given_up()) return;
            light.horizon = worker->horizon_picture();
            publish(light, false);
            if (is_given_up()) return;
            light.year = worker->year_picture();
            publish(light, true);
        } catch (const std::exception& error) {
            light.error = error.what();
            publish(light, true);
        }
    }
};

PointWork::PointWork(std::function<void()> on_change) : impl_(std::make_unique<Impl>()) {
    impl_->on_change = std::move(on_change);
    impl_->thread = std::thread([this] { impl_->run(); });
}

PointWork::~PointWork() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->ends = true;
    }
    impl_->changed.notify_one();
    impl_->thread.join();
}

void PointWork::want(PointWanted wanted) {
    {
        const std::lock_guard lock(impl_->mutex);
        const bool other = !impl_->wanted || !same_ground(*impl_->wanted, wanted) ||
                           !same_place(impl_->wanted->place, wanted.place);
        if (other) impl_->answer = nullptr;
        impl_->wanted = std::move(wanted);
        impl_->is_new = true;
        impl_->is_done = false;
    }
    impl_->changed.notify_one();
}

void PointWork::forget() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->wanted.reset();
        impl_->answer = nullptr;
        impl_->is_new = true;
        impl_->is_done = true;
    }
    impl_->changed.notify_one();
}

std::shared_ptr<const PointLight> PointWork::answer() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->answer;
}

bool PointWork::is_done() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->is_done;
}

}  // namespace relevo::viewer

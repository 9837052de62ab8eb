#include "viewer/point_light.h"

#include <algorithm>
#include <exception>

#include "light/direct_light.h"
#include "light/horizon.h"

namespace relevo::viewer {
namespace {

PointLight work_out(const geo::Geodetic& place, sun::Date date, const sun::Zone& zone,
                    const scene::Scene& scene, const dem::Heightfield& loaded) {
    PointLight result;
    result.place = place;
    result.date = date;
    try {
        const dem::Posts posts =
            loaded.reduction == 1 ? dem::Posts(loaded) : dem::Posts::load(scene.dems, scene.dem);
        const light::TerrainHorizon horizon(posts, place, {});
        const light::LightDay day = light::DirectLight(horizon).day(date, zone);
        for (const light::LitInterval& interval : day.lit)
            result.lit.push_back({interval.begin.utc, interval.end.utc});
        result.lit_s = day.lit_s;
        result.flat_s = day.flat.day_length_s;
    } catch (const std::exception& error) {
        result.error = error.what();
    }
    return result;
}

}  // namespace

bool PointLight::is_lit(sun::Instant utc) const {
    return std::any_of(lit.begin(), lit.end(), [&](const sun::TimeSpan& span) {
        return span.begin <= utc && utc < span.end;
    });
}

std::optional<sun::Instant> PointLight::next_change(sun::Instant utc) const {
    for (const sun::TimeSpan& span : lit) {
        if (utc < span.begin) return span.begin;
        if (utc < span.end) return span.end;
    }
    return std::nullopt;
}

std::future<PointLight> light_at(const geo::Geodetic& place, sun::Date date, const sun::Zone& zone,
                                 const scene::Scene& scene, const dem::Heightfield& loaded) {
    return std::async(std::launch::async, [place, date, zone, scene, &loaded] {
        return work_out(place, date, zone, scene, loaded);
    });
}

}  // namespace relevo::viewer

#include "session/marks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "base/units.h"
#include "names/summit_top.h"

namespace relevo::session {
namespace {

constexpr std::size_t kMostKept = 16;

/// Ranks of places, those without one last.
std::vector<double> ranks_of(const std::vector<dem::NamedPlace>& places, const std::string& who,
                             const std::string& path) {
    std::vector<double> ranks;
    ranks.reserve(places.size());
    for (const dem::NamedPlace& place : places) {
        const std::optional<double> rank = parse_number(place.rank);
        if (!place.rank.empty() && !rank)
            bad_input(fmt::format("{}: {}: line {}: rank, expected a number but got \"{}\"", who,
                                  path, place.line, printable(place.rank)));
        ranks.push_back(rank.value_or(std::numeric_limits<double>::infinity()));
    }
    return ranks;
}

std::shared_ptr<const MarkPlaces> read_places(const std::string& path, const std::string& who) {
    auto result = std::make_shared<MarkPlaces>();
    result->path = path;
    std::vector<dem::NamedPlace> places = dem::read_points(path, who);
    const std::vector<double> ranks = ranks_of(places, who, path);
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return ranks[i]; });
    result->read.add(path);
    result->places.reserve(places.size());
    for (const std::size_t i : order) {
        result->places.push_back(std::move(places[i]));
        std::string& name = result->places.back().name;
        name = printable(name);
    }
    return result;
}

/// Height of the ground [m]; NaN without ground.
/// @param exact  from the posts of the file
double ground_m(const LoadedDem& dem, const geo::Geodetic& at, bool exact) {
    const glm::dvec2 post = dem.field.grid.post(at);
    if (std::isnan(post.x) || std::isnan(post.y)) return std::nan("");
    const double drawn_m = dem.to_draw().height_at(post.x, post.y);
    if (!exact || dem.field.reduction == 1 || dem.is_preview) return drawn_m;
    const double height_m = dem.height_m(at);
    return std::isnan(height_m) ? drawn_m : height_m;
}

/// Height of the ground at place `i` [m]; NaN without ground, and 0 where it does not matter.
double ground_m(const MarkPlaces& of, std::size_t i, const LoadedDem& dem) {
    const geo::PlaceText& at = of.places[i].at;
    if (at.has_height && !at.above_ground) return 0;
    if (!of.looks.empty() && of.looks[i].known_ground_m)
        return static_cast<double>(*of.looks[i].known_ground_m);
    return ground_m(dem, at.place, i < kMostFromFile);
}

glm::vec3 along(const geo::Geodetic& at, double azimuth_rad, const geo::LocalFrame& frame) {
    const geo::Axes axes = frame.axes(at.lat_rad, at.lon_rad);
    return std::sin(azimuth_rad) * axes.east + std::cos(azimuth_rad) * axes.north;
}

StandingMarks::Mark standing_at(const geo::PlaceText& at, double ground_m,
                                const geo::LocalFrame& frame, double exaggeration) {
    const bool absolute = at.has_height && !at.above_ground;
    const double above_m = at.above_ground ? at.place.height_m : 0;
    const double height_m = absolute ? at.place.height_m : ground_m + above_m;
    geo::Geodetic place = at.place;
    place.height_m = height_m * exaggeration;
    return {.at_m = frame.to_local(place),
            .up = frame.up(place.lat_rad, place.lon_rad),
            .height_m = static_cast<float>(height_m),
            .on_ground = !at.has_height};
}

chart::Color color_of(const shader::ParamValue& value, double opacity) {
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(std::lround(255 * std::clamp(value[i], 0.0, 1.0)));
    };
    return {byte(0) << 16 | byte(1) << 8 | byte(2), opacity};
}

}  // namespace

std::shared_ptr<const MarkPlaces> places_of(const effect::ModuleMarks& marks) {
    std::vector<const effect::ModuleMark*> ranked;
    ranked.reserve(marks.size());
    for (const effect::ModuleMark& mark : marks)
        ranked.push_back(&mark);
    std::ranges::stable_sort(ranked, {}, &effect::ModuleMark::rank);
    auto result = std::make_shared<MarkPlaces>();
    result->places.reserve(marks.size());
    result->looks.reserve(marks.size());
    for (const effect::ModuleMark* const mark : ranked) {
        const bool is_above = mark->height_of == RELEVO_ABOVE_GROUND;
        const bool is_known = mark->height_of == RELEVO_ON_KNOWN_GROUND;
        dem::NamedPlace place{.name = printable(mark->text)};
        place.at = {geo::geodetic_deg(mark->lat_deg, mark->lon_deg, is_known ? 0 : mark->height_m),
                    is_above || mark->height_of == RELEVO_ABOVE_ZERO, is_above};
        result->places.push_back(std::move(place));
        MarkLook look;
        if (mark->symbol != RELEVO_SYMBOL_OF_LIST)
            look.symbol = static_cast<chart::Symbol>(mark->symbol - RELEVO_SYMBOL_NONE);
        if (mark->azimuth_deg) look.azimuth_rad = radians(*mark->azimuth_deg);
        if (is_known) look.known_ground_m = static_cast<float>(mark->height_m);
        result->looks.push_back(look);
    }
    return result;
}

std::vector<LoadedMarks> load_marks(const effect::Selection& selection,
                                    const shader::ParamStore& values,
                                    const std::vector<LoadedMarks>& earlier, bool report) {
    const auto places_of = [&](const std::string& path, const std::string& who) {
        for (const LoadedMarks& list : earlier)
            if (list.places && list.places->path == path && list.places->read.hold())
                return list.places;
        return read_places(path, who);
    };
    std::vector<LoadedMarks> result;
    for (const effect::Effect* effect : selection.effects)
        for (const effect::MarksSpec& spec : effect->manifest.marks) {
            if (spec.summits) names::Gazetteer::summits();  // reports a damaged list now
            if (spec.from.empty()) {
                result.push_back({&spec, effect->id(), nullptr});
                continue;
            }
            const std::string path = values.text(spec.from);
            if (path.empty() && report) log::info(effect::no_file_text(spec.from));
            result.push_back(
                {&spec, effect->id(), path.empty() ? nullptr : places_of(path, spec.from)});
        }
    return result;
}

std::shared_ptr<const StandingMarks> stand(std::shared_ptr<const MarkPlaces> places,
                                           const LoadedDem& dem, const geo::LocalFrame& frame,
                                           double exaggeration) {
    auto result = std::make_shared<StandingMarks>();
    const std::vector<dem::NamedPlace>& all = places->places;
    std::vector<StandingMarks::Mark> marks(all.size());
    parallel_for(0, static_cast<int>(all.size()), 1024, [&](int first, int end) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(end); ++i) {
            const geo::PlaceText& at = all[i].at;
            marks[i] = standing_at(at, ground_m(*places, i, dem), frame, exaggeration);
            marks[i].index = static_cast<std::uint32_t>(i);
            if (places->looks.empty()) continue;
            marks[i].on_crests = !places->looks[i].known_ground_m;
            if (places->looks[i].azimuth_rad)
                marks[i].along = along(at.place, *places->looks[i].azimuth_rad, frame);
        }
    });
    std::erase_if(marks, [](const StandingMarks::Mark& mark) { return std::isnan(mark.height_m); });
    if (marks.empty() && !places->path.empty())
        log::info(
            fmt::format("marks: {}: none of its places is on the DEM", printable(places->path)));
    result->marks = std::move(marks);
    result->places = std::move(places);
    return result;
}

std::shared_ptr<const MarkPlaces> MarksOnGround::places(
    const std::shared_ptr<const effect::ModuleMarks>& marks) {
    const auto known =
        std::ranges::find(places_, marks, [](const auto& entry) { return entry.first; });
    if (known != places_.end()) return known->second;
    if (places_.size() >= kMostKept) places_.erase(places_.begin());
    places_.emplace_back(marks, places_of(*marks));
    return places_.back().second;
}

std::shared_ptr<const MarkPlaces> MarksOnGround::summits(
    const std::shared_ptr<const LoadedDem>& dem) {
    if (summits_.first == dem) return summits_.second;
    const dem::Heightfield& field = dem->to_draw();
    std::vector<std::pair<double, dem::NamedPlace>> found;
    for (const names::Summit& summit : names::summits_on(
             names::Gazetteer::summits(), field.grid,
             [&](int column, int row) { return field.height_at(column, row); },
             names::around(field.grid))) {
        const double height_m = ground_m(*dem, summit.place, false);
        if (!std::isnan(height_m))
            found.push_back(
                {-height_m,
                 {.name = std::string(summit.entry->name), .at = {.place = summit.place}}});
    }
    if (found.empty()) log::info("summits: none of those that come with Relevo is on the DEM");
    std::ranges::stable_sort(found, {}, [](const auto& one) { return one.first; });
    auto places = std::make_shared<MarkPlaces>();
    for (auto& [height_m, place] : found)
        places->places.push_back(std::move(place));
    summits_ = {dem, std::move(places)};
    return summits_.second;
}

std::shared_ptr<const StandingMarks> MarksOnGround::of(
    const std::shared_ptr<const MarkPlaces>& places, const std::shared_ptr<const LoadedDem>& dem,
    const geo::LocalFrame& frame, double exaggeration) {
    for (auto known = known_.begin(); known != known_.end(); ++known)
        if (known->standing->places == places && known->dem == dem &&
            known->exaggeration == exaggeration) {
            std::rotate(known, known + 1, known_.end());  // the last is the most recent
            return known_.back().standing;
        }
    if (known_.size() >= kMostKept) known_.erase(known_.begin());
    known_.push_back({dem, exaggeration, stand(places, *dem, frame, exaggeration)});
    return known_.back().standing;
}

Marks marks_of(const LoadedMarks& loaded, std::shared_ptr<const StandingMarks> standing,
               const shader::ParamStore& values, const render::Displacement& displacement,
               const scene::Scene& scene) {
    constexpr double kHaloOpacity = 0.85;
    const effect::MarksSpec& spec = *loaded.spec;
    const auto number = [&](const effect::MarkValue& value) { return value.of(values)[0]; };
    // On paper a pixel of a parameter is a 96th of an inch, as it is on screens.
    const double px = scene.sheet.is_on() ? scene.sheet.dpi / 96 : 1;
    return {.standing = std::move(standing),
            .style = {.size = px * number(spec.size_px),
                      .color = color_of(spec.colour.of(values), 1),
                      .halo = color_of(spec.halo.of(values), kHaloOpacity),
                      .symbol = static_cast<chart::Symbol>(number(spec.symbol)),
                      .leader = px * number(spec.leader_px),
                      .distance = px * number(spec.distance_px),
                      .repeat = px * number(spec.repeat_px),
                      .most = static_cast<std::size_t>(number(spec.most))},
            .order = static_cast<effect::MarksSpec::Order>(number(spec.order)),
            .above_m = number(spec.above_m),
            .displacement = displacement,
            .exaggeration = scene.exaggeration,
            .pixel_error = scene.pixel_error};
}

}  // namespace relevo::session

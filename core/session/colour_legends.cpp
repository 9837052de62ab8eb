#include "session/colour_legends.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace relevo::session {
namespace {

using shader::ColourRamp;

bool is_shown(const ColourRamp& ramp, const shader::ParamStore& values) {
    if (ramp.where.empty()) return true;
    const std::vector<std::string>& words = values.param(ramp.where).words;
    return words.at(static_cast<std::size_t>(values.value(ramp.where)[0])) == ramp.where_word;
}

double value_of(const ColourRamp::End& end, const shader::ParamStore& values,
                const DemRange& ground) {
    switch (end.of) {
        case ColourRamp::End::Of::Number:
            return end.number;
        case ColourRamp::End::Of::Param:
            return values.value(end.address)[0];
        case ColourRamp::End::Of::Lowest:
        case ColourRamp::End::Of::Floor:
            return ground.lowest_m;
        case ColourRamp::End::Of::Highest:
            return ground.highest_m;
    }
    return 0;
}

/// Values of the first and the last colour; nullopt if the DEM has none of them.
std::optional<std::pair<double, double>> ends_of(const ColourRamp& ramp,
                                                 const shader::ParamStore& values,
                                                 const DemRange& ground) {
    if (ramp.is_ring) return std::pair(0.0, 360.0);
    double from = value_of(ramp.from, values, ground), to = value_of(ramp.to, values, ground);
    using Of = ColourRamp::End::Of;
    // Parameters without a range select the range of land.
    if (ramp.from.of == Of::Param && ramp.to.of == Of::Param && !(from < to)) {
        from = std::max(ground.lowest_m, std::min(ground.highest_m, 0.0));
        to = std::max(ground.highest_m, from + 1e-3);
    }
    if (ramp.to.of == Of::Floor && !ground.has_sea_floor) return std::nullopt;
    if ((ramp.to.of == Of::Lowest || ramp.to.of == Of::Floor) && !(to < from)) return std::nullopt;
    if (ramp.to.of == Of::Highest && !(to > from)) return std::nullopt;
    return std::pair(from, to);
}

chart::Color colour_of(const std::array<double, 3>& srgb) {
    chart::Color color;
    for (const double part : srgb)
        color.rgb = color.rgb << 8 | static_cast<std::uint32_t>(std::lround(255 * part));
    return color;
}

/// Stops in ascending order of values, even for a descending ramp.
std::vector<chart::Ramp::Stop> stops_of(const ColourRamp& ramp, double from, double to) {
    std::vector<chart::Ramp::Stop> stops;
    const auto count = static_cast<double>(ramp.colours.size() - (ramp.is_ring ? 0 : 1));
    for (std::size_t k = 0; k < ramp.colours.size(); ++k)
        stops.push_back(
            {from + (to - from) * static_cast<double>(k) / count, colour_of(ramp.colours[k])});
    if (ramp.is_ring) stops.push_back({to, stops.front().color});
    if (to < from) std::ranges::reverse(stops);
    return stops;
}

/// Joins the stops of two ramps of one legend. Where they meet, the colour changes abruptly.
void join(std::vector<chart::Ramp::Stop> more, chart::Ramp& ramp) {
    const bool below = more.front().value < ramp.stops.front().value;
    std::vector<chart::Ramp::Stop>&low = below ? more : ramp.stops,
    &high = below ? ramp.stops : more;
    if (low.back().value >= high.front().value)
        low.back().value =
            std::nextafter(high.front().value, -std::numeric_limits<double>::infinity());
    low.insert(low.end(), high.begin(), high.end());
    if (below) ramp.stops = std::move(more);
}

/// Of steps: their colours from edge to edge.
chart::Legend legend_of_steps(const ColourRamp& steps, const std::string& layer) {
    chart::Legend legend{
        .title = steps.label, .unit = steps.unit, .edges = steps.edges, .layer = layer};
    legend.ramp.continuous = false;
    for (std::size_t k = 0; k < steps.colours.size(); ++k)
        legend.ramp.stops.push_back({steps.edges[k], colour_of(steps.colours[k])});
    return legend;
}

/// Adds the entries of a plugin's colours to a legend of their title.
void add_entries(const ColourRamp& of, const std::string& layer,
                 std::vector<chart::Legend>& legends) {
    auto same = std::ranges::find_if(
        legends, [&](const chart::Legend& l) { return l.title == of.label && !l.classes.empty(); });
    if (same == legends.end()) same = legends.insert(same, {.title = of.label, .layer = layer});
    for (std::size_t k = 0; k < of.colours.size(); ++k)
        same->classes.push_back({of.entries[k], colour_of(of.colours[k])});
}

/// Adds a ramp to the one that it continues, or as a legend.
void add_ramp(const ColourRamp& ramp, std::pair<double, double> ends, const std::string& layer,
              std::vector<chart::Legend>& legends) {
    auto stops = stops_of(ramp, ends.first, ends.second);
    const auto same = std::ranges::find_if(legends, [&](const chart::Legend& l) {
        return l.title == ramp.label && l.unit == ramp.unit && l.edges.empty() && l.classes.empty();
    });
    if (same != legends.end()) return join(std::move(stops), same->ramp);
    legends.push_back({.title = ramp.label,
                       .unit = ramp.unit,
                       .ramp = {.stops = std::move(stops)},
                       .ring = ramp.is_ring,
                       .layer = layer});
}

}  // namespace

std::vector<chart::Legend> colour_legends(const ActiveEffects& effects, const DemRange& ground) {
    std::vector<chart::Legend> legends;
    for (const effect::Effect* effect : effects.loaded.selection.effects)
        for (const ColourRamp& ramp : effect->ramps()) {
            if (!is_shown(ramp, effects.values)) continue;
            if (!ramp.entries.empty())
                add_entries(ramp, effect->id(), legends);
            else if (!ramp.edges.empty())
                legends.push_back(legend_of_steps(ramp, effect->id()));
            else if (const auto ends = ends_of(ramp, effects.values, ground))
                add_ramp(ramp, *ends, effect->id(), legends);
        }
    return legends;
}

}  // namespace relevo::session

#include "session/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "overlay/band_over.h"
#include "overlay/photo.h"

namespace relevo::session {
namespace {

std::pair<double, double> range_of(const Array2d<float>& values) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const float value : values) {
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    if (!(low < high)) high = low + 1;
    return {double{low}, double{high}};
}

/// The ramp of a band with a colour table.
chart::Ramp ramp_of(const std::vector<std::array<std::uint8_t, 4>>& colors) {
    chart::Ramp ramp;
    ramp.continuous = false;
    for (std::size_t k = 0; k < colors.size(); ++k) {
        const auto& [red, green, blue, alpha] = colors[k];
        ramp.stops.push_back(
            {static_cast<double>(k),
             {std::uint32_t{red} << 16 | std::uint32_t{green} << 8 | blue, alpha / 255.0}});
    }
    return ramp;
}

/// True if all values are 0, 1 or NaN.
bool is_mask(const overlay::BandOver& band) {
    return band.whole && std::ranges::all_of(band.values, [](float value) {
               return value == 0 || value == 1 || std::isnan(value);
           });
}

chart::Ramp ramp_of(const scene::Overlay& asked, const overlay::BandOver& band, bool mask) {
    if (mask && asked.colours.empty() && !asked.range) return chart::named_ramp("shade", 0, 1);
    if (asked.colours.empty() && !asked.range)
        return band.colors.empty() ? usual_ramp(band.values, band.name, band.unit)
                                   : ramp_of(band.colors);
    // A mask that is dark all over still ranges from 0 to 1.
    const auto [from, to] =
        asked.range.value_or(mask ? std::pair(0.0, 1.0) : range_of(band.values));
    if (asked.colours.empty()) {
        chart::Ramp ramp = usual_ramp(band.values, band.name, band.unit);
        const double low = ramp.stops.front().value, high = ramp.stops.back().value;
        for (chart::Ramp::Stop& stop : ramp.stops)
            stop.value = from + (stop.value - low) / (high - low) * (to - from);
        return ramp;
    }
    return scene::names_file(asked.colours) ? chart::read_ramp(asked.colours, from, to)
                                            : chart::named_ramp(asked.colours, from, to);
}

/// Whether the scene's overlay is drawn in its own colours.
bool is_photo(const scene::Overlay& asked) {
    if (!asked.colours.empty() || asked.range || asked.band != 1) return false;
    const overlay::PhotoKind kind = overlay::photo_kind(asked.file);
    if (kind == overlay::PhotoKind::None) return false;
    // Bands of sunlight are bytes, and GDAL calls three of them red, green and blue.
    if (time_of(asked)) return false;
    if (kind == overlay::PhotoKind::Deep)
        bad_input(
            fmt::format("{}: red, green and blue of more than 8 bits, expected 8; convert the "
                        "overlay with gdal_translate -ot Byte -scale, or name colours for one "
                        "band with --overlay-colours",
                        asked.file));
    return true;
}

Overlay photo_of(const scene::Overlay& asked, const dem::Grid& grid) {
    auto raster = std::make_shared<render::OverlayRaster>();
    raster->photo = overlay::Photo::open(asked.file, grid);
    raster->opacity = asked.opacity;
    raster->lit = asked.lit;
    return {.raster = std::move(raster), .has_given_title = !asked.title.empty()};
}

}  // namespace

Overlay overlay_of(const Array2d<float>& values, chart::Legend legend, double opacity, bool lit) {
    auto raster = std::make_shared<render::OverlayRaster>();
    raster->lit = lit;
    raster->rgba = Array2d<std::uint32_t>(values.width(), values.height());
    parallel_for(0, values.height(), 16, [&](int first, int end) {
        for (int row = first; row < end; ++row)
            for (int column = 0; column < values.width(); ++column) {
                const chart::Color color = legend.ramp.at(double{values.at(column, row)});
                raster->rgba.at(column, row) = render::overlay_texel(
                    (color.rgb >> 16 & 255) / 255.0, (color.rgb >> 8 & 255) / 255.0,
                    (color.rgb & 255) / 255.0, color.opacity * opacity);
            }
    });
    return {std::move(raster), std::move(legend)};
}

chart::Ramp usual_ramp(const Array2d<float>& values, const std::string& name,
                       const std::string& unit) {
    const auto [low, high] = range_of(values);
    // The last name is that of earlier versions.
    if (name == "direct sun" || name == "visible fraction of the solar disc" ||
        name == "share of the sun's disc")
        return chart::named_ramp("shade", 0, 1);
    if (name == "sky-view factor") return chart::named_ramp("steel", std::min(low, 0.5), 1);
    if (unit == "h") return chart::named_ramp("sun", 0, std::max(high, 1.0));
    return chart::named_ramp("viridis", low, high);
}

void show_as_clock(const OverlayTime& time, chart::Legend& legend) {
    if (legend.unit != "min" || !time.is_day()) return;
    legend.clock = true;
    legend.unit.clear();
    constexpr std::string_view kMinutes = "minutes to the ";
    if (legend.title.starts_with(kMinutes)) legend.title.erase(0, kMinutes.size());
}

std::optional<OverlayTime> time_of(const scene::Overlay& overlay) {
    return overlay_time(overlay::band_metadata(overlay.file, overlay.band));
}

std::optional<sun::Instant> instant_of_overlay(const scene::Scene& scene) {
    const std::optional<OverlayTime> time = scene.overlay ? time_of(*scene.overlay) : std::nullopt;
    return time ? time->utc : std::nullopt;
}

Overlay read_overlay(const scene::Overlay& asked, const dem::Grid& grid) {
    if (is_photo(asked)) return photo_of(asked, grid);
    const overlay::BandOver band = overlay::read_band_over(grid, asked.file, asked.band);
    const std::optional<OverlayTime> time = overlay_time(band.about);
    const bool mask = time && time->sun && is_mask(band);
    chart::Legend legend{
        .title = asked.title, .unit = printable(band.unit), .ramp = ramp_of(asked, band, mask)};
    // In a mask of several times, bands are named by their times.
    if (legend.title.empty()) legend.title = mask ? "direct sun" : printable(band.name);
    if (legend.title.empty())
        legend.title = printable(std::filesystem::path(asked.file).filename().string());
    if (mask) {
        const auto color = [&](double value) {
            chart::Color result = legend.ramp.at(value);
            result.opacity *= asked.opacity;
            return result;
        };
        legend.classes = {{"in the sun", color(1)}, {"in the shade", color(0)}};
    }
    if (time) show_as_clock(*time, legend);
    Overlay overlay = overlay_of(band.values, std::move(legend), asked.opacity, asked.lit);
    overlay.time = time;
    overlay.has_given_title = !asked.title.empty();
    return overlay;
}

std::optional<chart::Legend> dated_legend(const Overlay& overlay, const std::string& zone,
                                          const geo::Geodetic& middle) {
    std::optional<chart::Legend> legend = overlay.legend;
    if (!legend || !overlay.time || overlay.has_given_title) return legend;
    if (const std::string when = clock_text(*overlay.time, zone, middle); !when.empty())
        legend->title += ", " + when;
    return legend;
}

}  // namespace relevo::session

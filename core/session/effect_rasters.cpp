#include "session/effect_rasters.h"

#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "overlay/band_over.h"

namespace relevo::session {

EffectRasters::EffectRasters(const ActiveEffects& effects, const dem::Grid& grid,
                             const EffectRasters& earlier) {
    for (const effect::Effect* effect : effects.loaded.selection.effects)
        for (const effect::RasterSpec& spec : effect->manifest.rasters) {
            const Source source{
                effects.values.text(spec.file),
                spec.colours.empty() ? std::string() : effects.values.text(spec.colours),
                spec.is_values};
            const auto known = earlier.entries_.find(spec.resource);
            if (known != earlier.entries_.end() && known->second.source == source &&
                known->second.stamps.hold()) {
                entries_.emplace(*known);
                continue;
            }
            if (source.file.empty()) log::info(effect::no_file_text(spec.file));
            try {
                entries_.emplace(spec.resource, read(source, grid));
            } catch (const Error& error) {
                throw Error(error.code(), fmt::format("{}: {}", spec.file, error.what()));
            }
        }
}

EffectRasters::Entry EffectRasters::read(const Source& source, const dem::Grid& grid) {
    Entry entry{.source = source, .stamps = {}};
    if (source.file.empty()) return entry;
    if (source.is_values) {
        overlay::BandOver band = overlay::read_band_over(grid, source.file, 1);
        auto raster = std::make_shared<render::OverlayRaster>();
        raster->values = std::move(band.values);
        entry.overlay.raster = std::move(raster);
    } else {
        entry.overlay = read_overlay({.file = source.file, .colours = source.colours}, grid);
    }
    entry.stamps.add(source.file);
    if (scene::names_file(source.colours)) entry.stamps.add(source.colours);
    return entry;
}

render::NamedRasters EffectRasters::named() const {
    render::NamedRasters rasters;
    for (const auto& [resource, entry] : entries_)
        rasters.emplace(resource, entry.overlay.raster);
    return rasters;
}

std::vector<chart::Legend> EffectRasters::legends(const std::string& zone,
                                                  const geo::Geodetic& middle) const {
    std::vector<chart::Legend> legends;
    for (const auto& [resource, entry] : entries_)
        if (std::optional<chart::Legend> legend = dated_legend(entry.overlay, zone, middle)) {
            legend->layer = resource.substr(0, resource.find('.'));
            legends.push_back(std::move(*legend));
        }
    return legends;
}

}  // namespace relevo::session

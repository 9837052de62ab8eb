#include "session/effect_fields.h"

#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "overlay/band_over.h"

namespace relevo::session {
namespace {

/// Values in per cent become shares.
overlay::ValuesAround read_values(const effect::FieldSpec& spec, const std::string& file,
                                  const dem::Grid& dem) {
    overlay::ValuesAround around = overlay::read_band_around(dem, file, 1);
    const bool per_cent = overlay::bands_of(file).front().unit == "%";
    for (float& value : around.values) {
        if (per_cent) value *= 0.01F;
        // 100 stored as 99.9 or 100.1 is meant, 43 is not.
        if (value < 0 || value > 1.005 * spec.most)
            bad_input(
                fmt::format("{}: has the value {:g}, expected 0 to {:g}{}", file,
                            per_cent ? 100 * value : value, per_cent ? 100 * spec.most : spec.most,
                            spec.most == 1 && !per_cent
                                ? "; per cent need the unit %, as by gdal_edit.py -units % FILE"
                                : ""));
    }
    return around;
}

}  // namespace

EffectFields::EffectFields(const ActiveEffects& effects, const dem::Grid& dem,
                           const EffectFields& earlier) {
    for (const effect::Effect* effect : effects.loaded.selection.effects)
        for (const effect::FieldSpec& spec : effect->manifest.fields) {
            const std::string file = effects.values.text(spec.file);
            const auto known = earlier.entries_.find(spec.resource);
            if (known != earlier.entries_.end() && known->second.file == file &&
                known->second.stamps.hold()) {
                entries_.emplace(*known);
                continue;
            }
            Entry entry{.file = file, .weather = spec.weather};
            try {
                if (!file.empty()) {
                    entry.field =
                        field_of(read_values(spec, file, dem), overlay::places_over_dem(dem));
                    entry.stamps.add(file);
                    if (const float part = entry.field->part_of_dem; part < 0.995F)
                        log::info(fmt::format("{}: {} has values for {:.0f} % of the DEM",
                                              spec.file, file, 100 * part));
                }
            } catch (const Error& error) {
                throw Error(error.code(), fmt::format("{}: {}", spec.file, error.what()));
            }
            entries_.emplace(spec.resource, std::move(entry));
        }
}

render::NamedFields EffectFields::named(const WeatherFields& weather) const {
    render::NamedFields fields;
    for (const auto& [resource, entry] : entries_) {
        const auto forecast = weather.find(entry.weather);
        fields[resource] = entry.field                 ? entry.field
                           : forecast != weather.end() ? forecast->second
                                                       : nullptr;
    }
    return fields;
}

}  // namespace relevo::session

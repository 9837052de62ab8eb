#pragma once

#include <map>
#include <memory>
#include <string>

#include "base/file_stamps.h"
#include "dem/grid.h"
#include "render/fields.h"
#include "session/active_effects.h"
#include "session/cover_forecast.h"

namespace relevo::session {

/// The fields of active effects (effect::FieldSpec), read from the files that their texts name.
class EffectFields {
  public:
    EffectFields() = default;
    /// @param dem      its centre is the origin of the local frame
    /// @param earlier  read before around the same DEM; what has not changed is not read again
    /// @throws Error (BadInput) `clouds.cover_1_file: FILE: ...` as overlay::read_band_around(),
    /// and
    ///     for values below 0 or above FieldSpec::most
    EffectFields(const ActiveEffects& effects, const dem::Grid& dem,
                 const EffectFields& earlier = {});

    /// Those of the files, and of the weather where no file is named.
    render::NamedFields named(const WeatherFields& weather) const;

  private:
    struct Entry {
        std::string file, weather;
        FileStamps stamps{};
        std::shared_ptr<const render::Field> field{};  ///< null if no file is named
    };
    std::map<std::string, Entry> entries_;  // by resource
};

}  // namespace relevo::session

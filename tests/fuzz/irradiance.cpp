#include <string>

#include "fuzz/fuzz.h"
#include "light/plane/horizon_file.h"
#include "light/plane/irradiance_file.h"

namespace relevo::fuzz {

const Target kIrradiance("irradiance", [](std::string_view bytes) {
    const std::string path = file(bytes, "irradiance");
    attempt([&] { light::read_irradiance(path, "--irradiance"); });
    attempt([&] {
        light::read_irradiance(path, "--irradiance",
                               {light::RowTime::parse("instant+0.5"), sun::Zone()});
    });
    attempt([&] { light::read_horizon(path, "--horizon", false).skyline(); });
    light::read_horizon(path, "--horizon", true);
});

}  // namespace relevo::fuzz

#include "sky/air.h"

namespace relevo::sky {

double aerosol_depth(const Air& air, double um) {
    return air.angstrom_beta * std::pow(um, -air.angstrom_alpha);
}

Extinction extinction(const Air& air) {
    constexpr double kMoleculesOfDobsonUnit_per_m2 = 2.687e20;
    constexpr double kOzoneThickness_m = 15000;  // the layer's column over its peak density
    const double ozone_per_m3 = air.ozone_du * kMoleculesOfDobsonUnit_per_m2 / kOzoneThickness_m;
    Extinction result;
    for (int i = 0; i < kWavelengths; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double um = wavelength_um(i);
        result.rayleigh[k] = 1.24062e-6 * std::pow(um, -4);
        result.aerosol[k] = aerosol_depth(air, um) / kAerosolScaleHeight_m;
        result.ozone[k] = ozone_per_m3 * ozone_cross_section()[k];
    }
    return result;
}

}  // namespace relevo::sky

#include "sky/spectrum.h"

#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace relevo::sky {
namespace {

/// A bell with different widths to its left and right.
double lobe(double x, double centre, double left, double right) {
    const double t = (x - centre) / (x < centre ? left : right);
    return std::exp(-0.5 * t * t);
}

glm::dvec3 matching_functions(double nm) {
    return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
                0.065 * lobe(nm, 501.1, 20.4, 26.2),
            0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
            1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

glm::dvec3 tristimulus(const Spectrum& share) {
    static const std::array<glm::dvec3, kWavelengths> kSun = [] {
        std::array<glm::dvec3, kWavelengths> sun;
        for (int i = 0; i < kWavelengths; ++i)
            sun[static_cast<std::size_t>(i)] = solar_irradiance()[static_cast<std::size_t>(i)] *
                                               matching_functions(1e3 * wavelength_um(i));
        return sun;
    }();
    glm::dvec3 xyz(0);
    for (std::size_t k = 0; k < kWavelengths; ++k)
        xyz += share[k] * kSun[k];
    return xyz;
}

glm::dvec3 sun_tristimulus() {
    Spectrum one{};
    one.fill(1);
    return tristimulus(one);
}

glm::dmat3 to_srgb() {
    return glm::transpose(glm::dmat3{3.2406, -1.5372, -0.4986,  //
                                     -0.9689, 1.8758, 0.0415,   //
                                     0.0557, -0.2040, 1.0570});
}

const glm::dvec3& white() {
    static const glm::dvec3 kWhite = to_srgb() * sun_tristimulus();
    return kWhite;
}

}  // namespace

double wavelength_um(int i) {
    return 0.400 + 0.020 * i;
}

const Spectrum& solar_irradiance() {
    static constexpr Spectrum kIrradiance{1.72765, 1.6887,  1.91198, 2.02042, 1.93377, 1.91686,
                                          1.8685,  1.85149, 1.8341,  1.8147,  1.7533,  1.68194,
                                          1.6048,  1.55622, 1.474,   1.41018};
    return kIrradiance;
}

const Spectrum& ozone_cross_section() {
    static constexpr Spectrum kCrossSection{
        1.527e-27, 5.52e-27,  1.582e-26, 3.669e-26, 7.752e-26, 1.48e-25,  2.139e-25, 3.091e-25,
        4.266e-25, 4.398e-25, 5.019e-25, 3.74e-25,  2.662e-25, 1.852e-25, 1.209e-25, 7.455e-26};
    return kCrossSection;
}

glm::dvec3 colour_of(const Spectrum& share) {
    return to_srgb() * tristimulus(share) / white();
}

glm::dvec3 xyz_of(const Spectrum& share) {
    static const double kLuminance = sun_tristimulus().y;
    return tristimulus(share) / kLuminance;
}

glm::dvec3 xyz_of_colour(const glm::dvec3& linear_srgb) {
    static const double kLuminance = sun_tristimulus().y;
    static const glm::dmat3 kToXyz = glm::inverse(to_srgb());
    return kToXyz * (linear_srgb * white()) / kLuminance;
}

glm::dvec2 chromaticity(const glm::dvec3& xyz) {
    return glm::dvec2(4 * xyz.x, 9 * xyz.y) / (xyz.x + 15 * xyz.y + 3 * xyz.z);
}

}  // namespace relevo::sky

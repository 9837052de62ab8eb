#pragma once

#include "figure/accuracy.h"
#include "figure/figure.h"
#include "figure/sun_over_middle.h"

namespace relevo::figure {

/// What lies in the shadow of the terrain, a band for each sun: `relevo sun shadow`.
struct Shadow : Figure {
    std::vector<SunOverMiddle> suns;
    /// Names of the bands of several suns; empty: there is one, whose band is named by what it is.
    std::vector<std::string> names;
    /// As light::refraction_at(); empty: suns are given as they are seen.
    std::string refraction = "standard";
    bool soft = false;  ///< visible fraction of the sun's disc instead of a mask
    /// Shown each part under each sun, by its number.
    std::function<void(std::size_t sun, const light::Shadows& part)> seen{};

    output::RasterType type() const override {
        return soft ? output::RasterType::Float : output::RasterType::Byte;
    }
    std::vector<output::RasterBand> bands() const override;
    output::RasterMetadata metadata(const dem::Posts& posts) const override;
    const char* accuracy() const override { return kShadowAccuracy; }
    std::size_t calls() const override { return suns.size(); }
    int bytes_a_post() const override { return 8; }
    /// The lowest sun casts the longest shadows.
    double halo_m(const dem::Posts& posts) const override;
    std::optional<light::Beyond> beyond(const dem::Posts& posts,
                                        const dem::Window& window) const override;
    PartMaker maker(Work work) const override;

    /// A sentence on the refraction of the sun.
    std::string air(const dem::Posts& posts) const;

  private:
    light::ShadowOptions options() const;
    std::vector<light::SunOverDem> directions() const;
};

}  // namespace relevo::figure

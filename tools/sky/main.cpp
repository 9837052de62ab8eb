#include <array>
#include <exception>
#include <filesystem>

#include <fmt/format.h>
#include <getopt.h>

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "sky/shipped.h"
#include "stars.h"
#include "textures.h"

namespace relevo::skymaker {
namespace {

void print_table(const Atmosphere& air) {
    fmt::print(
        "sun_deg  irradiance of level ground by the sky: red green blue; luminance lux; "
        "transmittance of the sun's light: red green blue\n");
    for (const double deg :
         {90., 60., 45., 30., 15., 10., 5., 2., 0., -2., -4., -6., -9., -12., -18.}) {
        const double sine = std::sin(radians(deg));
        const glm::dvec3 sky = level_irradiance(air, sine);
        const double level = luminance(sky);
        const glm::dvec3 sun = colour_of(air.transmittance(sine));
        fmt::print("{:5.0f}  {:.3e}  {:.2f} {:.2f} {:.2f}  {:9.4g} lux  {:.4f} {:.4f} {:.4f}\n",
                   deg, level, sky.r / level, sky.g / level, sky.b / level, 127500 * level, sun.r,
                   sun.g, sun.b);
    }
}

struct Options {
    std::filesystem::path output, stars;
    bool table = false;
};

/// @throws Error (Usage)
Options parse(int argc, char** argv) {
    constexpr const char* kUsage =
        "usage: relevo_make_sky FOLDER --stars stars.csv [--table]\n"
        "Makes the skies of Relevo in FOLDER/sky; --table prints the light of the sky for heights "
        "of the sun.\n";
    enum { kStars = 1, kTable };
    constexpr std::array<option, 3> kOptions{{{"stars", required_argument, nullptr, kStars},
                                              {"table", no_argument, nullptr, kTable},
                                              {}}};
    Options options;
    for (int found; (found = getopt_long(argc, argv, "", kOptions.data(), nullptr)) != -1;) {
        if (found == kStars) options.stars = optarg;
        if (found == kTable) options.table = true;
        if (found == '?') bad_usage(kUsage);
    }
    if (optind + 1 != argc || options.stars.empty()) bad_usage(kUsage);
    options.output = argv[optind];
    return options;
}

void run(const Options& options) {
    const Atmosphere air;
    if (options.table) print_table(air);
    const std::filesystem::path folder = options.output / "sky";
    std::filesystem::create_directories(folder);
    sky::write_atmosphere(folder / "air.bin", sky::Atmosphere());
    write_ktx(folder / "light.ktx2", light_texture(air));
    for (const auto& [name, deg] :
         {std::pair{"day", 45.0}, std::pair{"sunset", 0.0}, std::pair{"night", -18.0}})
        write_ktx(folder / fmt::format("{}.ktx2", name),
                  single_texture(air, std::sin(radians(deg))));
    write_ktx(folder / "stars.ktx2", star_texture(read_stars(options.stars)));
}

}  // namespace
}  // namespace relevo::skymaker

int main(int argc, char** argv) {
    using namespace relevo;
    try {
        skymaker::run(skymaker::parse(argc, argv));
        return 0;
    } catch (const Error& error) {
        log::error(error.what());
        return error.exit_status();
    } catch (const std::exception& error) {
        log::error(fmt::format("relevo_make_sky: {}", error.what()));
        return 1;
    }
}

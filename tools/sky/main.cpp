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

struct Options {
    std::filesystem::path output, stars;
};

/// @throws Error (Usage)
Options parse(int argc, char** argv) {
    constexpr const char* kUsage =
        "usage: relevo_make_sky FOLDER --stars stars.csv\n"
        "Makes the skies of Relevo in FOLDER/sky.\n";
    enum { kStars = 1 };
    constexpr std::array<option, 2> kOptions{{{"stars", required_argument, nullptr, kStars}, {}}};
    Options options;
    for (int found; (found = getopt_long(argc, argv, "", kOptions.data(), nullptr)) != -1;) {
        if (found == kStars) options.stars = optarg;
        if (found == '?') bad_usage(kUsage);
    }
    if (optind + 1 != argc || options.stars.empty()) bad_usage(kUsage);
    options.output = argv[optind];
    return options;
}

void run(const Options& options) {
    const sky::Atmosphere air, clean(sky::Air{.angstrom_beta = 0.04});
    const std::filesystem::path folder = options.output / "sky";
    std::filesystem::create_directories(folder);
    sky::write_atmosphere(folder / "air.bin", air);
    write_ktx(folder / "light.ktx2", light_texture(air));
    for (const auto& [name, deg] :
         {std::pair{"day", 45.0}, std::pair{"sunset", 0.0}, std::pair{"night", -18.0}})
        write_ktx(folder / fmt::format("{}.ktx2", name),
                  single_texture(clean, std::sin(radians(deg))));  // of the paper's skies
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

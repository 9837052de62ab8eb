#include <array>
#include <bit>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <getopt.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
#include "base/text.h"
#include "maps.h"
#include "material.h"
#include "patches.h"
#include "preview.h"
#include "volume.h"

namespace relevo::ground {
namespace {

struct Options {
    std::filesystem::path output;
    std::filesystem::path png;
    std::vector<std::string> only;
    int size = 1024;
    int volume_size = 128;
};

void run(const Options& options) {
    const auto start = std::chrono::steady_clock::now();
    std::filesystem::create_directories(options.output / "ground");
    std::filesystem::create_directories(options.output / "noise");
    if (!options.png.empty()) std::filesystem::create_directories(options.png);

    const std::vector<std::string> names = options.only.empty() ? material_names() : options.only;
    struct Made {
        image::TextureData albedo, normal;
    };
    std::vector<Made> made(names.size());
    image::TextureData volume;
    std::vector<std::function<void()>> works;
    for (std::size_t i = 0; i < names.size(); ++i)
        works.emplace_back([&, i] {
            const Material material = make_material(names[i], options.size);
            made[i] = {albedo_texture(material), normal_texture(material)};
            const std::string file = (options.output / "ground" / names[i]).string();
            write_ktx(file + "_albedo.ktx2", made[i].albedo);
            write_ktx(file + "_normal.ktx2", made[i].normal);
        });
    const std::filesystem::path noise = options.output / "noise";
    works.emplace_back([&] {
        volume = perlin_texture(options.volume_size);
        write_ktx(noise / "perlin.ktx2", volume);
    });
    works.emplace_back([&] { write_ktx(noise / "patches.ktx2", patches_texture(options.size)); });
    works.emplace_back(
        [&] { write_ktx(noise / "regions.ktx2", regions_texture(options.size / 2)); });
    parallel_for(0, static_cast<int>(works.size()), 1, [&](int first, int last) {
        for (int i = first; i < last; ++i)
            works[static_cast<std::size_t>(i)]();
    });
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    log::debug(fmt::format("all done at {:.2f} s", taken.count()));

    if (options.png.empty()) return;
    std::vector<Ground> grounds;
    for (std::size_t i = 0; i < names.size(); ++i) {
        write_previews(options.png, names[i], made[i].albedo, made[i].normal);
        grounds.push_back({&made[i].albedo, &made[i].normal});
    }
    write_composite(options.png / "composite_near.png", grounds, 4, 45);
    write_composite(options.png / "composite_low.png", grounds, 4, 10);
    write_composite(options.png / "composite_far.png", grounds, 64, 45);
    write_volume_preview(options.png / "perlin.png", volume);
}

constexpr const char* kUsage =
    "usage: relevo_make_ground FOLDER [--png FOLDER] [--only sand,grass,rock,snow]\n"
    "           [--size TEXELS] [--volume-size TEXELS] [-v]\n"
    "Makes the ground materials and the noises of Relevo in FOLDER/ground and FOLDER/noise;\n"
    "--png makes pictures to look at, sizes are powers of two.\n";

/// Texels a side. @throws Error (Usage)
int size_of(const char* name, std::string_view text, int least, int most) {
    int size = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), size);
    const bool whole = fault == std::errc() && end == text.data() + text.size();
    if (!whole || size < least || size > most || !std::has_single_bit(unsigned(size)))
        bad_usage(fmt::format("{}: expected a power of two from {} to {} but got {}", name, least,
                              most, text));
    return size;
}

/// @throws Error (Usage)
Options parse(int argc, char** argv) {
    enum { kPng = 1, kOnly, kSize, kVolumeSize };
    constexpr std::array<option, 6> kOptions{
        {{"png", required_argument, nullptr, kPng},
         {"only", required_argument, nullptr, kOnly},
         {"size", required_argument, nullptr, kSize},
         {"volume-size", required_argument, nullptr, kVolumeSize},
         {"verbose", no_argument, nullptr, 'v'},
         {}}};
    Options options;
    for (int found; (found = getopt_long(argc, argv, "v", kOptions.data(), nullptr)) != -1;) {
        if (found == kPng) options.png = optarg;
        if (found == kOnly) options.only = split(optarg, ',');
        if (found == kSize) options.size = size_of("--size", optarg, 64, 2048);
        if (found == kVolumeSize) options.volume_size = size_of("--volume-size", optarg, 32, 256);
        if (found == 'v') log::set_level(log::Level::Debug);
        if (found == '?') bad_usage(kUsage);
    }
    if (optind + 1 != argc) bad_usage(kUsage);
    options.output = argv[optind];
    return options;
}

}  // namespace
}  // namespace relevo::ground

int main(int argc, char** argv) {
    using namespace relevo;
    try {
        ground::run(ground::parse(argc, argv));
        return 0;
    } catch (const Error& error) {
        log::error(error.what());
        return error.exit_status();
    } catch (const std::exception& error) {
        log::error(fmt::format("relevo_make_ground: {}", error.what()));
        return 1;
    }
}

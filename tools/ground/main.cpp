#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel_for.h"
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

}  // namespace
}  // namespace relevo::ground

int main(int argc, char** argv) {
    using namespace relevo;
    ground::Options options;
    bool verbose = false;
    CLI::App app{"Makes the ground materials and the noises of Relevo"};
    app.add_option("output", options.output, "Folder to write ground/ and noise/ into")->required();
    app.add_option("--png", options.png, "Folder for pictures to look at");
    app.add_option("--only", options.only, "Grounds to make: sand, grass, rock, snow")
        ->delimiter(',');
    app.add_option("--size", options.size, "Texels a side of the grounds: a power of two")
        ->check(CLI::IsMember({64, 128, 256, 512, 1024, 2048}));
    app.add_option("--volume-size", options.volume_size, "Texels a side of the noise")
        ->check(CLI::IsMember({32, 64, 128, 256}));
    app.add_flag("-v,--verbose", verbose, "Say how long each part takes");
    CLI11_PARSE(app, argc, argv);
    if (verbose) log::set_level(log::Level::Debug);
    try {
        ground::run(options);
        return 0;
    } catch (const Error& error) {
        log::error(error.what());
        return error.exit_status();
    } catch (const std::exception& error) {
        log::error(fmt::format("relevo_make_ground: {}", error.what()));
        return 1;
    }
}

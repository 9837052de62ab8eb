#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/export.h"
#include "image/image.h"
#include "output/export_text.h"
#include "output/heightmap.h"

namespace relevo::cli {
namespace {

constexpr const char* kSizeRemedy = "--size 4097x4097";

/// --size of a map.
struct SizeArguments {
    std::string text;

    void add_to(Verb verb) {
        verb.add_option("--size", text,
                        "Columns and rows, 1025x1025; default: the DEM's. Fewer are means, more "
                        "are bilinear");
    }
    std::optional<glm::ivec2> size() const {
        if (text.empty()) return std::nullopt;
        const glm::ivec2 size = parse_size(text);
        if (std::min(size.x, size.y) < 2)
            bad_usage(fmt::format("--size: {}: expected at least 2 columns and rows", text));
        return size;
    }
};

image::Metadata texts_of(const output::ExportedGround& ground) {
    return {{"Software", kGenerator}, {"Title", printable(ground.field.about.path)}};
}

void print_posts(const output::ExportedGround& ground) {
    const dem::Grid& grid = ground.field.grid;
    const glm::dvec2 spacing = grid.post_spacing_m();
    fmt::print("posts       {} x {}, {:.4g} x {:.4g} m apart", grid.columns(), grid.rows(),
               spacing.x, spacing.y);
    if (grid.columns() != ground.dem_posts.x || grid.rows() != ground.dem_posts.y)
        fmt::print(", from {} x {} of the DEM", ground.dem_posts.x, ground.dem_posts.y);
    fmt::print("\n");
}

struct HeightmapArguments {
    ExportArguments shared;
    SizeArguments size;
    std::string range;
};

/// "LOW,HIGH". @throws Error (Usage)
std::pair<double, double> parse_range(const std::string& text) {
    std::vector<double> numbers;
    for (const std::string& part : split(text, ','))
        numbers.push_back(parse_number(part).value_or(std::nan("")));
    if (numbers.size() != 2 || !(numbers[0] < numbers[1]))
        bad_usage(
            fmt::format("--range: expected LOW,HIGH in metres, such as 0,4000, but got {}", text));
    return {numbers[0], numbers[1]};
}

output::HeightScale scale_of(const HeightmapArguments& arguments, const Array2d<float>& height_m) {
    // Of what is written: filled voids and means are not in the DEM's statistics.
    const dem::Statistics s = dem::statistics(height_m);
    if (arguments.range.empty()) return output::height_scale(s.min_m, s.max_m);
    const auto [low_m, high_m] = parse_range(arguments.range);
    if (s.min_m < low_m || s.max_m > high_m)
        bad_input(fmt::format("--range: {}: expected to contain all heights, {:g} to {:g} m",
                              arguments.range, s.min_m, s.max_m));
    return output::height_scale(low_m, high_m);
}

void write_heightmap(HeightmapArguments& arguments) {
    if (!arguments.range.empty()) parse_range(arguments.range);
    const std::optional<glm::ivec2> size = arguments.size.size();
    FilesInUse files;
    arguments.shared.open(files, /*scale_file=*/true);
    const output::ExportedGround ground = arguments.shared.read(size, kSizeRemedy);
    const Array2d<float>& height_m = ground.field.height_m;
    const output::HeightScale scale = scale_of(arguments, height_m);
    image::Image16 map = output::heightmap(height_m, scale);
    if (arguments.shared.ending() == "png")
        image::write(arguments.shared.file(), {std::move(map)}, texts_of(ground), {.bits = 16});
    else
        output::write_raw(arguments.shared.file(), map);
    arguments.shared.scale_file().write(output::map_json(ground, kGenerator, &scale, nullptr));
    files.finish_outputs();
    print_posts(ground);
    fmt::print("heights     {:.6g} to {:.6g} m, 0 to {} in steps of {:.4g} m\n", scale.offset_m,
               scale.offset_m + output::kMostValue * scale.step_m, output::kMostValue,
               scale.step_m);
    if (ground.voids > 0) fmt::print("voids       {} posts, written as 0\n", ground.voids);
}

struct NormalsArguments {
    ExportArguments shared;
    SizeArguments size;
    std::string green = "up";
    int bits = 8;
};

void write_normals(NormalsArguments& arguments) {
    const std::optional<glm::ivec2> size = arguments.size.size();
    FilesInUse files;
    arguments.shared.open(files, /*scale_file=*/true);
    const output::ExportedGround ground = arguments.shared.read(size, kSizeRemedy);
    const output::Green green = arguments.green == "up" ? output::Green::Up : output::Green::Down;
    image::Image16 map = output::normal_map(ground.field, green);
    image::Picture picture;
    if (arguments.bits == 8)
        picture.pixels = output::to_8_bits(map);
    else
        picture.pixels = std::move(map);
    image::write(arguments.shared.file(), picture, texts_of(ground), {.bits = arguments.bits});
    arguments.shared.scale_file().write(output::map_json(ground, kGenerator, nullptr, &green));
    files.finish_outputs();
    print_posts(ground);
    fmt::print("normals     red east, green {}, blue up, {} bits\n",
               green == output::Green::Up ? "north (OpenGL)" : "south (DirectX)", arguments.bits);
}

}  // namespace

void add_export_heightmap(Verb export_verb) {
    const auto arguments = std::make_shared<HeightmapArguments>();
    const Verb verb =
        export_verb.add_verb("heightmap", "Heights as 16-bit values, and their scale in FILE.json");
    arguments->shared.add_to(verb, {"png", "r16", "raw"});
    arguments->size.add_to(verb);
    verb.add_option("--range", arguments->range,
                    "Heights of the values 0 and 65535, LOW,HIGH in metres; default: the lowest "
                    "and the highest");
    verb.callback([arguments] { write_heightmap(*arguments); });
}

void add_export_normals(Verb export_verb) {
    const auto arguments = std::make_shared<NormalsArguments>();
    const Verb verb = export_verb.add_verb("normals", "Normal map of the ground");
    arguments->shared.add_to(verb, {"png"});
    arguments->size.add_to(verb);
    verb.add_option("--green", arguments->green,
                    "Where green points: up (north; OpenGL, Unity, Blender), down (south; DirectX, "
                    "Unreal Engine) (up)")
        .check(one_of({"up", "down"}));
    verb.add_option("--bits", arguments->bits, "Bits of a channel, 8 or 16 (8)")
        .check(one_of({"8", "16"}));
    verb.callback([arguments] { write_normals(*arguments); });
}

}  // namespace relevo::cli

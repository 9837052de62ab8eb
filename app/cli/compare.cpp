#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files_in_use.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/shared.h"
#include "image/image.h"

namespace relevo::cli {
namespace {

struct CompareArguments {
    std::string a, b, output;
    double tolerance = 0;
    bool json = false, overwrite = false;
};

/// How far two pictures of one size are apart, in the unit of --tolerance.
struct Found {
    double worst = 0, mean = 0;
    std::size_t over = 0, values = 0;  ///< those beyond the tolerance, and all
};

Found difference(const image::ImageF& a, const image::ImageF& b, double unit, double tolerance) {
    Found found;
    found.values = a.values.size();
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        // Half a thousandth: 8 bits as floats are no whole numbers any more.
        const double apart = std::abs(static_cast<double>(a.values[i]) - b.values[i]) * unit;
        const bool same = a.values[i] == b.values[i] || apart <= tolerance + 5e-4;
        found.over += !same;
        found.worst = std::max(found.worst, std::isnan(apart) ? INFINITY : apart);
        sum += apart;
    }
    if (found.values > 0) found.mean = sum / static_cast<double>(found.values);
    return found;
}

/// The difference of each value, as many times stronger as makes the worst of them white.
image::Image8 picture_of_difference(const image::ImageF& a, const image::ImageF& b, double unit,
                                    const Found& found) {
    image::Image8 picture(a.width, a.height, a.channels);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double apart = std::abs(static_cast<double>(a.values[i]) - b.values[i]) * unit;
        const double share = found.worst > 0 ? apart / found.worst : 0;
        picture.values[i] =
            static_cast<std::uint8_t>(std::lround(255 * (std::isfinite(share) ? share : 1.0)));
    }
    return picture;
}

void compare(const CompareArguments& arguments) {
    const bool linear = image::holds_linear_light(arguments.a);
    if (linear != image::holds_linear_light(arguments.b))
        bad_usage(
            fmt::format("compare: {} and {}: one holds linear light, the other colours; "
                        "compare pictures of one kind",
                        printable(arguments.a), printable(arguments.b)));
    const double unit = linear ? 1 : 255;
    FilesInUse files;
    OutputFile* file = nullptr;
    files.add_input(arguments.a, "the picture");
    files.add_input(arguments.b, "the picture");
    if (!arguments.output.empty()) {
        image::check_format(arguments.output, 1, 1);
        if (image::holds_linear_light(arguments.output))
            bad_usage(
                fmt::format("-o: {}: expected png, jpg, webp or tif", printable(arguments.output)));
        file = &files.open_output(arguments.output, arguments.overwrite, "-o");
    }
    const image::ImageF a = image::read_float(arguments.a), b = image::read_float(arguments.b);
    const std::string who =
        fmt::format("compare: {}, {}", printable(arguments.a), printable(arguments.b));
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        throw Error(ErrorCode::Differ,
                    fmt::format("{}: they differ in size, {}x{} with {} channels and {}x{} with {}",
                                who, a.width, a.height, a.channels, b.width, b.height, b.channels));
    const Found found = difference(a, b, unit, arguments.tolerance);
    if (arguments.json)
        fmt::print("{}", json_text({{"schema", "relevo-compare-1"},
                                    {"same", found.over == 0},
                                    {"worst", found.worst},
                                    {"mean", found.mean},
                                    {"values", found.values},
                                    {"values_over_tolerance", found.over},
                                    {"tolerance", arguments.tolerance}}));
    else
        fmt::print("{}: worst {:.4g}{}, mean {:.4g}, {} of {} values beyond {:.4g}\n",
                   found.over == 0 ? "same" : "different", found.worst, linear ? "" : "/255",
                   found.mean, found.over, found.values, arguments.tolerance);
    if (file) {
        image::write(*file, picture_of_difference(a, b, unit, found));
        files.finish_outputs();
    }
    if (found.over > 0)
        throw Error(ErrorCode::Differ,
                    fmt::format("{}: they differ, by {:.4g}{} at worst, expected at most {:.4g}",
                                who, found.worst, linear ? "" : "/255", arguments.tolerance));
}

}  // namespace

void add_compare(Verb app) {
    const auto arguments = std::make_shared<CompareArguments>();
    const Verb verb = app.add_verb("compare", "Compares two pictures");
    verb.add_option("A", arguments->a, "Picture").required();
    verb.add_option("B", arguments->b, "Picture of the same size").required();
    verb.add_option(
            "--tolerance", arguments->tolerance,
            "Largest difference that counts as equal: of 255; for EXR in units of its light (0)")
        .check(in_range(0.0, 1e9));
    verb.add_option("-o,--output", arguments->output,
                    "Write the difference as a picture; the largest difference is white");
    verb.add_flag("--json", arguments->json, "JSON on standard output");
    verb.add_flag("--overwrite", arguments->overwrite, "Replace an existing file");
    verb.callback([arguments] { compare(*arguments); });
}

}  // namespace relevo::cli

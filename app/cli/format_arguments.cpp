#include "cli/format_arguments.h"

#include <unistd.h>

#include "base/error.h"
#include "cli/shared.h"

namespace relevo::cli {
void FormatArguments::add_to(Verb verb, bool with_format) {
    if (with_format)
        verb.add_option(
                "--format", format,
                "Format of a picture on standard output: png, jpg, webp, avif, tif, pdf, exr")
            .group("Format");
    verb.add_option("--bits", bits, "Bits of each channel, 8 or 16 (png, tif); default: 8")
        .check(one_of({"8", "16"}))
        .group("Format");
    verb.add_option("--quality", quality,
                    "Quality of jpg, webp, avif and pdf, 1 to 100; default: 95")
        .check(whole_number())
        .check(in_range(1, 100))
        .group("Format");
    verb.add_option("--layers", layers,
                    "Data in an exr: a list of depth, normal, position, shadow, albedo, ids; "
                    "or all")
        .delimiter(',')
        .group("Format");
}

image::Encoding FormatArguments::encoding(const std::string& output) const {
    if (is_standard_output(output) && format.empty())
        bad_usage("-o -: the format is missing; add --format png");
    if (!is_standard_output(output) && !format.empty())
        bad_usage("--format: only of -o -; the ending of a file's name is its format");
    if (is_standard_output(output) && isatty(STDOUT_FILENO))
        bad_usage("-o -: standard output is a terminal; redirect it to a file or a program");
    return {.format = format, .bits = bits.value_or(8), .quality = quality};
}

std::filesystem::path FormatArguments::named(const std::string& output) const {
    return is_standard_output(output) ? "standard output." + format : output;
}

session::PictureFormat FormatArguments::picture() const {
    return {.bits = bits.value_or(8), .layers = session::parse_layers(layers, "--layers")};
}

std::string to_file(const std::string& output) {
    return FormatArguments::is_standard_output(output) ? "/dev/stdout" : output;
}

}  // namespace relevo::cli

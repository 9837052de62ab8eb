// Shadows that are drawn against shadows that are marched: shadow_table [--elevations 1,2,5]
// [--azimuths 0,45] [--heights 4] [--part POSTS] [--pixels A_POST] [--effect vsm] [--set
// vsm.bleed=0.1] [--pictures FOLDER] DEM...; with --comparison FILE.png a picture of the first sun
// instead of a table; with --at-posts what is
// drawn at posts of windows all over the DEM, 16 pixels to a post; with --penumbra how well the
// share of the sun's disc is drawn
#include <chrono>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "base/text.h"
#include "image/image.h"
#include "support/shadow_truth.h"

namespace {

/// A pixel a post: red where light is drawn and shadow is true, blue the other way round.
void write_errors(const std::filesystem::path& folder, double elevation, double azimuth,
                  const relevo::shadow::Truth::Mask& mask, const relevo::Array2d<float>& lit) {
    relevo::image::Image8 picture(lit.width(), lit.height(), 3);
    for (int y = 0; y < lit.height(); ++y) {
        for (int x = 0; x < lit.width(); ++x) {
            const bool shaded = mask.shaded.at(x, y), said = lit.at(x, y) < 0.5f;
            std::uint8_t* pixel = picture.row(y) + 3 * x;
            const auto grey =
                static_cast<std::uint8_t>((mask.facing.at(x, y) ? 255 : 128) * (shaded ? 0.4 : 1));
            pixel[0] = pixel[1] = pixel[2] = grey;
            if (!mask.facing.at(x, y) || shaded == said) continue;
            pixel[0] = shaded ? 255 : 0;
            pixel[1] = 0;
            pixel[2] = shaded ? 0 : 255;
        }
    }
    relevo::image::write(folder / fmt::format("errors_{}_{}.png", elevation, azimuth), picture, {},
                         true);
}

/// A part of the DEM from above, three times: depth compared texel by texel, as drawn, and marched.
void write_comparison(const std::filesystem::path& file, const relevo::dem::Heightfield& dem,
                      double elevation, double azimuth) {
    using namespace relevo;
    using namespace relevo::shadow;
    constexpr int kPosts = 220, kScale = 2, kGap = 8;
    const std::filesystem::path scratch = test::scratch_dir();
    const glm::dvec3 to_sun = direction(azimuth, elevation);
    // "Hard": no blur, no deviation and no bias, so that a texel is either nearer or not.
    Drawn hard(dem, scratch,
               {"vsm.blur=0", "vsm.softness=0", "vsm.bias=0", "vsm.bleed=0.9", "vsm.size=1024"});
    Drawn drawn(dem, scratch);
    const Truth truth(dem, drawn.ground().frame);
    const Truth::Mask mask = truth.cast(to_sun);
    const Array2d<float> panels[] = {hard.at_posts(to_sun, truth.posts()),
                                     drawn.at_posts(to_sun, truth.posts())};
    const glm::ivec2 first((dem.grid.columns() - kPosts) / 2, (dem.grid.rows() - kPosts) / 2);
    image::Image8 picture(3 * kPosts * kScale + 2 * kGap, kPosts * kScale, 3);
    std::fill(picture.values.begin(), picture.values.end(), std::uint8_t{255});
    for (int panel = 0; panel < 3; ++panel) {
        for (int y = 0; y < kPosts * kScale; ++y) {
            for (int x = 0; x < kPosts * kScale; ++x) {
                const int i = first.x + x / kScale, j = first.y + y / kScale;
                const auto& posts = truth.posts();
                glm::dvec3 n = cross(posts.at(i + 1, j) - posts.at(i - 1, j),
                                     posts.at(i, j - 1) - posts.at(i, j + 1));
                n = normalize(n.z < 0 ? -n : n);
                const double lit = panel == 2 ? 1 - mask.shaded.at(i, j) : panels[panel].at(i, j);
                const double light = 0.16 * n.z + 1.5 * lit * std::max(dot(n, to_sun), 0.0);
                const auto grey =
                    static_cast<std::uint8_t>(255 * std::pow(std::clamp(light, 0.0, 1.0), 1 / 2.2));
                std::uint8_t* pixel = picture.row(y) + 3 * (x + panel * (kPosts * kScale + kGap));
                pixel[0] = pixel[1] = pixel[2] = grey;
            }
        }
    }
    image::write(file, picture, {}, true);
}

/// So many posts a side out of the middle; all of them for 0.
relevo::dem::Heightfield middle_of(relevo::dem::Heightfield dem, int side) {
    if (side == 0) return dem;
    const int columns = std::min(side, dem.grid.columns()), rows = std::min(side, dem.grid.rows());
    const relevo::dem::Window window{(dem.grid.columns() - columns) / 2,
                                     (dem.grid.rows() - rows) / 2, columns, rows};
    relevo::Array2d<float> heights(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            heights.at(x, y) = dem.height_m.at(window.column + x, window.row + y);
    relevo::dem::Heightfield part{std::move(heights), dem.grid.part(window, columns, rows),
                                  dem.about};
    part.about.statistics = relevo::dem::statistics(part.height_m);
    return part;
}

/// A row a sun: the posts that see a part of its disc, and how large a part is drawn there.
void print_penumbras(relevo::shadow::Drawn& drawn, const relevo::shadow::Truth& truth,
                     const std::vector<double>& elevations, const std::vector<double>& azimuths) {
    fmt::print("| sun | azimuth | posts in the penumbra | mean error | mean size of the error |\n");
    fmt::print("|---|---|---|---|---|\n");
    drawn.semidiameter_rad() = relevo::shadow::kSunRadius_rad;
    for (const double elevation : elevations)
        for (const double azimuth : azimuths) {
            const glm::dvec3 to_sun = relevo::shadow::direction(azimuth, elevation);
            const auto at = relevo::shadow::at_posts_themselves(drawn, truth, to_sun, 2, 60, 32);
            const auto p = relevo::shadow::penumbra(truth, at.lit, at.shown, to_sun);
            fmt::print("| {} | {} | {} | {:+.3f} | {:.3f} |\n", elevation, azimuth, p.posts, p.mean,
                       p.mean_size);
            std::fflush(stdout);
        }
}

}  // namespace

int main(int argc, char** argv) {
    using namespace relevo;
    using namespace relevo::shadow;
    std::vector<double> elevations{1, 2, 5, 10, 20, 40, 60},
        azimuths{0, 45, 90, 135, 180, 225, 270, 315};
    std::vector<std::string> dems, settings;
    std::filesystem::path pictures, comparison;
    double pixel_error = 2, factor = 1;
    std::string effect = "shadows";
    bool penumbra = false, themselves = false;
    int side = 0, pixels = 0;
    const auto numbers = [](const std::string& text) {
        std::vector<double> result;
        for (const std::string& part : split(text, ','))
            result.push_back(std::stod(part));
        return result;
    };
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--elevations")
            elevations = numbers(argv[++i]);
        else if (word == "--azimuths")
            azimuths = numbers(argv[++i]);
        else if (word == "--set")
            settings.emplace_back(argv[++i]);
        else if (word == "--pictures")
            pictures = argv[++i];
        else if (word == "--comparison")
            comparison = argv[++i];
        else if (word == "--pixel-error")
            pixel_error = std::stod(argv[++i]);
        else if (word == "--effect")
            effect = argv[++i];
        else if (word == "--part")
            side = std::stoi(argv[++i]);
        else if (word == "--pixels")
            pixels = std::stoi(argv[++i]);
        else if (word == "--at-posts")
            themselves = true;
        else if (word == "--penumbra")
            penumbra = true;
        else if (word == "--heights")
            factor = std::stod(argv[++i]);
        else
            dems.push_back(word);
    }
    try {
        for (const std::string& path : dems) {
            const dem::Heightfield dem = middle_of(times_as_high(dem::load(path), factor), side);
            const glm::ivec2 size =
                pixels * glm::ivec2(dem.grid.columns(), dem.grid.rows()) + (pixels > 0 ? 8 : 0);
            if (!comparison.empty()) {
                write_comparison(comparison, dem, elevations[0], azimuths[0]);
                continue;
            }
            Drawn drawn(dem, test::scratch_dir(), settings, pixel_error, size, effect);
            const Truth truth(dem, drawn.ground().frame);
            fmt::print("\n{}{}: {} x {} posts\n\n", std::filesystem::path(path).filename().string(),
                       factor == 1 ? "" : fmt::format(", heights times {}", factor),
                       dem.grid.columns(), dem.grid.rows());
            if (penumbra) {
                print_penumbras(drawn, truth, elevations, azimuths);
                continue;
            }
            double worst = 1, worst_beyond = 1, worst_lit = 1;
            fmt::print(
                "| sun | azimuth | shaded | balanced accuracy | beyond two texels | lit cells "
                "right | shaded cells right | texel |\n");
            fmt::print("|---|---|---|---|---|---|---|---|\n");
            for (const double elevation : elevations) {
                for (const double azimuth : azimuths) {
                    const glm::dvec3 to_sun = direction(azimuth, elevation);
                    const Truth::Mask mask = truth.cast(to_sun);
                    const AtPosts at =
                        themselves ? at_posts_themselves(drawn, truth, to_sun) : AtPosts{};
                    const Array2d<float> lit =
                        themselves ? at.lit : drawn.at_posts(to_sun, truth.posts());
                    const Score s = score(truth, mask, lit, drawn.texel_m(), to_sun,
                                          drawn.spacing_m(), themselves ? &at.shown : nullptr);
                    fmt::print(
                        "| {} | {} | {:.1f} % | {:.2f} % | {:.2f} % | {:.2f} % | {:.2f} % | {:.1f} "
                        "x {:.2f} m |\n",
                        elevation, azimuth, 100 * s.shaded_share, 100 * s.balanced, 100 * s.beyond,
                        100 * s.lit_right, 100 * s.shaded_right, s.texel_m.x, s.texel_m.y);
                    std::fflush(stdout);
                    worst = s.shaded_share < 0.01 ? worst : std::min(worst, s.balanced);
                    worst_beyond =
                        s.shaded_share < 0.01 ? worst_beyond : std::min(worst_beyond, s.beyond);
                    worst_lit = std::min(worst_lit, s.lit_right);
                    if (!pictures.empty()) write_errors(pictures, elevation, azimuth, mask, lit);
                }
            }
            fmt::print(
                "\nWorst with at least 1 % shaded: {:.2f} %, beyond two texels {:.2f} %. Lit "
                "cells in false shadow, of all rows: at most {:.2f} %.\n",
                100 * worst, 100 * worst_beyond, 100 * (1 - worst_lit));
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}

#include "web/page_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "web/site.h"

namespace relevo::web {
namespace {

using nlohmann::ordered_json;

constexpr int kBestQuality = 92, kWorstQuality = 30;  // of JPEG
constexpr int kStillQuality = 80;
constexpr int kLeastColour_px = 64;

/// Means of 2 x 2 pixels.
image::Image8 halved(const image::Image8& image) {
    image::Image8 half(image.width / 2, image.height / 2, image.channels);
    for (int y = 0; y < half.height; ++y)
        for (int i = 0; i < half.width * half.channels; ++i) {
            const int x = i / half.channels * 2, c = i % half.channels;
            const int sum = image.at(x, 2 * y, c) + image.at(x + 1, 2 * y, c) +
                            image.at(x, 2 * y + 1, c) + image.at(x + 1, 2 * y + 1, c);
            half.row(y)[i] = static_cast<std::uint8_t>((sum + 2) / 4);
        }
    return half;
}

std::vector<std::byte> jpeg(const image::Image8& image, int quality) {
    return image::encoded("colour.jpg", {image}, {}, {.format = "jpg", .quality = quality});
}

/// The best JPEG of an image within so many bytes.
std::vector<std::byte> jpeg_within(image::Image8 image, std::size_t most_bytes) {
    for (;; image = halved(image)) {
        if (std::min(image.width, image.height) < kLeastColour_px)
            bad_input(
                "export web: --megabytes: leaves no room for the ground's colour; expected more");
        int good = kWorstQuality, bad = kBestQuality + 1;
        std::vector<std::byte> best = jpeg(image, good);
        if (best.size() > most_bytes) continue;
        while (bad - good > 1) {
            const int middle = (good + bad) / 2;
            std::vector<std::byte> tried = jpeg(image, middle);
            if (tried.size() > most_bytes) {
                bad = middle;
            } else {
                good = middle;
                best = std::move(tried);
            }
        }
        return best;
    }
}

ordered_json json_of(const Look& look, const dem::Grid& grid) {
    const glm::dvec2 post = grid.post(look.eye);
    return {{"post", {post.x, post.y}},
            {"height", look.eye.height_m},
            {"heading", look.heading_deg},
            {"pitch", look.pitch_deg},
            {"fov", look.fov_deg}};
}

}  // namespace

std::vector<std::byte> still_jpeg(const Content& content) {
    return jpeg(content.still, kStillQuality);
}

double bytes_of(const Content& content) {
    return static_cast<double>(jpeg(content.colour, kBestQuality).size() +
                               still_jpeg(content).size());
}

std::vector<std::byte> page_data(const PageGround& ground, const Content& content,
                                 std::size_t most_bytes) {
    ordered_json about{{"title", content.title},
                       {"credits", content.credits},
                       {"made_by", content.generator},
                       {"exaggeration", content.exaggeration},
                       {"exposure", std::exp2(content.exposure_ev)},
                       {"view", json_of(content.look, ground.grid)},
                       {"time", sun::to_iso(content.utc)},
                       {"zone", ordered_json::parse(zone_json(content.zone))},
                       {"refraction", ordered_json::parse(refraction_json(content.refraction))}};
    about.update(ordered_json::parse(ground.about));
    std::vector<Block> blocks = ground.blocks;
    blocks.push_back(as_is("still", "jpeg", still_jpeg(content)));
    const std::size_t taken = container(about.dump(), blocks).size() + 200;  // a row of the table
    if (taken >= most_bytes)
        bad_input("export web: --megabytes: leaves no room for the ground's colour; expected more");
    blocks.push_back(as_is("colour", "jpeg", jpeg_within(content.colour, most_bytes - taken)));
    return container(about.dump(), blocks);
}

}  // namespace relevo::web

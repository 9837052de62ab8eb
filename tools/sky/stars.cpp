#include "stars.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "base/units.h"
#include "sky/spectrum.h"
#include "textures.h"

namespace relevo::skymaker {
namespace {

constexpr std::string_view kHeader = "hr,ra_deg,dec_deg,pm_ra_arcsec,pm_dec_arcsec,v_mag,b_v_mag";
constexpr double kSunBv = 0.653;  // I. Ramirez et al., Astrophys. J. 752 (2012) 5

/// A number that is the whole of `text`.
std::optional<double> number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

double sign(double x) {
    return x < 0 ? -1 : 1;
}

}  // namespace

std::vector<Star> read_stars(const std::filesystem::path& path) {
    const auto fail = [&](int line, const std::string& what) {
        bad_input(fmt::format("relevo_make_sky: {}:{}: {}", path.string(), line, what));
    };
    std::ifstream file(path);
    if (!file) bad_input(fmt::format("relevo_make_sky: {}: cannot be read", path.string()));
    std::string text;
    std::getline(file, text);
    if (text != kHeader) fail(1, fmt::format("expected the columns {}", kHeader));
    std::vector<Star> stars;
    for (int line = 2; std::getline(file, text); ++line) {
        std::array<std::optional<double>, 7> fields;
        std::string_view rest = text;
        std::size_t count = 0;
        for (bool more = true; more && count < fields.size(); ++count) {
            const std::size_t comma = rest.find(',');
            fields[count] = number(rest.substr(0, comma));
            more = comma != std::string_view::npos;
            rest = more ? rest.substr(comma + 1) : std::string_view();
        }
        const bool bare = count == fields.size() && text.ends_with(',');
        if (count != fields.size() || !rest.empty() ||
            !std::all_of(fields.begin(), fields.end() - 1, [](const auto& f) { return f; }) ||
            (!fields[6] && !bare))
            fail(line, fmt::format("expected 7 numbers, the last of which may be empty, got \"{}\"",
                                   text));
        const auto& [hr, ra_deg, dec_deg, pm_ra, pm_dec, v, b_v] = fields;
        if (!(*ra_deg >= 0 && *ra_deg < 360 && std::abs(*dec_deg) <= 90))
            fail(line, fmt::format("no place in the sky: {}, {} degrees", *ra_deg, *dec_deg));
        const double ra = radians(*ra_deg), dec = radians(*dec_deg);
        const glm::dvec3 there{std::cos(dec) * std::cos(ra), std::cos(dec) * std::sin(ra),
                               std::sin(dec)};
        const glm::dvec3 east{-std::sin(ra), std::cos(ra), 0};
        const double moved = radians((kStarEpoch - 2000) / 3600);
        stars.push_back({static_cast<int>(*hr),
                         normalize(there + moved * (*pm_ra * east + *pm_dec * cross(there, east))),
                         *v, b_v});
    }
    return stars;
}

int StarLayout::code_of(double magnitude, double b_v) {
    const auto steps = [](double value, double from, double step, int most) {
        return std::clamp(static_cast<int>(std::lround((value - from) / step)), 0, most);
    };
    return 1 + 16 * steps(magnitude, kBrightestMag, kMagStep, 127) +
           steps(b_v, kBluest, kBvStep, 15);
}

double StarLayout::magnitude_of(int code) {
    return kBrightestMag + kMagStep * ((code - 1) / 16);
}

double StarLayout::b_v_of(int code) {
    return kBluest + kBvStep * ((code - 1) % 16);
}

glm::dvec3 StarLayout::centre_of(int x, int y) {
    const glm::dvec2 p((2 * x + 1.0) / kAcross - 1, (2 * y + 1.0) / kAcross - 1);
    glm::dvec3 v(p, 1 - std::abs(p.x) - std::abs(p.y));
    if (v.z < 0) {
        v.x = (1 - std::abs(p.y)) * sign(p.x);
        v.y = (1 - std::abs(p.x)) * sign(p.y);
    }
    return normalize(v);
}

void StarLayout::cell_of(const glm::dvec3& direction, int& x, int& y) {
    const glm::dvec3 d =
        direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    glm::dvec2 p(d);
    if (d.z < 0) p = {(1 - std::abs(d.y)) * sign(d.x), (1 - std::abs(d.x)) * sign(d.y)};
    const auto cell = [](double t) {
        return std::clamp(static_cast<int>((0.5 * t + 0.5) * kAcross), 0, kAcross - 1);
    };
    x = cell(p.x);
    y = cell(p.y);
}

image::TextureData star_texture(const std::vector<Star>& stars) {
    constexpr int n = StarLayout::kAcross;
    std::vector<std::vector<const Star*>> cells(static_cast<std::size_t>(n * n));
    // Points all over a cap of the reach, closer together than the smallest cell is wide.
    constexpr int kRings = 8, kSpokes = 64;
    for (const Star& star : stars) {
        const glm::dvec3 aside = normalize(cross(star.direction, std::abs(star.direction.z) < 0.9
                                                                     ? glm::dvec3(0, 0, 1)
                                                                     : glm::dvec3(1, 0, 0)));
        const glm::dvec3 across = cross(star.direction, aside);
        for (int ring = 0; ring <= kRings; ++ring) {
            const double r = std::tan(radians(StarLayout::kReach_deg) * ring / kRings);
            for (int spoke = 0; spoke < (ring == 0 ? 1 : kSpokes); ++spoke) {
                const double at = 2 * kPi * spoke / kSpokes;
                int x = 0, y = 0;
                StarLayout::cell_of(
                    star.direction + r * (std::cos(at) * aside + std::sin(at) * across), x, y);
                auto& cell = cells[static_cast<std::size_t>(y * n + x)];
                if (cell.empty() || cell.back() != &star) cell.push_back(&star);
            }
        }
    }
    std::size_t depth = 1;
    for (auto& cell : cells) {
        std::stable_sort(cell.begin(), cell.end(),
                         [](const Star* a, const Star* b) { return a->magnitude < b->magnitude; });
        depth = std::max(depth, cell.size());
    }
    image::TextureData data(PixelFormat::RGBA16F, n, n, static_cast<int>(depth), 1, 1);
    const std::span<std::byte> texels = data.writable_level(0);
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            const auto& cell = cells[static_cast<std::size_t>(y * n + x)];
            for (std::size_t i = 0; i < cell.size(); ++i) {
                const Star& star = *cell[i];
                const glm::dvec3 apart = star.direction - StarLayout::centre_of(x, y);
                const int code = StarLayout::code_of(star.magnitude, star.b_v.value_or(kSunBv));
                write_texel(texels,
                            (i * n + static_cast<std::size_t>(y)) * n + static_cast<std::size_t>(x),
                            glm::dvec4(apart, code));
            }
        }
    }
    return data;
}

glm::dvec3 star_colour(double b_v) {
    const auto temperature_k = [](double index) {
        return 4600 * (1 / (0.92 * index + 1.7) + 1 / (0.92 * index + 0.62));
    };
    const auto black_body = [](double t_k, double wavelength_um) {
        return 1 / (std::exp(14387.769 / (wavelength_um * t_k)) - 1);  // but for its common factor
    };
    const double star_k = temperature_k(b_v), sun_k = temperature_k(kSunBv);
    sky::Spectrum share{};
    for (int i = 0; i < sky::kWavelengths; ++i)
        share[static_cast<std::size_t>(i)] =
            black_body(star_k, sky::wavelength_um(i)) / black_body(sun_k, sky::wavelength_um(i));
    const glm::dvec3 colour = sky::colour_of(share);
    return colour / luminance(colour);
}

}  // namespace relevo::skymaker

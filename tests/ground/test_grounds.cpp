#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <sched.h>

#include "base/fft.h"
#include "base/text.h"
#include "image/ktx.h"
#include "maps.h"
#include "material.h"
#include "support/support.h"

// The four grounds as they are shipped: the files in the build's share folder.
namespace relevo::ground {
namespace {

struct Texel {
    glm::vec3 albedo;
    float gloss;
    glm::vec3 normal;
    float height;  ///< 0..1
};

struct Ground {
    image::TextureData albedo, normal;

    Array2d<Texel> level(int l) const {
        const int n = albedo.level_width(l);
        Array2d<Texel> texels(n, n);
        const auto a = albedo.level(l), b = normal.level(l);
        const auto unit = [](std::byte v) {
            return static_cast<float>(std::to_integer<int>(v)) / 255.0f;
        };
        for_each_texel(n, [&](int c, int r) {
            const auto i = static_cast<std::size_t>(4 * (r * n + c));
            texels.at(c, r) = {{srgb_decoded(unit(a[i])), srgb_decoded(unit(a[i + 1])),
                                srgb_decoded(unit(a[i + 2]))},
                               unit(a[i + 3]),
                               {2 * unit(b[i]) - 1, 2 * unit(b[i + 1]) - 1, 2 * unit(b[i + 2]) - 1},
                               unit(b[i + 3])};
        });
        return texels;
    }
};

const Ground& ground(const std::string& name) {
    static std::map<std::string, Ground> read;
    const auto dir = test::build_dir() / "share/relevo/data/ground";
    if (!read.count(name))
        read[name] = {image::read_ktx(dir / (name + "_albedo.ktx2")),
                      image::read_ktx(dir / (name + "_normal.ktx2"))};
    return read.at(name);
}

template <typename Value>
double mean_of(const Array2d<Texel>& texels, Value value) {
    double sum = 0;
    for (const Texel& t : texels)
        sum += value(t);
    return sum / static_cast<double>(texels.size());
}

double luminance_of(const Texel& t) {
    return luminance(t.albedo);
}

class Grounds : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Ground, Grounds, testing::Values("sand", "grass", "rock", "snow"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(Grounds, FilesAreWhatTheLayersNeed) {
    const Ground& g = ground(GetParam());
    EXPECT_EQ(g.albedo.format(), PixelFormat::Srgb8A8);
    EXPECT_EQ(g.normal.format(), PixelFormat::RGBA8);
    for (const image::TextureData* t : {&g.albedo, &g.normal}) {
        EXPECT_EQ(t->width(), 1024);
        EXPECT_EQ(t->height(), 1024);
        EXPECT_EQ(t->levels(), 11);
        EXPECT_EQ(t->metadata.at("relevo.material"), GetParam());
        EXPECT_EQ(t->metadata.at("KTXorientation"), "ru");
        const double tile_m = std::stod(t->metadata.at("relevo.tile_m"));
        EXPECT_GE(tile_m, 2);
        EXPECT_LE(tile_m, 10);
    }
}

/// Linear sRGB of a spectrum of reflectance under daylight: CIE 15:2004, section 7; the matrix of
/// IEC 61966-2-1.
glm::dvec3 colour_of(const test::Csv& csv, const char* column) {
    glm::dvec3 xyz(0);
    double white = 0;
    const auto number = [&](const std::vector<std::string>& row, const char* name) {
        return std::stod(row[csv.column(name)]);
    };
    for (const auto& row : csv.rows) {
        const double light = number(row, "d65");
        const glm::dvec3 cie(number(row, "cie_x"), number(row, "cie_y"), number(row, "cie_z"));
        xyz += cie * light * number(row, column);
        white += cie.y * light;
    }
    xyz /= white;
    return {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
            -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
            0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
}

// What each ground is made of is argued in docs/ground-materials.md.
TEST_P(Grounds, MeanAlbedoIsThatOfMeasuredSpectra) {
    const test::Csv csv = test::read_csv(test::source_dir() / "tests/ground/reference_spectra.csv");
    const std::map<std::string, glm::dvec3> expected{
        {"sand", 0.8 * colour_of(csv, "loamy_sand") + 0.2 * colour_of(csv, "gypsum_sand")},
        {"grass", 0.88 * colour_of(csv, "green_grass") + 0.08 * colour_of(csv, "dry_grass") +
                      0.04 * colour_of(csv, "loam")},
        {"rock", 0.5 * colour_of(csv, "granite") + 0.5 * colour_of(csv, "mica_schist")},
        {"snow", 0.9 * colour_of(csv, "snow")}};
    const Array2d<Texel> texels = ground(GetParam()).level(0);
    std::vector<double> errors;
    for (int channel = 0; channel < 3; ++channel) {
        const double got = mean_of(texels, [&](const Texel& t) { return t.albedo[channel]; });
        const double want = expected.at(GetParam())[channel];
        errors.push_back(std::abs(got / want - 1));
        EXPECT_NEAR(got, want, 0.01 * want) << "channel " << channel;
    }
    test::print_accuracy(fmt::format("mean albedo of {}", GetParam()), errors, "of it", 0.01);
}

// T. R. Oke, Boundary Layer Climates, 2nd edition, 1987, table 1.1 (snow, desert) and table 8.1
// (stone): albedo over all sunlight. Grass is seen without its infrared: over 400 to 700 nm a sward
// reflects 0.05 to 0.10.
TEST_P(Grounds, MeanLuminanceLiesInTheRangesOfTheTables) {
    const std::map<std::string, std::pair<double, double>> range{{"sand", {0.20, 0.45}},
                                                                 {"grass", {0.05, 0.10}},
                                                                 {"rock", {0.15, 0.35}},
                                                                 {"snow", {0.80, 0.95}}};
    const double y = mean_of(ground(GetParam()).level(0), luminance_of);
    EXPECT_GE(y, range.at(GetParam()).first);
    EXPECT_LE(y, range.at(GetParam()).second);
}

// What changes from the last column to the first, or row, changes no more than between the columns
// inside: in every channel by itself, as a step in the height drowns in the grain of the colours.
TEST_P(Grounds, RepeatWithoutASeam) {
    const std::pair<const char*, float (*)(const Texel&)> channels[] = {
        {"luminance", [](const Texel& t) { return luminance(t.albedo); }},
        {"red over blue", [](const Texel& t) { return t.albedo.r / (t.albedo.b + 0.05f); }},
        {"gloss", [](const Texel& t) { return t.gloss; }},
        {"normal x", [](const Texel& t) { return t.normal.x; }},
        {"normal y", [](const Texel& t) { return t.normal.y; }},
        {"height", [](const Texel& t) { return t.height; }}};
    for (const int l : {0, 1, 2, 3}) {
        const Array2d<Texel> texels = ground(GetParam()).level(l);
        const int n = texels.width();
        for (const auto& [name, value] : channels)
            for (const bool columns : {true, false}) {
                const auto at = [&](int i, int k) {
                    i = (i + n) % n;
                    return value(columns ? texels.at(i, k) : texels.at(k, i));
                };
                // Against what the neighbours on both sides lead to expect.
                std::vector<double> jumps;
                for (int i = 0; i < n; ++i) {
                    double sum = 0;
                    for (int k = 0; k < n; ++k)
                        sum += std::abs(at(i, k) - at(i + 1, k)) -
                               0.5 * std::abs(at(i - 1, k) - at(i, k)) -
                               0.5 * std::abs(at(i + 1, k) - at(i + 2, k));
                    jumps.push_back(sum);
                }
                const double seam = jumps.back();
                jumps.pop_back();
                EXPECT_LE(seam, *std::max_element(jumps.begin(), jumps.end()))
                    << name << (columns ? ", columns" : ", rows") << ", level " << l;
            }
    }
}

TEST_P(Grounds, NormalsAreOneLongOnEveryLevel) {
    for (int l = 0; l < 11; ++l)
        for (const Texel& t : ground(GetParam()).level(l))
            ASSERT_NEAR(glm::length(t.normal), 1, 0.015) << "level " << l;
}

// Level ground stays level on the whole, or light from one side would favour it.
TEST_P(Grounds, MeanSlopeIsZeroOnEveryLevel) {
    for (int l = 0; l < 11; ++l) {
        const Array2d<Texel> texels = ground(GetParam()).level(l);
        const double count = static_cast<double>(texels.size());
        for (int axis = 0; axis < 2; ++axis) {
            const double slope =
                mean_of(texels, [&](const Texel& t) { return t.normal[axis] / t.normal.z; });
            EXPECT_NEAR(slope, 0, 0.001 + 0.012 / std::sqrt(count)) << "level " << l;
        }
    }
}

TEST_P(Grounds, NormalsAreThoseOfTheHeights) {
    const Ground& g = ground(GetParam());
    const Array2d<Texel> texels = g.level(1);  // where a byte of height counts less
    const int n = texels.width();
    const double range_m = std::stod(g.normal.metadata.at("relevo.height_max_m")) -
                           std::stod(g.normal.metadata.at("relevo.height_min_m"));
    Field height_m(n, n);
    for_each_texel(n, [&](int c, int r) {
        height_m.at(c, r) = static_cast<float>(range_m) * texels.at(c, r).height;
    });
    const Slopes slope = slopes(height_m, std::stod(g.normal.metadata.at("relevo.tile_m")));
    double ab = 0, aa = 0, bb = 0;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) {
            const glm::vec3 normal = texels.at(c, r).normal;
            const double a = slope.ds.at(c, r), b = -normal.x / normal.z;
            const double p = slope.dt.at(c, r), q = -normal.y / normal.z;
            ab += a * b + p * q;
            aa += a * a + p * p;
            bb += b * b + q * q;
        }
    EXPECT_GT(ab / std::sqrt(aa * bb), 0.85);
    EXPECT_NEAR(std::sqrt(aa / bb), 1, 0.25);
}

// Light comes from the renderer alone: a baked sun would make slopes to one side brighter.
TEST_P(Grounds, AlbedoHasNoLightInIt) {
    const Array2d<Texel> texels = ground(GetParam()).level(0);
    const double y = mean_of(texels, luminance_of);
    double yy = 0, xx[2] = {0, 0}, xy[2] = {0, 0};
    for (const Texel& t : texels) {
        const double d = luminance_of(t) - y;
        yy += d * d;
        for (int axis = 0; axis < 2; ++axis) {
            xx[axis] += t.normal[axis] * t.normal[axis];
            xy[axis] += d * t.normal[axis];
        }
    }
    for (int axis = 0; axis < 2; ++axis)
        EXPECT_NEAR(xy[axis] / std::sqrt(yy * xx[axis]), 0, 0.05) << "axis " << axis;
}

TEST_P(Grounds, MipLevelsKeepTheMeanAlbedo) {
    const Ground& g = ground(GetParam());
    for (int channel = 0; channel < 3; ++channel) {
        const auto value = [&](const Texel& t) { return t.albedo[channel]; };
        const double base = mean_of(g.level(0), value);
        // Half a step of a byte, by which all texels of a level may be rounded the same way.
        for (int l = 1; l < 11; ++l)
            EXPECT_NEAR(srgb_encoded(static_cast<float>(mean_of(g.level(l), value))),
                        srgb_encoded(static_cast<float>(base)), 0.55 / 255)
                << "level " << l;
    }
}

TEST_P(Grounds, GlossFadesWithDistanceAndNeverGrows) {
    const Ground& g = ground(GetParam());
    double before = 2;
    for (int l = 0; l < 11; ++l) {
        const double gloss = mean_of(g.level(l), [](const Texel& t) { return t.gloss; });
        EXPECT_GT(gloss, 0.005) << "level " << l;
        EXPECT_LE(gloss, before + 0.003) << "level " << l;
        before = gloss;
    }
}

/// The greatest wave of up to four cycles a tile, as a share of the mean.
TEST_P(Grounds, NoWaveOfTheTilesSizeIsLeft) {
    const Array2d<Texel> texels = ground(GetParam()).level(3);  // 128 x 128
    const int n = texels.width();
    for (int channel = 0; channel < 3; ++channel) {
        ComplexField waves(n, n);
        double mean = 0;
        for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c) {
                waves.at(c, r) = texels.at(c, r).albedo[channel];
                mean += texels.at(c, r).albedo[channel];
            }
        fft(waves, false);
        double greatest = 0;
        for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c) {
                const double k = std::hypot(frequency(c, n), frequency(r, n));
                if (k > 0 && k <= 4)
                    greatest = std::max(greatest, 2.0 * std::abs(waves.at(c, r)) / mean);
            }
        EXPECT_LT(greatest, 0.002) << "channel " << channel;
    }
}

// From far a tile is a few texels: they have to be alike, or the ground shows a grid.
TEST_P(Grounds, ATileIsEvenWhenItIsSixteenTexelsWide) {
    const Array2d<Texel> texels = ground(GetParam()).level(6);
    ASSERT_EQ(texels.width(), 16);
    const double y = mean_of(texels, luminance_of);
    const double square =
        mean_of(texels, [&](const Texel& t) { return std::pow(luminance_of(t) / y - 1, 2); });
    EXPECT_LT(std::sqrt(square), 0.035);
    // Nor is it dead even near by.
    const Array2d<Texel> near = ground(GetParam()).level(0);
    const double fine =
        mean_of(near, [&](const Texel& t) { return std::pow(luminance_of(t) / y - 1, 2); });
    EXPECT_GT(std::sqrt(fine), GetParam() == std::string("snow") ? 0.008 : 0.05);
}

TEST(GroundFiles, AreTheSameWhateverTheThreads) {
    const auto dir = test::scratch_dir("ground_threads");
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
        if (CPU_ISSET(cpu, &all)) {
            CPU_SET(cpu, &one);
            break;
        }
    const auto make = [&](const char* name, const cpu_set_t& cpus) {
        // The child has this process's processors.
        EXPECT_EQ(sched_setaffinity(0, sizeof cpus, &cpus), 0);
        const std::string command = fmt::format("'{}' --size 128 --volume-size 32 '{}'",
                                                RELEVO_MAKE_GROUND, (dir / name).string());
        EXPECT_EQ(std::system(command.c_str()), 0);
        EXPECT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
    };
    make("one", one);
    make("all", all);
    make("again", all);
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir / "one")) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const auto relative = std::filesystem::relative(entry.path(), dir / "one");
        const std::string bytes = read_text(entry.path(), "test");
        EXPECT_EQ(bytes == read_text(dir / "all" / relative, "test"), true) << relative;
        EXPECT_EQ(bytes == read_text(dir / "again" / relative, "test"), true) << relative;
    }
    EXPECT_EQ(files, 11);
}

TEST(GroundFiles, AnUnknownGroundIsNamed) {
    EXPECT_EQ(test::error_of([] { make_material("lava", 64); }),
              "exit 2: make_material: lava: no such ground, expected sand, grass, rock or snow");
}

TEST(GroundFiles, SnowIsBrighterThanSandThanRockThanGrass) {
    const auto y = [](const char* name) { return mean_of(ground(name).level(5), luminance_of); };
    EXPECT_GT(y("snow"), 2 * y("sand"));
    EXPECT_GT(y("sand"), 1.5 * y("rock"));
    EXPECT_GT(y("rock"), 1.5 * y("grass"));
}

}  // namespace
}  // namespace relevo::ground

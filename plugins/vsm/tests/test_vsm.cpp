#include <cmath>
#include <random>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "support/device.h"
#include "support/gpu_snippet.h"
#include "support/shadow_truth.h"

namespace relevo::shadow::test_vsm {
namespace {

dem::Heightfield jacksboro() {
    return dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
}

/// Heights at the posts of a UTM grid.
/// @param row_m  from row to row, to the north; columns are as far apart
dem::Heightfield field(int columns, int rows, const std::function<double(int, int)>& height_m,
                       double row_m = -30) {
    Array2d<float> heights(columns, rows);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            heights.at(x, y) = static_cast<float>(height_m(x, y));
    dem::Description about;
    about.statistics = dem::statistics(heights);
    return {std::move(heights),
            dem::Grid(columns, rows, {400000, std::abs(row_m), 0, 5000000, 0, row_m},
                      geo::Crs::parse("EPSG:32631", "test")),
            about};
}

// ---- the bound

TEST(Vsm, ChebyshevsBoundOnTheGpuIsTheReferences) {
    constexpr int kHeights = 400, kDeviations = 60;
    test::GpuSnippet gpu("vsm");
    const auto results = gpu.run(
        "float height = float(x) * 2.5 - 500.0;\n"
        "float deviation = 0.3 * exp2(float(y) * 0.15);\n"
        "float bound = vsm_chebyshev(vec2(20.0, deviation * deviation), height);\n"
        "result = vec4(bound, vsm_cut(bound, 0.2), 0.0, 0.0);",
        kHeights, kDeviations);
    std::vector<double> errors;
    for (int y = 0; y < kDeviations; ++y) {
        for (int x = 0; x < kHeights; ++x) {
            const double height = x * 2.5 - 500, deviation = 0.3 * std::exp2(y * 0.15);
            const double above = std::max(20 - height, 0.0);
            const double bound = deviation * deviation / (deviation * deviation + above * above);
            const double cut = std::clamp((bound - 0.2) / 0.8, 0.0, 1.0);
            const glm::vec4& found = results[static_cast<std::size_t>(y * kHeights + x)];
            errors.push_back(std::abs(found.x - bound));
            errors.push_back(std::abs(found.y - cut));
        }
    }
    test::print_accuracy("Chebyshev's bound", errors, "of 1", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

/// Runs a fragment program of the plugin's as core/render/native_host.cpp does.
gl::Texture filtered(const char* file, const gl::Texture& from,
                     const std::vector<glm::vec4>& values) {
    const std::string vertex =
        "#version 450 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0,"
        " gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
    const std::string fragment =
        "#version 450 core\nlayout(location = 0) uniform vec4 values[16];\n" +
        read_text(test::source_dir() / "plugins/vsm" / file, "test");
    gl::Program::Failure failure;
    const auto program = gl::Program::build(vertex, fragment, file, failure);
    if (!program) failed(failure.log);
    gl::Texture target(gl::TextureKind::D2, gl::Format::RG32F,
                       {from.extent().width, from.extent().height, 1}, 1, file);
    const gl::Framebuffer framebuffer({&target}, nullptr, file);
    const gl::VertexArray no_inputs;
    program->use();
    from.bind(0);
    glUniform4fv(0, static_cast<int>(values.size()), &values[0].x);
    framebuffer.bind();
    no_inputs.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return target;
}

/// Mean and variance about the line through the neighbours, in double precision.
glm::dvec2 blurred(const std::array<glm::dvec2, 3>& m, double blur) {
    const double mean = (1 - blur) * m[1].x + blur / 2 * (m[0].x + m[2].x);
    const double slope = (m[2].x - m[0].x) / 2;
    const auto off2 = [&](double value) { return (value - mean) * (value - mean); };
    return {mean, (1 - blur) * (m[1].y + off2(m[1].x)) +
                      blur / 2 * (m[0].y + off2(m[0].x + slope) + m[2].y + off2(m[2].x - slope))};
}

TEST(Vsm, BlurOnTheGpuIsTheReferences) {
    constexpr int kSide = 97;
    constexpr double kBlur = 0.3, kFloor_m = -700;
    const gl::Context context({.device = test::gl_device(), .debug = true});
    std::mt19937 random(3);
    std::vector<float> depths(kSide * kSide);
    for (std::size_t i = 0; i < depths.size(); ++i)
        depths[i] = random() % 20 == 0 ? 0.0f : static_cast<float>(random() % 100000 + 1) / 100001;
    gl::Texture depth(gl::TextureKind::D2, gl::Format::Depth32F, {kSide, kSide, 1}, 1, "depth");
    depth.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
    depth.write(0, {0, 0, 0}, {kSide, kSide, 1}, std::as_bytes(std::span(depths)));
    const glm::vec4 plane(0, 6.5, 900, -800), weights(1 - kBlur, kBlur / 2, 0, 0);
    const glm::vec4 below(kFloor_m, 1.0f / kSide, 1.0f / kSide, 0);
    gl::Texture rows = filtered("moments.frag.glsl", depth, {plane, below, weights});
    rows.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
    const gl::Texture both = filtered("blur.frag.glsl", rows, {weights, below});
    std::vector<glm::vec2> found(kSide * kSide);
    both.read(0, std::as_writable_bytes(std::span(found)));

    const auto clamped = [](int i) { return std::clamp(i, 0, kSide - 1); };
    const auto height = [&](int x, int y) {
        const float d = depths[static_cast<std::size_t>(clamped(y) * kSide + clamped(x))];
        return d > 0 ? plane.y * (clamped(y) + 0.5) + double{plane.z} * d + plane.w : kFloor_m;
    };
    std::vector<double> errors;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            std::array<glm::dvec2, 3> row;
            for (int j = -1; j <= 1; ++j) {
                const int at = clamped(y + j);
                row[static_cast<std::size_t>(j + 1)] =
                    blurred({glm::dvec2(height(x - 1, at), 0), glm::dvec2(height(x, at), 0),
                             glm::dvec2(height(x + 1, at), 0)},
                            kBlur);
            }
            const glm::dvec2 expected = blurred(row, kBlur);
            const glm::vec2 got = found[static_cast<std::size_t>(y * kSide + x)];
            errors.push_back(std::abs(got.x - expected.x));
            errors.push_back(std::abs(std::sqrt(got.y) - std::sqrt(expected.y)));
        }
    }
    test::print_accuracy("blurred mean and deviation", errors, "m", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

TEST(Vsm, ASlopeHasNoDeviationAndAnEdgeHas) {
    const double slope = blurred({glm::dvec2(10, 0), {20, 0}, {30, 0}}, 0.3).y;
    const double edge = blurred({glm::dvec2(10, 0), {10, 0}, {30, 0}}, 0.3).y;
    EXPECT_DOUBLE_EQ(slope, 0);
    EXPECT_GT(edge, 1);
}

// ---- against rays

/// Suns (elevation and azimuth) over one DEM, drawn and marched.
std::vector<Score> scores(const dem::Heightfield& dem, const std::string& scratch,
                          const std::vector<glm::dvec2>& suns) {
    Drawn drawn(dem, test::scratch_dir(scratch));
    const Truth truth(dem, drawn.ground().frame);
    std::vector<Score> result;
    for (const glm::dvec2& sun : suns) {
        const glm::dvec3 to_sun = direction(sun.y, sun.x);
        const Truth::Mask mask = truth.cast(to_sun);
        const Array2d<float> lit = drawn.at_posts(to_sun, truth.posts());
        result.push_back(score(truth, mask, lit, drawn.texel_m(), to_sun, drawn.spacing_m()));
        const Score& s = result.back();
        fmt::print(
            "[ shadow ] sun at {} degrees from {}: {:.1f} % shaded, balanced accuracy "
            "{:.2f} %, {:.2f} % beyond two texels, {:.2f} % of what is lit falsely shaded\n",
            sun.x, sun.y, 100 * s.shaded_share, 100 * s.balanced, 100 * s.beyond,
            100 * (1 - s.lit_right));
    }
    return result;
}

TEST(Vsm, ShadowsAreThoseOfRaysOverTheSamePosts) {
    for (const Score& s :
         scores(jacksboro(), "vsm_truth", {{1, 315}, {2, 0}, {5, 135}, {10, 225}, {20, 90}})) {
        EXPECT_GT(s.shaded_share, 0.01);
        EXPECT_GE(s.balanced, 0.95);
        EXPECT_GE(s.beyond, 0.99);
    }
}

TEST(Vsm, ShadowsOfAHighSunOverSteepGroundAreThoseOfRays) {
    for (const Score& s :
         scores(times_as_high(jacksboro(), 4), "vsm_steep", {{30, 225}, {40, 45}})) {
        EXPECT_GT(s.shaded_share, 0.05);
        EXPECT_GE(s.balanced, 0.95);
        EXPECT_GE(s.beyond, 0.99);
    }
}

TEST(Vsm, AHighSunShadesNothingThatItShinesOn) {
    for (const double factor : {1.0, 2.0})
        for (const Score& s :
             scores(times_as_high(jacksboro(), factor), "vsm_noon", {{60, 45}, {60, 225}}))
            EXPECT_GE(s.lit_right, 0.999);
}

TEST(Vsm, TruthOfAWallIsItsTangent) {
    // A wall 100 m high along a column of level ground, the sun 10 degrees high beyond it.
    const dem::Heightfield dem = field(61, 41, [](int x, int) { return x == 50 ? 100.0 : 0.0; });
    const render::Ground ground = render::make_ground(dem);
    const Truth truth(dem, ground.frame);
    const Truth::Mask mask = truth.cast(direction(90, 10));
    const double reach_posts = 100 / std::tan(radians(10)) / 30;  // 18.9
    for (int x = 0; x < 49; ++x)
        EXPECT_EQ(mask.shaded.at(x, 20) != 0, 50 - x < reach_posts) << x;
    EXPECT_FALSE(mask.shaded.at(55, 20));
}

TEST(Vsm, TruthOfASteepSlopeIsThatItsUpperPartShadesNothingAwayFromTheSun) {
    // A slope of 45 degrees that the sun, 60 degrees high, shines on from its foot.
    const dem::Heightfield dem = field(41, 41, [](int x, int) { return 30.0 * x; });
    const render::Ground ground = render::make_ground(dem);
    const Truth truth(dem, ground.frame);
    const Truth::Mask mask = truth.cast(direction(270, 60));
    for (int x = 1; x < 40; ++x) {
        EXPECT_TRUE(mask.facing.at(x, 20));
        EXPECT_FALSE(mask.shaded.at(x, 20)) << x;
    }
}

TEST(Vsm, TheRimAndHolesCastNothing) {
    // Level ground 1500 m high with a hole in its middle.
    const dem::Heightfield dem = field(180, 140, [](int x, int y) {
        return x > 80 && x < 100 && y > 60 && y < 80 ? std::nan("") : 1500.0;
    });
    Drawn drawn(dem, test::scratch_dir("vsm_rim"));
    const Truth truth(dem, drawn.ground().frame);
    for (const double elevation : {1.0, 3.0, 30.0}) {
        for (const double azimuth : {0.0, 70.0, 135.0, 250.0}) {
            const Array2d<float> lit = drawn.at_posts(direction(azimuth, elevation), truth.posts());
            int shaded = 0;
            for (int y = 2; y < lit.height() - 2; ++y)
                for (int x = 2; x < lit.width() - 2; ++x)
                    shaded += lit.at(x, y) < 0.98f;
            EXPECT_EQ(shaded, 0) << elevation << " degrees from " << azimuth;
        }
    }
}

TEST(Vsm, TheRimOfALargeDemIsLit) {
    // 480 km of level ground: the round Earth has its rim 4500 m below its middle.
    const dem::Heightfield dem = field(
        97, 97, [](int, int) { return 500.0; }, -5000);
    Drawn drawn(dem, test::scratch_dir("vsm_large"));
    const Truth truth(dem, drawn.ground().frame);
    for (const double elevation : {20.0, 50.0}) {
        for (const double azimuth : {0.0, 100.0, 225.0}) {
            const Array2d<float> lit = drawn.at_posts(direction(azimuth, elevation), truth.posts());
            EXPECT_GT(*std::min_element(lit.begin(), lit.end()), 0.98f)
                << elevation << " degrees from " << azimuth;
        }
    }
}

TEST(Vsm, GroundOfThePicturesTrianglesAloneIsNotInItsOwnShadow) {
    // Normals per vertex leave no place for columns and rows, and so no way to the DEM's own
    // ground.
    const dem::Heightfield dem = jacksboro();
    Drawn drawn(dem, test::scratch_dir("vsm_vertex"), {"terrain.normal=vertex"}, 8);
    const Truth truth(dem, drawn.ground().frame);
    for (const double azimuth : {60.0, 200.0}) {
        const Array2d<float> lit = drawn.at_posts(direction(azimuth, 50), truth.posts());
        const auto shaded = std::count_if(lit.begin(), lit.end(), [](float l) { return l < 0.5f; });
        EXPECT_LT(static_cast<double>(shaded), 0.001 * static_cast<double>(lit.size()));
    }
}

TEST(Vsm, ShadowsAreTheSameWhicheverWayTheRowsRun) {
    // A pyramid 600 m high.
    const auto height_m = [](int x, int y) {
        return std::max(0.0, 600 - 20.0 * std::max(std::abs(x - 60), std::abs(y - 40)));
    };
    std::array<Array2d<float>, 2> lit;
    for (const double azimuth : {30.0, 160.0}) {
        for (const bool to_south : {true, false}) {
            const dem::Heightfield dem = field(121, 81, height_m, to_south ? -30 : 30);
            Drawn drawn(dem, test::scratch_dir("vsm_rows"));
            lit[to_south] =
                drawn.at_posts(direction(azimuth, 10), Truth(dem, drawn.ground().frame).posts());
        }
        int shaded = 0, different = 0;
        for (int y = 0; y < 81; ++y) {
            for (int x = 0; x < 121; ++x) {
                const bool here = lit[1].at(x, y) < 0.5f;
                shaded += here;
                different += here != (lit[0].at(x, 80 - y) < 0.5f);
            }
        }
        EXPECT_GT(shaded, 1000);
        // Quads are cut along the other diagonal.
        EXPECT_LT(different, 0.03 * shaded) << azimuth;
    }
}

// ---- the penumbra

/// Share of the sun's disc above a level edge.
/// @param above  of the disc's centre over the edge, in its radii
double share_of_disc(double above) {
    const double x = std::clamp(above, -1.0, 1.0);
    return 0.5 + (std::asin(x) + x * std::sqrt(1 - x * x)) / kPi;
}

TEST(Vsm, ThePenumbraIsAsWideAsTheSunMakesIt) {
    // A wall 600 m high along a column of level ground, posts 10 m apart.
    constexpr int kColumns = 480, kRows = 60, kWall = 430;
    constexpr double kHeight_m = 600, kPost_m = 10;
    const double radius = radians(0.533) / 2;
    const dem::Heightfield dem = field(
        kColumns, kRows, [](int x, int) { return x == kWall ? kHeight_m : 0.0; }, -kPost_m);
    for (const bool penumbra : {true, false}) {
        Drawn drawn(dem, test::scratch_dir("vsm_penumbra"),
                    {fmt::format("vsm.penumbra={}", penumbra)});
        const Truth truth(dem, drawn.ground().frame);
        for (const double elevation : {10.0, 16.0, 25.0}) {
            const Array2d<float> lit = drawn.at_posts(direction(90, elevation), truth.posts());
            // Distance from the wall where a share of the light is reached.
            const auto reaches = [&](double share, const auto& light) {
                for (int x = kWall - 2; x > 1; --x) {
                    const double here = light(x), next = light(x - 1);
                    if (here < share && next >= share)
                        return kPost_m * (kWall - x + (share - here) / (next - here));
                }
                return 0.0;
            };
            const auto drawn_light = [&](int x) {
                double sum = 0;
                for (int y = 15; y < 45; ++y)
                    sum += lit.at(x, y);
                return sum / 30;
            };
            const auto true_light = [&](int x) {
                const double edge = std::atan2(kHeight_m, kPost_m * (kWall - x));
                return share_of_disc((radians(elevation) - edge) / radius);
            };
            const double width = reaches(0.8, drawn_light) - reaches(0.2, drawn_light);
            const double expected = reaches(0.8, true_light) - reaches(0.2, true_light);
            const double middle = reaches(0.5, drawn_light) - reaches(0.5, true_light);
            fmt::print(
                "[ shadow ] sun at {} degrees, penumbra {}: {:.1f} m from a fifth to four fifths "
                "of the light where {:.1f} m are true, its middle off by {:.1f} m\n",
                elevation, penumbra ? "on" : "off", width, expected, middle);
            EXPECT_LT(std::abs(middle), 5);
            if (penumbra)
                EXPECT_NEAR(width, expected, 0.12 * expected);
            else
                EXPECT_LT(width, 0.5 * expected);
        }
    }
}

// ---- nearer maps

TEST(Vsm, NearerMapsResolveWhatIsNearAndMeetTheFirst) {
    // 16 x 12 km of hills and hummocks at posts 10 m apart, seen low from beside its south end.
    const dem::Heightfield dem = field(
        1200, 1600,
        [](int x, int y) {
            return 24 * std::sin(0.27 * x + 0.04 * y) * std::cos(0.21 * y) +
                   6 * std::sin(1.1 * x - 0.3 * y) * std::sin(0.9 * y + 0.2 * x);
        },
        -40);
    const glm::dvec3 to_sun = direction(110, 5);
    constexpr double kBand = 0.05;  // on either side of a nearer map's rim, of its sides
    Array2d<Drawn::Place> places(dem.grid.columns(), dem.grid.rows());
    std::array<double, 2> right{};  // of what is in a nearer map: with it, without
    for (const int maps : {3, 1}) {
        Drawn drawn(dem, test::scratch_dir("vsm_near"),
                    {"vsm.size=1024", fmt::format("vsm.maps={}", maps)}, 0.5, {450, 300});
        const Truth truth(dem, drawn.ground().frame);
        const Truth::Mask mask = truth.cast(to_sun);
        std::vector<glm::dvec3> points;
        for (const glm::ivec2 at : {glm::ivec2(520, 1440), {680, 1440}, {520, 1560}, {680, 1560}})
            points.push_back(truth.posts().at(at.x, at.y));
        drawn.inputs().camera = scene::orbit_camera({180, 18, 1}, points, radians(40), 1.5);
        const Array2d<float> lit = drawn.at_posts(to_sun, truth.posts());
        std::int64_t near = 0, near_right = 0;
        std::array<double, 2> off{}, count{};  // outside and inside, beside the rim
        for (int y = 0; y < lit.height(); ++y) {
            for (int x = 0; x < lit.width(); ++x) {
                if (maps == 3) places.at(x, y) = drawn.place(truth.posts().at(x, y));
                if (!mask.facing.at(x, y) || drawn.spread().at(x, y) > 1.5f) continue;
                const Drawn::Place& place = places.at(x, y);
                const double light = lit.at(x, y), error = light - (1 - mask.shaded.at(x, y));
                // Farther away hills hide posts behind them.
                const double away_m = length(truth.posts().at(x, y) - drawn.inputs().camera.eye_m);
                if (place.map > 0 && away_m < 9000) {
                    ++near;
                    near_right += std::abs(error) <= 0.5;
                }
                if (std::abs(place.inside) < kBand) {
                    off[place.inside > 0] += error;
                    ++count[place.inside > 0];
                }
            }
        }
        right[maps == 1] = static_cast<double>(near_right) / static_cast<double>(near);
        fmt::print(
            "[ shadow ] {} maps at most: {:.2f} % of {} posts right in the nearer one; light "
            "too much by {:.4f} within it and {:.4f} without, on {} and {} posts beside its rim\n",
            maps, 100 * right[maps == 1], near, off[1] / count[1], off[0] / count[0], count[1],
            count[0]);
        EXPECT_GT(near, 10000);
        if (maps == 1) continue;
        EXPECT_GT(std::min(count[0], count[1]), 500);
        EXPECT_LT(std::abs(off[1] / count[1] - off[0] / count[0]), 0.04);
    }
    EXPECT_GE(right[0], 0.95);
    EXPECT_GE(right[0], right[1] + 0.02);
}

// ---- while the camera moves

TEST(Vsm, MapsAreDrawnOnceForASunAndForAViewThatHardlyMoves) {
    const dem::Heightfield dem = jacksboro();
    Drawn drawn(dem, test::scratch_dir("vsm_kept"), {}, 4, {320, 256});
    const auto points = render::points_to_show(dem, drawn.ground(), 1);
    int maps = 0;
    log::set_sink([&](log::Level, std::string_view text) {
        maps += text.find("vsm: map") != std::string_view::npos;
    });
    const log::Level before = log::level();
    log::set_level(log::Level::Debug);
    for (const glm::dvec2& sun : {glm::dvec2(3, 290), {7, 66}, {18, 74}, {40, 200}, {77, 172}}) {
        maps = 0;
        for (const double turn_deg : {0.0, 0.0, 0.2, 0.4}) {
            drawn.inputs().camera =
                scene::orbit_camera({225 + turn_deg, 25, 1}, points, radians(40), 1.25);
            drawn.picture(direction(sun.y, sun.x));
        }
        EXPECT_EQ(maps, 1) << sun.x << " degrees from " << sun.y;
    }
    log::set_level(before);
    log::set_sink({});
}

TEST(Vsm, ShadowsFarAwayAreThoseOfAFinerPicture) {
    const dem::Heightfield dem = jacksboro();
    constexpr int kFiner = 4;
    const glm::ivec2 size(640, 512);
    const auto picture = [&](int finer, double turn_deg) {
        Drawn drawn(dem, test::scratch_dir("vsm_far"), {}, 2, finer * size);
        drawn.inputs().camera =
            scene::orbit_camera({200 + turn_deg, 8, 1},
                                render::points_to_show(dem, drawn.ground(), 1), radians(40), 1.25);
        return drawn.picture(direction(110, 8));
    };
    const Array2d<float> once = picture(1, 0), finer = picture(kFiner, 0),
                         turned = picture(1, 0.02);
    double squares = 0;
    int count = 0, flipped = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            double mean = 0;
            for (int j = 0; j < kFiner; ++j)
                for (int i = 0; i < kFiner; ++i)
                    mean += finer.at(kFiner * x + i, kFiner * y + j) / (kFiner * kFiner);
            const double off = once.at(x, y) - mean;
            if (std::isnan(off)) continue;
            squares += off * off;
            ++count;
            flipped += std::abs(once.at(x, y) - turned.at(x, y)) > 0.5;
        }
    }
    const double rms = std::sqrt(squares / count);
    fmt::print(
        "[ shadow ] light of a pixel off by {:.4f} root mean square from that of its {} parts; "
        "turned by 0.02 degrees, {:.3f} % of pixels change by more than half\n",
        rms, kFiner * kFiner, 100.0 * flipped / count);
    EXPECT_LT(rms, 0.08);
    EXPECT_LT(flipped, 0.001 * count);
}

TEST(Vsm, ASlowMoveOfTheCameraChangesNoShadow) {
    const dem::Heightfield dem = jacksboro();
    Drawn drawn(dem, test::scratch_dir("vsm_move"), {"vsm.keep=false"});
    const Truth truth(dem, drawn.ground().frame);
    const glm::dvec3 to_sun = direction(110, 8);
    const auto points = render::points_to_show(dem, drawn.ground(), 1);
    Array2d<float> before, before_spread;
    std::int64_t compared = 0, changed = 0, shaded = 0;
    float worst = 0;
    for (int frame = 0; frame < 6; ++frame) {
        drawn.inputs().camera =
            scene::orbit_camera({200 + 0.4 * frame, 65, 2.5 + 0.02 * frame}, points, radians(40),
                                double(drawn.size().x) / drawn.size().y);
        const Array2d<float> now = drawn.at_posts(to_sun, truth.posts());
        const Array2d<float> spread = drawn.spread();
        for (int y = 0; frame > 0 && y < now.height(); ++y) {
            for (int x = 0; x < now.width(); ++x) {
                // Where light changes from pixel to pixel, a moved pixel sees other ground.
                if (spread.at(x, y) > 0.005f || before_spread.at(x, y) > 0.005f) continue;
                ++compared;
                shaded += now.at(x, y) < 0.5f;
                const float change = std::abs(now.at(x, y) - before.at(x, y));
                changed += change > 1 / 255.0f;
                worst = std::max(worst, change);
            }
        }
        before = now;
        before_spread = spread;
    }
    fmt::print(
        "[ shadow ] {} points compared from frame to frame, {} in shadow: {} changed by "
        "more than 1/255, the worst by {:.1f}/255\n",
        compared, shaded, changed, 255 * worst);
    EXPECT_GT(shaded, 10000);
    EXPECT_LE(static_cast<double>(changed), 0.0002 * static_cast<double>(compared));
    EXPECT_LE(worst, 3 / 255.0f);
}

}  // namespace
}  // namespace relevo::shadow::test_vsm

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/support.h"
#include "web/container.h"
#include "web/height_planes.h"

namespace relevo::web {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// A container of 3 columns and 2 rows.
class Container : public testing::Test {
  protected:
    Container() {
        height_m_ = Array2d<float>(3, 2);
        std::ranges::copy(std::array{100.0F, 101.0F, 400.0F, 99.0F, kHole, 250.5F},
                          height_m_.begin());
    }

    std::string text(const std::string& name = "Alp") const {
        const Heights heights = in_steps(height_m_, 0.1);
        const nlohmann::ordered_json about = {
            {"title", name},
            {"size", {3, 2}},
            {"height", {{"min", heights.min_m}, {"step", heights.step_m}}}};
        const std::vector<std::byte> colour(5, std::byte{7});
        const auto file =
            container(about.dump(), std::array{deflated("heights", planes_of(heights.value)),
                                               as_is("colour", "jpeg", colour)});
        return {reinterpret_cast<const char*>(file.data()), file.size()};
    }

    /// What examples/read_web.py says of a file.
    std::string read(const std::string& file) const {
        const auto path = dir_ / "data.rlvw";
        std::ofstream(path, std::ios::binary) << file;
        const std::string command =
            fmt::format("{} {} {} 2>&1", RELEVO_PYTHON,
                        (test::source_dir() / "examples/read_web.py").string(), path.string());
        std::string said;
        FILE* const pipe = popen(command.c_str(), "r");
        for (std::array<char, 256> some{}; std::fgets(some.data(), some.size(), pipe);)
            said += some.data();
        pclose(pipe);
        return said;
    }

    Array2d<float> height_m_;
    std::filesystem::path dir_ = test::scratch_dir("web_container");
};

TEST_F(Container, HeightsComeBackInRowsAndColumnsWithVoids) {
    EXPECT_EQ(read(text()), "Alp [[100.0, 101.0, 400.0], [99.0, nan, 250.5]]\n");
}

TEST_F(Container, ALargeReliefGetsLongerSteps) {
    Array2d<float> height_m(2, 1);
    height_m.at(0, 0) = -100;
    height_m.at(1, 0) = 8900;
    const Heights heights = in_steps(height_m, 0.1);
    EXPECT_EQ(heights.value.at(1, 0), 65534);
    EXPECT_NEAR(heights.min_m + heights.step_m * 65534, 8900, 1e-9);
}

TEST_F(Container, VoidsAloneHaveNoHeight) {
    const Heights heights = in_steps(Array2d<float>(2, 1, kHole), 0.1);
    EXPECT_TRUE(heights.value == Array2d<std::uint16_t>(2, 1, kVoid));
    EXPECT_EQ(heights.step_m, 1);
}

TEST_F(Container, NamesCannotEndAScript) {
    const std::string name = "</script><b>&\"";
    const std::string file = text(name);
    EXPECT_THAT(file.substr(0, file.find("\"blocks\"")), Not(HasSubstr("<")));
    EXPECT_THAT(read(file), HasSubstr(name));
}

TEST_F(Container, JsonEndsAtAMultipleOfEightBytes) {
    for (const char* name : {"a", "ab", "abc", "abcdefgh"}) {
        const std::string file = text(name);
        EXPECT_EQ(static_cast<unsigned char>(file[8]) % 8, 0) << name;
    }
}

TEST_F(Container, ReadersNameWhatIsWrong) {
    const std::string good = text();
    const std::size_t blocks = good.size() - 5;
    std::string bad = good;
    bad[0] = 'X';
    EXPECT_THAT(read(bad), HasSubstr("not the data of a web page"));
    bad = good;
    bad[4] = 2;
    EXPECT_THAT(read(bad), HasSubstr("version 2, expected 1"));
    bad = good;
    bad[blocks] = 8;
    EXPECT_THAT(read(bad), HasSubstr("block colour: wrong checksum"));
    bad = good;
    bad[blocks - 1] = static_cast<char>(bad[blocks - 1] + 1);
    EXPECT_THAT(read(bad), HasSubstr("block heights: wrong checksum"));
    EXPECT_THAT(read(good.substr(0, good.size() - 1)), HasSubstr("block colour: ends at byte"));
    EXPECT_THAT(read(good.substr(0, 40)), HasSubstr("cut short in the JSON"));
    EXPECT_THAT(read(good.substr(0, 9)), HasSubstr("cut short in the header"));
}

TEST_F(Container, ReadersRefuseBlocksOfAnotherSize) {
    std::string bad = text();
    bad.replace(bad.find("\"size\":12"), 9, "\"size\":11");
    EXPECT_THAT(read(bad), HasSubstr("block heights: does not have its 11 bytes"));
}

}  // namespace
}  // namespace relevo::web

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/base64.h"
#include "base/error.h"
#include "support/support.h"
#include "web/page.h"
#include "web/page_ground.h"
#include "web/site.h"

namespace relevo::web {
namespace {

using nlohmann::json;
using testing::HasSubstr;

dem::Grid utm(int columns, int rows, double step_m) {
    return {columns,
            rows,
            {500000, step_m, 0, 5200000, 0, -step_m},
            geo::Crs::parse("EPSG:32632", "test")};
}

TEST(Base64, IsThatOfRfc4648) {
    const auto of = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("foob"), "Zm9vYg==");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    const std::string text = of(std::string(7'000'000, 'a'));  // in several pieces
    EXPECT_EQ(text.size(), 9'333'336U);
    EXPECT_EQ(text.find('='), text.size() - 2);
}

TEST(WebSite, PlacesAreThoseOfTheGrid) {
    const dem::Grid grid = utm(101, 51, 100);
    const json net = json::parse(grid_json(grid));
    ASSERT_EQ(net["lat"].size(), 81U);
    const geo::Geodetic last = grid.place(100, 50);
    EXPECT_NEAR(net["lat"][80].get<double>(), last.lat_rad * 180 / M_PI, 1e-9);
    EXPECT_NEAR(net["lon"][80].get<double>(), last.lon_rad * 180 / M_PI, 1e-9);
    // East of a zone's middle meridian its grid north is east of true north: by longitude times
    // sine of latitude.
    EXPECT_NEAR(net["convergence"][0].get<double>(), 0, 1e-6);
    EXPECT_NEAR(net["convergence"][80].get<double>(), 0.0959, 1e-3);
    for (const auto& scale : net["scale_x"])
        EXPECT_NEAR(scale.get<double>(), 1, 1e-4);
}

TEST(WebSite, ClocksChangeAsTheZoneSays) {
    const json zone = json::parse(zone_json(sun::Zone::named("Europe/Zurich")));
    const auto& changes = zone["transitions"];
    EXPECT_EQ(changes.front(), (json{0, 3600}));
    EXPECT_NE(std::find(changes.begin(), changes.end(), json({1774746000, 7200})), changes.end())
        << "2026-03-29 01:00 UTC";
    EXPECT_GT(changes.back()[0].get<double>(), 4.1e9);
    EXPECT_EQ(json::parse(zone_json(sun::Zone::fixed(-1800)))["transitions"],
              (json{json{0, -1800}}));
}

TEST(WebSite, RefractionIsLinearBetweenItsEntries) {
    const auto air = sun::Refraction::standard({0.8, 0.1, 500});
    const json table = json::parse(refraction_json(air));
    double worst_deg = 0;
    for (std::size_t i = 0; i + 1 < table["elevation"].size(); ++i) {
        const double a = table["elevation"][i], b = table["elevation"][i + 1];
        const double p = table["lift"][i], q = table["lift"][i + 1], middle = (a + b) / 2;
        const double lift = air.apparent_rad(middle * M_PI / 180) * 180 / M_PI - middle;
        if (middle > -0.5) worst_deg = std::max(worst_deg, std::abs((p + q) / 2 - lift));
    }
    EXPECT_LT(worst_deg, 0.002);
}

TEST(WebPageText, HasNothingOfItsTitleButText) {
    const std::string text = page("</title>{{data}}&", std::span<const std::byte>());
    EXPECT_THAT(text, HasSubstr("<title>&#60;/title>{{data}}&#38;</title>"));
    EXPECT_THAT(text, HasSubstr("connect-src 'none'"));
    EXPECT_THAT(text, Not(HasSubstr("unsafe")));
    const auto bytes = static_cast<double>(page("", std::array<std::byte, 300>{}).size());
    EXPECT_NEAR(room_for_data(bytes), 300, 1e-6);
}

TEST(WebPageGround, RefusesWhatNoPageCanShow) {
    const auto message = [](const dem::Grid& grid) {
        return test::error_of([&] { check_grid(grid); });
    };
    EXPECT_NO_THROW(check_grid(utm(1000, 1000, 100)));
    EXPECT_THAT(message(utm(4000, 10, 100)),
                HasSubstr("the DEM is 400 km long, expected at most 300 km"));
    const dem::Grid turned(10, 10, {500000, 90, 10, 5200000, 10, -90},
                           geo::Crs::parse("EPSG:32632", "test"));
    EXPECT_THAT(message(turned), HasSubstr("turned against its CRS"));
}

}  // namespace
}  // namespace relevo::web

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/support.h"
#include "weather/cover_band.h"

namespace relevo::weather {
namespace {

using Metadata = std::map<std::string, std::string>;

/// As GDAL 3.6 has a band of NCEP's GFS.
Metadata grib(const std::string& element, const std::string& level) {
    return {{"GRIB_DISCIPLINE", "0(Meteorological)"},
            {"GRIB_ELEMENT", element},
            {"GRIB_PDS_PDTN", "0"},
            {"GRIB_SHORT_NAME", level},
            {"GRIB_UNIT", "[%]"},
            {"GRIB_VALID_TIME", "1780315200"}};
}

/// As GDAL has a variable of three dimensions.
Metadata netcdf(const std::string& variable) {
    return {{"NETCDF_VARNAME", variable},
            {"NETCDF_DIM_EXTRA", "{time}"},
            {"NETCDF_DIM_time", "1108140"},
            {"NETCDF_DIM_time_DEF", "{2,6}"},
            {"NETCDF_DIM_time_VALUES", "{1108140,1108143}"},
            {"time#units", "hours since 1900-01-01 00:00:00.0"},
            {"time#calendar", "gregorian"}};
}

TEST(CoverBand, OfGribIsKnownByItsElement) {
    const auto low = cover_band(grib("LCDC", "0-LCY"), "[%]");
    ASSERT_TRUE(low);
    EXPECT_EQ(low->level, CloudLevel::Low);
    EXPECT_EQ(low->unix_s, 1780315200);  // 2026-06-01 12:00 UTC
    EXPECT_EQ(low->to_share, 0.01);
    EXPECT_FALSE(low->is_mean);
    EXPECT_EQ(cover_band(grib("MCDC", "0-MCY"), "[%]")->level, CloudLevel::Middle);
    EXPECT_EQ(cover_band(grib("HCDC", "0-HCY"), "[%]")->level, CloudLevel::High);
    EXPECT_EQ(cover_band(grib("TCDC", "0-EATM"), "[%]")->level, CloudLevel::Total);
    EXPECT_FALSE(cover_band(grib("TMP", "0-SFC"), "[C]"));
    // Clouds at a pressure are no cover of the sky.
    EXPECT_FALSE(cover_band(grib("TCDC", "85000-ISBL"), "[%]"));
    EXPECT_FALSE(cover_band(grib("TCDC", "0-BCY"), "[%]"));
}

TEST(CoverBand, OfEcmwfsGribIsAShare) {
    Metadata about = grib("LCC", "0-SFC");
    about["GRIB_UNIT"] = "[(0 - 1)]";
    about["GRIB_VALID_TIME"] = "  1780315200 sec UTC";
    const auto low = cover_band(about, "");
    ASSERT_TRUE(low);
    EXPECT_EQ(low->to_share, 1);
    EXPECT_EQ(low->unix_s, 1780315200);
}

TEST(CoverBand, OfGribMayBeAMeanOrHaveNoTime) {
    Metadata about = grib("TCDC", "0-EATM");
    about["GRIB_PDS_PDTN"] = "8";
    about.erase("GRIB_VALID_TIME");
    const auto mean = cover_band(about, "");
    ASSERT_TRUE(mean);
    EXPECT_TRUE(mean->is_mean);
    EXPECT_FALSE(mean->unix_s);
}

TEST(CoverBand, OfNetcdfIsKnownByItsStandardNameOrVariable) {
    const auto low = cover_band(netcdf("lcc"), "(0 - 1)");
    ASSERT_TRUE(low);
    EXPECT_EQ(low->level, CloudLevel::Low);
    EXPECT_EQ(low->unix_s, 1780315200);  // 1108140 h after 1900
    EXPECT_EQ(low->to_share, 1);
    Metadata named = netcdf("CLDTOT");
    EXPECT_FALSE(cover_band(named, "%"));
    named["standard_name"] = "cloud_area_fraction";
    EXPECT_EQ(cover_band(named, "%")->level, CloudLevel::Total);
    named["standard_name"] = "medium_type_cloud_area_fraction";
    EXPECT_EQ(cover_band(named, "1")->level, CloudLevel::Middle);
    // On heights it is no cover of the sky.
    named["NETCDF_DIM_level"] = "850";
    named["level#positive"] = "down";
    EXPECT_FALSE(cover_band(named, "1"));
}

TEST(CoverBand, TimesCountInUnitsSinceADay) {
    for (const auto& [value, units] : {std::pair("1780315200", "seconds since 1970-01-01"),
                                       std::pair("29671920", "minutes since 1970-01-01T00:00:00Z"),
                                       std::pair("46172.5", "days since 1900-01-01 00:00")}) {
        Metadata about = netcdf("tcc");
        about["NETCDF_DIM_time"] = value;
        about["time#units"] = units;
        EXPECT_EQ(cover_band(about, "1")->unix_s, 1780315200) << units;
    }
}

TEST(CoverBand, WhatIsNotUnderstoodIsAnError) {
    const auto fault = [](const Metadata& about, const std::string& unit) {
        return test::error_of([&] { cover_band(about, unit); });
    };
    EXPECT_EQ(fault(netcdf("tcc"), "okta"), "exit 3: cloud cover in \"okta\", expected % or 1");
    Metadata about = netcdf("tcc");
    about["time#calendar"] = "noleap";
    EXPECT_EQ(fault(about, "1"),
              "exit 3: times of the calendar \"noleap\", expected the standard one");
    about = netcdf("tcc");
    about["time#units"] = "fortnights since 1900-01-01";
    EXPECT_EQ(fault(about, "1"),
              "exit 3: times in \"fortnights since 1900-01-01\", expected as in \"hours since "
              "1970-01-01\"");
    about["time#units"] = "hours since the flood";
    EXPECT_NE(fault(about, "1").find("hours since the flood"), std::string::npos);
}

TEST(CoverBand, TimesBetweenAreLinear) {
    const std::vector<std::int64_t> times = {0, 3600, 10800};
    const auto middle = between(times, 5400);
    ASSERT_TRUE(middle);
    EXPECT_EQ(middle->before, 1U);
    EXPECT_EQ(middle->after, 2U);
    EXPECT_DOUBLE_EQ(middle->share_of_after, 0.25);
    EXPECT_EQ(between(times, 3600)->before, 1U);
    EXPECT_EQ(between(times, 3600)->after, 1U);
    EXPECT_EQ(between(times, 10800)->before, 2U);
}

TEST(CoverBand, TimesReachHalfAStepBeyondTheirEnds) {
    const std::vector<std::int64_t> times = {0, 3600, 10800};
    EXPECT_EQ(between(times, -1800)->after, 0U);
    EXPECT_FALSE(between(times, -1801));
    EXPECT_EQ(between(times, 14400)->before, 2U);
    EXPECT_FALSE(between(times, 14401));
    const std::vector<std::int64_t> single = {7200};
    EXPECT_TRUE(between(single, 3600));
    EXPECT_TRUE(between(single, 10800));
    EXPECT_FALSE(between(single, 3599));
    EXPECT_FALSE(between(single, 10801));
    EXPECT_EQ(utc_text(1780315200), "2026-06-01 12:00 UTC");
    EXPECT_EQ(utc_text(-60), "1969-12-31 23:59 UTC");
}

}  // namespace
}  // namespace relevo::weather

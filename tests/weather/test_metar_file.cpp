#include <fstream>

#include "support/support.h"
#include "weather/metar.h"

namespace relevo::weather {
namespace {

using test::error_of;

class MetarFile : public testing::Test {
  protected:
    std::string file(const std::string& text) {
        const std::filesystem::path path = folder_ / "report.txt";
        std::ofstream(path) << text;
        return path.string();
    }
    std::filesystem::path folder_ = test::scratch_dir();
};

TEST_F(MetarFile, OfNoaaHasADateAndAReport) {
    EXPECT_EQ(report_of(file("2026/06/01 11:50\nLSZB 011150Z 24009KT 9999 FEW015 17/13 Q1014\n")),
              "LSZB 011150Z 24009KT 9999 FEW015 17/13 Q1014");
}

TEST_F(MetarFile, OfAnArchiveHasADateBeforeEachReport) {
    EXPECT_EQ(parse_metar(report_of(file("202401051220 METAR LSZB 051220Z 9999 17/13 Q1013=\n"
                                         "202401051250 METAR LSZB 051250Z 9999 17/13 Q1014=\n")))
                  .minute,
              50);
}

TEST_F(MetarFile, GivesTheLastReportThatCanBeRead) {
    EXPECT_EQ(report_of(file("LSZB 011120Z 24009KT 9999 17/13 Q1014\n"
                             "LSZB 011150Z 24009KT 9999\n     BKN040 17/13 Q1013=\n"
                             "LSZB 011220Z NONSENSE\n")),
              "LSZB 011150Z 24009KT 9999 BKN040 17/13 Q1013=");
}

TEST_F(MetarFile, WithoutAReportIsAnError) {
    const std::string empty = file("2026/06/01 11:50\n\n");
    EXPECT_EQ(error_of([&] { report_of(empty); }),
              "exit 3: weather: " + empty + ": expected a METAR but found none");
    const std::string wrong = file("LSZB 011150Z BKNX40\n");
    EXPECT_EQ(error_of([&] { report_of(wrong); }),
              "exit 3: weather: METAR: it is no group of a METAR that has a "
              "meaning here; "
              "in " +
                  wrong);
}

TEST_F(MetarFile, ReportsAreToldFromNamesOfFiles) {
    EXPECT_TRUE(is_report("LSZB 011150Z 24009KT"));
    EXPECT_TRUE(is_report("METAR LSZB 011150Z"));
    EXPECT_FALSE(is_report("bern.txt"));
    EXPECT_FALSE(is_report("my weather.txt"));
    EXPECT_EQ(error_of([] { report_of("no/such/file.txt"); }).substr(0, 34),
              "exit 3: weather: no/such/file.txt:");
}

}  // namespace
}  // namespace relevo::weather

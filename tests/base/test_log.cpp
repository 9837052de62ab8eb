#include "base/log.h"
#include "support/support.h"

namespace relevo {
namespace {

std::string written(const std::string& message) {
    testing::internal::CaptureStderr();
    log::error(message);
    return testing::internal::GetCapturedStderr();
}

TEST(Log, LeavesMessagesAsTheyAre) {
    EXPECT_EQ(written("a: M\xc3\xbcnsingen {} %v\n  0: device\n\t1: caf\xc3\xa9"),
              "relevo: error: a: M\xc3\xbcnsingen {} %v\n  0: device\n\t1: caf\xc3\xa9\n");
}

TEST(Log, NoNameEndsAMessageAndBeginsAnother) {
    EXPECT_EQ(written("dem::load: a.tif\nrelevo: error: b.tif: gone"),
              "relevo: error: dem::load: a.tif\\nrelevo: error: b.tif: gone\n");
    EXPECT_EQ(written("a\r\x1b[2Krelevo: b\x07\xc2\x9b\xff\x7f"),
              "relevo: error: a\\r\\x1b[2Krelevo: b\\x07\\xc2\\x9b\\xff\\x7f\n");
}

}  // namespace
}  // namespace relevo

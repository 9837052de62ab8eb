#include <string>

#include "base/held_notices.h"
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
    EXPECT_EQ(written("a.tif\nrelevo: error: b.tif: gone"),
              "relevo: error: a.tif\\nrelevo: error: b.tif: gone\n");
    EXPECT_EQ(written("a\r\x1b[2Krelevo: b\x07\xc2\x9b\xff\x7f"),
              "relevo: error: a\\r\\x1b[2Krelevo: b\\x07\\xc2\\x9b\\xff\\x7f\n");
}

TEST(Log, WarningsAndNoticesAreOneLine) {
    testing::internal::CaptureStderr();
    log::warning("a\nb.tif: no unit");
    log::info("a\tb\nc");
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "relevo: warning: a\\nb.tif: no unit\nrelevo: a\\tb\\nc\n");
}

TEST(Log, WhatIsTooLongToReadLosesItsMiddle) {
    const std::string longest = "a" + std::string(3998, '9') + "z";
    EXPECT_EQ(written(longest), "relevo: error: " + longest + "\n");
    // Letters of two bytes are not cut in two, wherever the cuts fall; other lines stay.
    for (const char* first : {"", "x"}) {
        std::string value;
        for (int i = 0; i < 50'000; ++i)
            value += "\u00e9";
        const std::string text = written(std::string("--tz: ") + first + value + "; remedy\nnext");
        EXPECT_TRUE(text.starts_with(std::string("relevo: error: --tz: ") + first + "\u00e9"));
        EXPECT_NE(text.find("\u00e9 ... (98"), std::string::npos) << text;
        EXPECT_NE(text.find(" bytes) ... \u00e9"), std::string::npos) << text;
        EXPECT_TRUE(text.ends_with("\u00e9; remedy\nnext\n")) << text;
        EXPECT_LT(text.size(), 2100U);
    }
    EXPECT_EQ(written(""), "relevo: error: \n");
}

TEST(HeldNotices, AreOneLineAtTheEndOrAllOfThemAtOnceWithV) {
    const auto said = [](int notices) {
        testing::internal::CaptureStderr();
        {
            const log::HeldNotices held;
            for (int i = 1; i <= notices; ++i)
                log::info("notice " + std::to_string(i));
            log::warning("at once");
        }
        log::info("later");
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(said(0), "relevo: warning: at once\nrelevo: later\n");
    EXPECT_EQ(said(1), "relevo: warning: at once\nrelevo: notice 1\nrelevo: later\n");
    EXPECT_EQ(said(2),
              "relevo: warning: at once\nrelevo: notice 1; 1 more notice with -v\nrelevo: later\n");
    EXPECT_EQ(said(3),
              "relevo: warning: at once\nrelevo: notice 1; 2 more notices with -v\nrelevo: "
              "later\n");
    log::set_level(log::Level::Debug);
    EXPECT_EQ(said(2),
              "relevo: notice 1\nrelevo: notice 2\nrelevo: warning: at once\nrelevo: later\n");
    log::set_level(log::Level::Warning);
    EXPECT_EQ(said(2), "relevo: warning: at once\n");
    log::set_level(log::Level::Info);
}

}  // namespace
}  // namespace relevo

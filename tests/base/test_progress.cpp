#include "base/log.h"
#include "base/progress.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(Progress, TellsOfLongWorkAndNotOfShort) {
    std::vector<std::string> said;
    log::set_sink([&](log::Level, std::string_view text) { said.emplace_back(text); });
    Progress patient("alps.tif: reading", 4);
    patient.add(1);
    EXPECT_TRUE(said.empty());
    Progress at_once("alps.tif: reading", 4, 0);
    at_once.add(1);
    EXPECT_EQ(said, (std::vector<std::string>{"alps.tif: reading, 25 % after 0 s, some 0 s more"}));
    at_once.add(3);  // all of it
    EXPECT_EQ(said.size(), 1);
    log::set_sink({});
}

}  // namespace
}  // namespace relevo

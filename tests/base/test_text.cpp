#include "base/text.h"
#include "support/support.h"

namespace relevo {
namespace {

TEST(Text, SplitKeepsEmptyPieces) {
    EXPECT_EQ(split("a,,b", ','), (std::vector<std::string>{"a", "", "b"}));
    EXPECT_EQ(split("", ','), std::vector<std::string>{});
    EXPECT_EQ(split("a,", ','), (std::vector<std::string>{"a", ""}));
}

TEST(Text, NumbersFillTheWholeText) {
    EXPECT_EQ(parse_number("-33.9"), -33.9);
    EXPECT_EQ(parse_number("+1e3"), 1000.0);
    for (const char* text : {"", "1.5x", " 1", "nan", "inf", "1,5", "--1"})
        EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Text, NearestSuggestsOnlyCloseWords) {
    const std::vector<std::string> words{"haze", "sky", "layering"};
    EXPECT_EQ(nearest("hase", words), "haze");
    EXPECT_EQ(nearest("layerin", words), "layering");
    EXPECT_FALSE(nearest("vsm", words));
}

TEST(Text, ReadingAMissingFileNamesIt) {
    EXPECT_EQ(test::error_of([] { read_text("/nowhere/a.txt", "text"); }),
              "exit 3: text: /nowhere/a.txt: cannot be read, No such file or directory");
}

}  // namespace
}  // namespace relevo

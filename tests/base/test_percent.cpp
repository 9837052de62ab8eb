#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/percent.h"

namespace relevo {
namespace {

TEST(Percent, PathsOfUrisAreEncodedAndDecoded) {
    EXPECT_EQ(percent_encoded("a b/\xc3\xbc#1?%.tif"), "a%20b/%C3%BC%231%3F%25.tif");
    EXPECT_EQ(percent_encoded("r0001_c0002-x~.tif"), "r0001_c0002-x~.tif");
    std::string all;
    for (int i = 0; i < 256; ++i)
        all += static_cast<char>(i);
    EXPECT_EQ(percent_decoded(percent_encoded(all)), all);
    for (const auto& [text, expected] :
         std::vector<std::pair<std::string, std::string>>{{"a%20b", "a b"},
                                                          {"%c3%BC", "\xc3\xbc"},
                                                          {"100%", "100%"},
                                                          {"%2", "%2"},
                                                          {"%zz%41", "%zzA"}})
        EXPECT_EQ(percent_decoded(text), expected);
}

TEST(Percent, OfUrlsOnlyWhatTheyCannotHaveIsEncoded) {
    EXPECT_EQ(percent_encoded_url("https://a.org:80/x%20y/~b?key=1&z"),
              "https://a.org:80/x%20y/~b?key=1&z");
    EXPECT_EQ(percent_encoded_url("file:///my tiles/\xc3\xbc#1"), "file:///my%20tiles/%C3%BC%231");
}

TEST(Percent, FilesOfThisComputerHaveSeveralUris) {
    for (const char* uri : {"file:///data/a%20b", "file:/data/a%20b", "file://localhost/data/a%20b",
                            "FILE://LocalHost/data/a%20b"})
        EXPECT_EQ(path_of_file_uri(uri), "/data/a%20b") << uri;
    for (const char* other :
         {"file://server/data/a", "file://data/a", "file:a", "file:////server/a",
          "file://localhosts/a", "file:", "/data/a", "https://a.org/a", ""})
        EXPECT_EQ(path_of_file_uri(other), std::nullopt) << other;
}

}  // namespace
}  // namespace relevo

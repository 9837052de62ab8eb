// Texts of the window in another language: a catalogue that pseudo_language.py makes of the table.
#include <clocale>
#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>

#include "viewer/fonts.h"
#include "viewer/translation.h"
#include "window/viewer_fixture.h"

namespace relevo::test_translation {
namespace {

namespace fs = std::filesystem;
using viewer::tr;
using viewer::tr_format;
using viewer::tr_format_plural;
using viewer::tr_label;

/// Writes FOLDER/xx/LC_MESSAGES/relevo.mo.
/// @param option  "--lies": placeholders that do not fit
void make_catalogue(const fs::path& folder, const std::string& option = "") {
    const std::string command =
        fmt::format("python3 {0}/tests/window/pseudo_language.py {0}/locale/relevo.pot {1} {2}",
                    test::source_dir().string(), folder.string(), option);
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// The language of this process; English again at the end.
class Translation : public testing::Test {
  protected:
    static void use(const std::string& locale, const std::string& option = "") {
        const fs::path folder = test::scratch_dir("locale");
        make_catalogue(folder, option);
        setenv("LC_ALL", locale.c_str(), 1);
        setenv("LANGUAGE", "xx", 1);
        viewer::use_language(folder);
    }
    ~Translation() override {
        unsetenv("LC_ALL");
        unsetenv("LANGUAGE");
        viewer::use_language(test::scratch_dir("none"));
    }
};

TEST_F(Translation, TextsAreThoseOfTheCatalogue) {
    EXPECT_STREQ(tr("Open..."), "Open...");
    use("C.UTF-8");
    EXPECT_STREQ(tr("Open..."), "[Ôpéñ...~~]");
    EXPECT_STREQ(tr("not in the table"), "not in the table");
    EXPECT_STREQ(tr(""), "");  // its translation is the header of the catalogue
    EXPECT_EQ(tr_format("frame {} of {}", 3, 10), "[fràmé 3 ôf 10~~~]");
    EXPECT_THAT(tr_format_plural("no direct sun on {} day", "no direct sun on {} days", 1),
                testing::HasSubstr("1 dàý~"));
    EXPECT_THAT(tr_format_plural("no direct sun on {} day", "no direct sun on {} days", 5),
                testing::HasSubstr("5 dàýs~"));
}

TEST_F(Translation, LabelsKeepTheirIdentity) {
    EXPECT_STREQ(tr_label("File"), "File");
    use("C.UTF-8");
    EXPECT_STREQ(tr_label("File"), "[Fîlé~]###File");
}

TEST_F(Translation, TheLocaleOfTheProgramStays) {
    use("C.UTF-8");
    tr("Open...");
    for (const int category : {LC_MESSAGES, LC_NUMERIC, LC_CTYPE, LC_TIME})
        EXPECT_STREQ(std::setlocale(category, nullptr), "C");
    char number[8];
    std::snprintf(number, sizeof number, "%.1f", 1.5);
    EXPECT_STREQ(number, "1.5");
}

TEST_F(Translation, IsEnglishWithoutItsLocaleOrCatalogue) {
    use("C");
    EXPECT_STREQ(tr("Open..."), "Open...");
    use("missing_LOCALE.UTF-8");
    EXPECT_STREQ(tr("Open..."), "Open...");
    setenv("LC_ALL", "C.UTF-8", 1);
    viewer::use_language("/missing");
    EXPECT_STREQ(tr("Open..."), "Open...");
    EXPECT_EQ(tr_format_plural("no direct sun on {} day", "no direct sun on {} days", 1),
              "no direct sun on 1 day");
}

TEST_F(Translation, PlaceholdersThatDoNotFitLeaveTheTextInEnglish) {
    use("C.UTF-8", "--lies");
    EXPECT_THAT(tr("frame {} of {}"), testing::StartsWith("%s%n {} {5}"));
    EXPECT_EQ(tr_format("frame {} of {}", 3, 10), "frame 3 of 10");
    EXPECT_EQ(tr_format("no comparison: {}", "why"), "no comparison: why");
    EXPECT_EQ(tr_format_plural("no direct sun on {} day", "no direct sun on {} days", 5),
              "no direct sun on 5 days");
}

TEST_F(Translation, SlidersDoNotTakeTextsForFormats) {
    const std::string text = tr_format("opacity {} %", viewer::kSliderValue);
    EXPECT_EQ(viewer::slider_format(text, "%d"), "opacity %d %%");
    EXPECT_EQ(viewer::slider_format("%s%n", "%d"), "%%s%%n");
}

TEST_F(Translation, FontsLearnOfItsLettersOnce) {
    use("C.UTF-8");
    EXPECT_EQ(viewer::take_new_translations(), "");
    tr("Open...");
    tr("Open...");
    EXPECT_EQ(viewer::take_new_translations(), "[Ôpéñ...~~]");
    EXPECT_EQ(viewer::take_new_translations(), "");
}

class TranslatedWindow : public Viewer {
  protected:
    /// Has the program read a catalogue. @param option  as of make_catalogue()
    void use_catalogue(const std::string& option = "") {
        const fs::path share = folder_ / "share";
        fs::create_directories(share);
        for (const auto& entry : fs::directory_iterator(test::build_dir() / "share/relevo"))
            if (entry.path().filename() != "locale")
                fs::create_symlink(fs::canonical(entry.path()), share / entry.path().filename());
        make_catalogue(share / "locale", option);
        environment_ = {"RELEVO_SHARE=" + share.string(), "LC_ALL=C.UTF-8", "LANGUAGE=xx"};
    }
    /// Where the titles of the menus end [px].
    int menu_end_px() const {
        const image::Image8 screen = display_.screen();
        int end = 0;
        for (int y = 4; y < 18; ++y)
            for (int x = 0; x < screen.width; ++x)
                if (screen.row(y)[3 * x] > 150) end = std::max(end, x);
        return end;
    }
    /// Opens what the window has, one after the other.
    void visit_panels() {
        const std::vector<std::vector<std::string>> visits = {
            {"mousemove", "800", "420", "click", "1"},  // the point
            {"key", "m"},
            {"key", "m"},
            {"key", "h"},
            {"key", "Escape"},
            {"key", "ctrl+p"},
            {"key", "Escape"},
            {"key", "ctrl+f"},
            {"key", "Escape"},
            {"key", "o"},
            {"key", "f"},
            {"key", "f"},
            {"key", "ctrl+c"},
            {"mousemove", "30", "11", "click", "1"}};  // a menu
        for (const std::vector<std::string>& visit : visits) {
            act(visit);
            std::this_thread::sleep_for(std::chrono::milliseconds(400));
            ASSERT_TRUE(program_->is_running()) << program_->output();
        }
        ASSERT_TRUE(settles()) << program_->output();
    }
};

TEST_F(TranslatedWindow, ItsMenusAreLonger) {
    open({dem_, "--only"});
    const int english_px = menu_end_px();
    program_.reset();
    use_catalogue();
    open({dem_, "--only"});
    EXPECT_GT(menu_end_px(), 1.15 * english_px);
    visit_panels();
}

TEST_F(TranslatedWindow, GoesOnWithPlaceholdersThatDoNotFit) {
    use_catalogue("--lies");
    open({dem_, "--only"});
    visit_panels();
}

TEST_F(TranslatedWindow, ItsScenesAreThoseOfTheEnglishOne) {
    open({dem_, "--only", "--time", "2026-06-21T14:00:00Z"});
    const nlohmann::json english = scene();
    program_.reset();
    use_catalogue();
    open({dem_, "--only", "--time", "2026-06-21T14:00:00Z"});
    EXPECT_EQ(scene(), english);
}

}  // namespace
}  // namespace relevo::test_translation

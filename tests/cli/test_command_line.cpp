#include <functional>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/command_line.h"
#include "support/support.h"

namespace relevo::test::test_command_line {
namespace {

/// What the program says of a line, without running a verb: lines of tests do not come so far.
std::string said_of(const std::vector<std::string>& words) {
    CLI::App app{"", "relevo"};
    cli::add_verbs(app);
    return error_of([&] { cli::parse(app, words); });
}

struct OptionOfVerb {
    std::vector<std::string> words;  ///< that name the verb, and positional ones before it
    std::string name;                ///< "--unit"; "DEM" of a positional one
    bool is_positional = false, may_be_empty = false;
};

void add_options(const CLI::App& verb, std::vector<std::string> words,
                 std::vector<OptionOfVerb>& options) {
    for (const CLI::Option* option : verb.get_options())
        if (option->get_items_expected_max() > 0 && !option->get_positional())
            options.push_back(
                {words, option->get_name(), false, option->get_items_expected_min() == 0});
    std::vector<std::string> before = words;
    for (const CLI::Option* option : verb.get_options())
        if (option->get_positional()) {
            options.push_back({before, option->get_name(true), true, false});
            before.emplace_back("x");
        }
    for (const CLI::App* inner : verb.get_subcommands({})) {
        std::vector<std::string> inner_words = words;
        inner_words.push_back(inner->get_name());
        add_options(*inner, inner_words, options);
    }
}

// What `--unit "$UNIT"` is where nobody has set UNIT.
TEST(CommandLine, NoOptionOfAnyVerbTakesAnEmptyValue) {
    // One tree of verbs for all lines: to make it takes a hundred times as long as to read a line.
    CLI::App app{"", "relevo"};
    cli::add_verbs(app);
    std::vector<OptionOfVerb> options;
    add_options(app, {}, options);
    const auto said_of_words = [&](const std::vector<std::string>& words) {
        return error_of([&] { cli::parse(app, words); });
    };
    EXPECT_GT(options.size(), 300U);
    std::vector<std::string> exceptions;
    for (const OptionOfVerb& option : options) {
        std::string command = "relevo";
        for (const std::string& word : option.words)
            if (word != "x") command += " " + word;
        if (option.may_be_empty) {
            exceptions.push_back(command + " " + option.name);
            continue;
        }
        const std::string said = fmt::format(
            "exit 2: {}: expected a value but got \"\"; is a shell variable unset? See {} --help",
            option.name, command);
        for (const char* blank : {"", " "}) {
            std::vector<std::string> words = option.words;
            if (!option.is_positional) words.push_back(option.name);
            words.emplace_back(blank);
            EXPECT_EQ(said_of_words(words), said);
        }
        if (option.is_positional || !option.name.starts_with("--")) continue;
        std::vector<std::string> words = option.words;
        words.push_back(option.name + "=");
        words.emplace_back("next");
        EXPECT_EQ(said_of_words(words), said);
    }
    // --only '' is core alone (docs/cli.md): a list, and the empty one is a choice.
    EXPECT_EQ(exceptions,
              (std::vector<std::string>{"relevo view --only", "relevo capture --only",
                                        "relevo run --only", "relevo plan run --only",
                                        "relevo film --only", "relevo export web --only"}));
}

TEST(CommandLine, TheNameOfAnOptionIsNoValueOfAnother) {
    EXPECT_EQ(said_of({"capture", "a.tif", "-o", "--overwrite"}),
              "exit 2: --output: expected a value but got the option --overwrite; see relevo "
              "capture --help");
    EXPECT_EQ(said_of({"capture", "a.tif", "--time", "-o", "a.png"}),
              "exit 2: --time: expected a value but got the option -o; see relevo capture --help");
    EXPECT_EQ(said_of({"capture", "a.tif", "-o=a.png"}),
              "exit 2: --output: write -o a.png, without the =; see relevo capture --help");
    EXPECT_EQ(said_of({"capture", "a.tif", "--only=", "-o", "a.png"}),
              "exit 2: --only: write --only '' for no effects; see relevo capture --help");
}

TEST(CommandLine, DashesOfAWordProcessorAreSaidOfOptionsAlone) {
    EXPECT_EQ(said_of({"capture", "a.tif", "\u2013o", "a.png"}),
              "exit 2: \u2013o: begins with a dash; write -o with hyphens; see relevo capture "
              "--help");
    for (const char* size : {"\u2014size=64x48", "\u2013\u2013size=64x48", "-\u2013size=64x48"})
        EXPECT_EQ(said_of({"capture", "a.tif", size, "-o", "a.png"}),
                  fmt::format("exit 2: {}: begins with a dash; write --size=64x48 with hyphens; "
                              "see relevo capture --help",
                              size));
    EXPECT_EQ(said_of({"capture", "a.tif", "--title", "\u2014 Zermatt \u2014"}),
              "exit 2: --output is missing; write relevo capture DEM --output FILE; see relevo "
              "capture --help");
}

TEST(CommandLine, WordsInTheWrongPlaceAreToldApartFromMisspeltOnes) {
    EXPECT_EQ(said_of({"--size", "640x480", "capture", "a.tif", "-o", "a.png"}),
              "exit 2: --size: write it after relevo capture; see relevo capture --help");
    EXPECT_EQ(said_of({"capture", "a.tif", "--ouput", "a.png"}),
              "exit 2: --ouput: no such option; did you mean --output? See relevo capture --help");
    for (const char* longitude : {"8.56", "-121.5"})
        EXPECT_EQ(
            said_of({"sun", "position", "--at", "46.8", longitude, "--time", "2026-06-21"}),
            fmt::format("exit 2: {}: belongs to no option; write values of several parts with "
                        "commas and without blanks, or in quotes; see relevo sun position "
                        "--help",
                        longitude));
}

}  // namespace
}  // namespace relevo::test::test_command_line

// Completions and manual pages, as shells and man read them.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/text.h"
#include "cli/program.h"
#include "support/support.h"

namespace relevo::test {
namespace {

std::filesystem::path made() {
    return build_dir() / "generated/commands";
}

bool is_there(const std::string& program) {
    return run("/bin/sh", {"-c", "command -v " + program}).status == 0;
}

/// What bash proposes for the last word.
std::vector<std::string> by_bash(const std::vector<std::string>& words) {
    // compopt works only while a person completes. bash-completion sources files in a function.
    const std::string script = "load() { source " + (made() / "bash/relevo").string() +
                               "; }; load; compopt() { :; }; COMP_WORDS=(\"$@\"); "
                               "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _relevo; "
                               "printf '%s\\n' \"${COMPREPLY[@]}\"";
    std::vector<std::string> arguments{"-c", script, "bash"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Result done = run("/bin/bash", arguments, {"XDG_DATA_HOME=/nowhere"});
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(done.err, "");
    std::vector<std::string> proposed = split(trimmed(done.out), '\n');
    std::ranges::sort(proposed);
    return proposed;
}

using Words = std::vector<std::string>;

TEST(BashCompletion, ProposesCommandsOptionsAndValues) {
    EXPECT_EQ(by_bash({"relevo", "cap"}), Words{"capture"});
    EXPECT_EQ(by_bash({"relevo", "sun", "ho"}), (Words{"horizon", "horizons", "hours"}));
    EXPECT_EQ(by_bash({"relevo", "capture", "--en"}), (Words{"--enable", "--encoding"}));
    EXPECT_EQ(by_bash({"relevo", "capture", "--enable", "shad"}), Words{"shadows"});
    EXPECT_EQ(by_bash({"relevo", "capture", "--enable", "haze,sky"}),
              (Words{"haze,sky", "haze,skylight"}));
    EXPECT_EQ(by_bash({"relevo", "capture", "a.tif", "--set", "haze.d"}), Words{"haze.density="});
    EXPECT_EQ(by_bash({"relevo", "capture", "--preset", "pap"}), Words{"paper"});
    EXPECT_EQ(by_bash({"relevo", "sun", "hours", "--tz", "Europe/Zur"}), Words{"Europe/Zurich"});
    EXPECT_EQ(by_bash({"relevo", "capture", "--stamp", "title,sc"}), Words{"title,scale"});
    EXPECT_EQ(by_bash({"relevo", "capture", "--refraction", "s"}),
              (Words{"saemundsson", "standard"}));
    EXPECT_EQ(by_bash({"relevo", "sun", "hours", "--date", "2"}), Words{});
}

TEST(BashCompletion, ProposesFiles) {
    const std::filesystem::path dir = scratch_dir();
    std::ofstream(dir / "an alp.tif") << "x";
    EXPECT_EQ(by_bash({"relevo", "info", (dir / "an").string()}),
              Words{(dir / "an alp.tif").string()});
    EXPECT_EQ(by_bash({"relevo", "capture", "--scene", (dir / "an").string()}),
              Words{(dir / "an alp.tif").string()});
}

TEST(FishCompletion, ProposesTheSame) {
    if (!is_there("fish")) GTEST_SKIP() << "not run: needs fish";
    const auto proposed = [](const std::string& line) {
        const Result done = run(
            "/usr/bin/fish",
            {"-N", "-c",
             "source " + (made() / "fish/relevo.fish").string() + "; complete -C '" + line + "'"});
        EXPECT_EQ(done.err, "");
        std::vector<std::string> words;
        for (const std::string& one : split(trimmed(done.out), '\n'))
            words.push_back(one.substr(0, one.find('\t')));
        return words;
    };
    EXPECT_EQ(proposed("relevo capture --enable shad"), Words{"shadows"});
    EXPECT_EQ(proposed("relevo sun hours --tz Europe/Zur"), Words{"Europe/Zurich"});
    EXPECT_EQ(proposed("relevo capture --set haze.d"), Words{"haze.density="});
    EXPECT_EQ(proposed("relevo sun hours --ba"), (Words{"--band", "--bands"}));
}

TEST(ZshCompletion, IsReadByZsh) {
    if (!is_there("zsh")) GTEST_SKIP() << "not run: needs zsh";
    const std::string file = (made() / "zsh/_relevo").string();
    EXPECT_EQ(run("/usr/bin/zsh", {"-n", file}).err, "");
    // Proposals are asked for on a terminal of zsh's own.
    const std::string script =
        "zmodload zsh/zpty; zpty -b z 'zsh -f -i'; "
        "zpty -w z 'PS1=; fpath=(" +
        (made() / "zsh").string() +
        " $fpath); autoload -Uz compinit; compinit -u -D; print ready'; "
        "zpty -r z line '*ready*ready*'; zpty -w -n z $'relevo capture --enable shad\\t'; "
        "zpty -r -m z line '*shadows*'; print -r -- $line; zpty -d z";
    const Result done = run("/usr/bin/timeout", {"20", "zsh", "-f", "-c", script});
    EXPECT_NE(done.out.find("shadows"), std::string::npos) << done.out << done.err;
}

TEST(Manuals, AreThereForEveryCommandAndWithoutMistakes) {
    for (const char* name : {"relevo", "relevo-capture", "relevo-sun", "relevo-sun-hours",
                             "relevo-plugins-new", "relevo-thumbnail"})
        EXPECT_TRUE(std::filesystem::exists(made() / "man1" / (std::string(name) + ".1"))) << name;
    if (!is_there("mandoc")) GTEST_SKIP() << "not run: needs mandoc";
    for (const auto& page : std::filesystem::directory_iterator(made() / "man1")) {
        const Result checked = run("/usr/bin/mandoc", {"-T", "lint", "-W", "warning", page.path()});
        std::istringstream lines(checked.out + checked.err);
        for (std::string line; std::getline(lines, line);)
            EXPECT_NE(line.find("cross reference"), std::string::npos) << line;
    }
    const Result text = run("/usr/bin/mandoc", {"-T", "utf8", made() / "man1/relevo-sun-hours.1"});
    EXPECT_NE(text.out.find("Hours of direct sun of each post"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("EXIT STATUS"), 0U);
}

}  // namespace
}  // namespace relevo::test

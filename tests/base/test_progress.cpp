#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <thread>

#include <poll.h>
#include <pty.h>
#include <unistd.h>

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

/// Another end of a terminal, and what was written to it.
class Terminal {
  public:
    Terminal() { EXPECT_EQ(openpty(&mine_, &theirs_, nullptr, nullptr, nullptr), 0); }
    ~Terminal() {
        close(mine_);
        close(theirs_);
    }
    int descriptor() const { return theirs_; }
    std::string text() const {
        std::string text(4096, 0);
        pollfd there{mine_, POLLIN, 0};
        if (poll(&there, 1, 0) <= 0) return {};
        text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(mine_, text.data(), 4096))));
        return text;
    }

  private:
    int mine_ = -1, theirs_ = -1;
};

TEST(Progress, DurationsAreInTheUnitThatFits) {
    EXPECT_EQ(duration_text(99), "99 s");
    EXPECT_EQ(duration_text(100), "2 min");
    EXPECT_EQ(duration_text(5999), "100 min");
    EXPECT_EQ(duration_text(7200), "2 h");
    EXPECT_EQ(duration_text(36 * 3600), "36 h");
}

TEST(ProgressBar, IsOnATerminalAloneAndGoesWithItself) {
    const Terminal terminal;
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(pipe(pipe_ends.data()), 0);
    {
        ProgressBar bar("shade.tif", terminal.descriptor()), none("shade.tif", pipe_ends[1]);
        bar.show(0.5);
        EXPECT_EQ(terminal.text(), "") << "short work has no word";
        std::this_thread::sleep_for(std::chrono::milliseconds(1050));
        bar.show(0.5);
        none.show(0.5);
        EXPECT_EQ(terminal.text(), "\r\x1b[Kshade.tif [============            ] 50 %, 1 s left");
        bar.show(0.6);
        EXPECT_EQ(terminal.text(), "") << "not more often than one can read";
    }
    EXPECT_EQ(terminal.text(), "\r\x1b[K");
    pollfd there{pipe_ends[0], POLLIN, 0};
    EXPECT_EQ(poll(&there, 1, 0), 0) << "nothing on a pipe";
    close(pipe_ends[0]);
    close(pipe_ends[1]);
}

TEST(ProgressBar, CountsWhatCanBeCounted) {
    const Terminal terminal;
    ProgressBar bar("", terminal.descriptor());
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    bar.show(24, 96);
    EXPECT_EQ(terminal.text(), "\r\x1b[K[======                  ] 24 of 96, 3 s left");
}

TEST(ProgressBar, SaysNothingWhereNothingIsToBeSaid) {
    const Terminal terminal;
    log::set_level(log::Level::Warning);
    ProgressBar bar("", terminal.descriptor());
    log::set_level(log::Level::Info);
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    bar.show(0.5);
    EXPECT_EQ(terminal.text(), "");
}

TEST(ProgressBar, IsLinesForOtherPrograms) {
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(pipe(pipe_ends.data()), 0);
    ProgressBar::use_lines(true);
    log::set_level(log::Level::Warning);
    {
        ProgressBar bar("shade.tif", pipe_ends[1]);
        bar.show(0.25);
        bar.show(0.3);  // too soon
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        bar.show(3, 4);
    }
    ProgressBar::use_lines(false);
    log::set_level(log::Level::Info);
    std::string text(4096, 0);
    text.resize(static_cast<std::size_t>(read(pipe_ends[0], text.data(), text.size())));
    EXPECT_EQ(text, "progress 0.250\nprogress 0.750\n");
    close(pipe_ends[0]);
    close(pipe_ends[1]);
}

}  // namespace
}  // namespace relevo

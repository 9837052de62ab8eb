#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files_in_use.h"
#include "base/output_file.h"
#include "base/text.h"
#include "support/support.h"

namespace {

/// What the calls below have seen, and how they answer.
std::vector<std::string> calls;
bool offers_unnamed = true;
bool offers_noreplace = true;
bool offers_links = true;
int fsync_error = 0;

void note(const char* call) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    calls.emplace_back(call);
}

int refused(int error) {
    errno = error;
    return -1;
}

}  // namespace

// The linker takes these instead of the C library's.
extern "C" {

int openat(int folder, const char* path, int flags, ...) {
    mode_t mode = 0;
    if (flags & (O_CREAT | O_TMPFILE)) {
        va_list arguments;
        va_start(arguments, flags);
        mode = va_arg(arguments, mode_t);
        va_end(arguments);
    }
    if (!offers_unnamed && (flags & O_TMPFILE) == O_TMPFILE) return refused(EOPNOTSUPP);
    return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

int fsync(int file) {
    struct stat status {};
    fstat(file, &status);
    note(S_ISDIR(status.st_mode) ? "sync folder" : "sync file");
    if (fsync_error != 0) return refused(fsync_error);
    return static_cast<int>(syscall(SYS_fsync, file));
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
    note("link");
    if (!offers_links) return refused(EPERM);
    return static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
    note("rename to a free name");
    if (!offers_noreplace) return refused(EINVAL);
    return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
    note("rename");
    return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, 0));
}
}

namespace relevo {
namespace {

using test::error_of;
constexpr int kNotRun = 77;  ///< nobody may not come to where the tests are

using Names = std::vector<std::string>;

/// File systems differ in what they offer; the rest is the same.
enum class Offers { All, NoUnnamed, NoReplaceless, NoLinks };

class OutputFiles : public testing::TestWithParam<Offers> {
  protected:
    OutputFiles() {
        offers_unnamed = GetParam() == Offers::All;
        offers_noreplace = GetParam() < Offers::NoReplaceless;
        offers_links = GetParam() < Offers::NoLinks;
    }
    ~OutputFiles() override {
        offers_unnamed = offers_noreplace = offers_links = true;
        fsync_error = 0;
    }

    Names names() const {
        Names found;
        for (const auto& entry : std::filesystem::directory_iterator(dir_))
            found.push_back(entry.path().filename().string());
        std::sort(found.begin(), found.end());
        return found;
    }
    std::string message(const std::string& what, int status = 3) const {
        return "exit " + std::to_string(status) + ": test: " + path_.string() + ": " + what;
    }
    mode_t mode() const {
        struct stat status {};
        stat(path_.c_str(), &status);
        return status.st_mode & 07777;
    }

    std::filesystem::path dir_ = test::scratch_dir("output_file");
    std::filesystem::path path_ = dir_ / "a.csv";
};

INSTANTIATE_TEST_SUITE_P(FileSystem, OutputFiles,
                         testing::Values(Offers::All, Offers::NoUnnamed, Offers::NoReplaceless,
                                         Offers::NoLinks));

TEST_P(OutputFiles, HaveTheWholeText) {
    const std::string text = std::string("a,b\n1,2\n\0x", 10);
    write_text(path_, text, false, "test");
    EXPECT_EQ(read_text(path_, "test"), text);
    EXPECT_EQ(names(), Names{"a.csv"});
}

TEST_P(OutputFiles, AreReplacedOnlyWhenAsked) {
    write_text(path_, "old", false, "test");
    EXPECT_EQ(error_of([&] { write_text(path_, "new", false, "test"); }),
              message("exists; pass --overwrite to replace it"));
    EXPECT_EQ(read_text(path_, "test"), "old");
    write_text(path_, "new", true, "test");
    EXPECT_EQ(read_text(path_, "test"), "new");
    EXPECT_EQ(names(), Names{"a.csv"});
}

TEST_P(OutputFiles, AreNotThereInPart) {
    {
        OutputFile file(path_, false, "test");
        file.write("half");
        EXPECT_EQ(names().size(), GetParam() == Offers::All ? 0U : 1U);
        EXPECT_FALSE(std::filesystem::exists(path_));
    }
    EXPECT_EQ(names(), Names{});
}

TEST_P(OutputFiles, LeaveANameAloneThatIsTakenMeanwhile) {
    {
        OutputFile mine(path_, false, "test");
        mine.write("mine");
        std::ofstream(path_) << "theirs";
        EXPECT_EQ(
            error_of([&] { mine.finish(); }),
            message("exists now, made by another program; pass --overwrite to replace it", 1));
    }
    EXPECT_EQ(read_text(path_, "test"), "theirs");
    EXPECT_EQ(names(), Names{"a.csv"});
    std::filesystem::remove(path_);
    OutputFile mine(path_, true, "test");
    mine.write("mine");
    std::ofstream(path_) << "theirs";
    mine.finish();
    EXPECT_EQ(read_text(path_, "test"), "mine");
    EXPECT_EQ(names(), Names{"a.csv"});
}

TEST_P(OutputFiles, OfOneRunAppearTogetherOrNotAtAll) {
    const std::filesystem::path other = dir_ / "b.json";
    const auto finish_with = [&](const std::filesystem::path& first,
                                 const std::filesystem::path& second,
                                 const std::function<void()>& meanwhile) {
        FilesInUse files;
        for (const auto& path : {first, second})
            files.open_output(path, path == path_, "test").write("mine");
        meanwhile();
        return error_of([&] { files.finish_outputs(); });
    };
    const std::string taken =
        "exit 1: test: " + other.string() +
        ": exists now, made by another program; pass --overwrite to replace it";
    for (const auto& [first, second] : {std::pair(path_, other), std::pair(other, path_)}) {
        EXPECT_EQ(finish_with(first, second, [&] { std::ofstream(other) << "theirs"; }), taken);
        EXPECT_EQ(names(), Names{"b.json"});
        EXPECT_EQ(read_text(other, "test"), "theirs");
        // What would be replaced is left as it is.
        std::filesystem::remove(other);
        std::ofstream(path_) << "old";
        EXPECT_EQ(finish_with(first, second, [&] { std::ofstream(other) << "theirs"; }), taken);
        EXPECT_EQ(read_text(path_, "test"), "old");
        std::filesystem::remove(other);
        std::filesystem::remove(path_);
    }
    for (const auto& [first, second] :
         {std::pair<std::filesystem::path, std::filesystem::path>(path_, "/dev/full"),
          std::pair<std::filesystem::path, std::filesystem::path>("/dev/full", path_)}) {
        EXPECT_EQ(finish_with(first, second, [] {}),
                  "exit 1: test: /dev/full: cannot be written, No space left on device");
        EXPECT_EQ(names(), Names{});
    }
    EXPECT_EQ(finish_with(path_, other, [&] { fsync_error = EIO; }),
              message("cannot be written, Input/output error", 1));
    EXPECT_EQ(names(), Names{});
    fsync_error = 0;
    finish_with(path_, other, [] {});
    EXPECT_EQ(names(), (Names{"a.csv", "b.json"}));
    EXPECT_EQ(read_text(other, "test"), "mine");
}

TEST_P(OutputFiles, AreOnTheDiskBeforeTheyHaveANameAndTheNameAfter) {
    for (const bool replace : {false, true}) {
        calls.clear();
        write_text(path_, "text", replace, "test");
        ASSERT_GE(calls.size(), 3U);
        EXPECT_EQ(calls.front(), "sync file");
        EXPECT_EQ(calls.back(), "sync folder");
        EXPECT_EQ(std::count(calls.begin(), calls.end(), "sync file"), 1);
        EXPECT_EQ(std::count(calls.begin(), calls.end(), "sync folder"), 1);
    }
}

TEST_P(OutputFiles, ThatDidNotReachTheDiskAreNotThere) {
    fsync_error = EIO;
    EXPECT_EQ(error_of([&] { write_text(path_, "text", false, "test"); }),
              message("cannot be written, Input/output error", 1));
    EXPECT_EQ(names(), Names{});
}

TEST_P(OutputFiles, OfAFullDiskAreErrors) {
    EXPECT_EXIT(
        {
            remove_partial_files_at_signals();
            rlimit limit{};
            limit.rlim_cur = limit.rlim_max =
                8192;  // room for the message, which goes to a file too
            setrlimit(RLIMIT_FSIZE, &limit);
            const std::string text(100000, 'x');
            const std::string error = error_of([&] { write_text(path_, text, false, "test"); });
            fputs(error.c_str(), stderr);
            _exit(7);
        },
        testing::ExitedWithCode(7), "^exit 1: test: .*/a.csv: cannot be written, File too large$");
    EXPECT_EQ(names(), Names{});
}

TEST_P(OutputFiles, GoWithTheProcessThatASignalEnds) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU}) {
        EXPECT_EXIT(
            {
                remove_partial_files_at_signals();
                OutputFile file(path_, false, "test");
                file.write("half");
                raise(number);
                _exit(7);
            },
            testing::KilledBySignal(number), "");
        EXPECT_EQ(names(), Names{}) << number;
    }
    EXPECT_EXIT(
        {
            std::signal(SIGHUP, SIG_IGN);  // nohup
            remove_partial_files_at_signals();
            OutputFile file(path_, false, "test");
            file.write("whole");
            raise(SIGHUP);
            file.finish();
            _exit(7);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(read_text(path_, "test"), "whole");
}

TEST_P(OutputFiles, GoWithAProcessThatALibraryEndsButNotWithItsChildren) {
    EXPECT_EXIT(
        {
            OutputFile file(path_, false, "test");
            file.write("half");
            exit(7);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(names(), Names{});
    OutputFile file(path_, false, "test");
    file.write("whole");
    EXPECT_EXIT(exit(7), testing::ExitedWithCode(7), "");
    file.finish();
    EXPECT_EQ(read_text(path_, "test"), "whole");
}

TEST_P(OutputFiles, FollowSymbolicLinksWhichStay) {
    std::filesystem::create_directory(dir_ / "sub");
    const std::filesystem::path real = dir_ / "sub" / "real.csv";
    std::ofstream(real) << "old";
    std::filesystem::create_symlink("sub/real.csv", path_);
    EXPECT_EQ(error_of([&] { write_text(path_, "new", false, "test"); }),
              message("exists; pass --overwrite to replace it"));
    write_text(path_, "new", true, "test");
    EXPECT_TRUE(std::filesystem::is_symlink(path_));
    EXPECT_EQ(read_text(real, "test"), "new");
    std::filesystem::remove(real);
    EXPECT_EQ(error_of([&] { write_text(path_, "new", true, "test"); }),
              message("is a broken symbolic link; remove it, or create its target"));
    EXPECT_FALSE(std::filesystem::exists(real));
}

TEST_P(OutputFiles, HaveThePermissionsOfTheUmaskOrOfWhatTheyReplace) {
    const mode_t before = umask(027);
    write_text(path_, "new", false, "test");
    EXPECT_EQ(mode(), 0640U);
    chmod(path_.c_str(), 04604);
    write_text(path_, "newer", true, "test");
    EXPECT_EQ(mode(), 0604U);
    umask(before);
}

TEST_P(OutputFiles, TakeTheLongestNameThereIs) {
    path_ = dir_ / (std::string(251, 'x') + ".csv");
    write_text(path_, "long", false, "test");
    write_text(path_, "longer", true, "test");
    EXPECT_EQ(read_text(path_, "test"), "longer");
    EXPECT_EQ(names().size(), 1U);
    path_ = dir_ / (std::string(252, 'x') + ".csv");
    EXPECT_EQ(error_of([&] { OutputFile(path_, true, "test"); }),
              message("cannot be written, File name too long"));
}

TEST_P(OutputFiles, OfTwoAtOnceOneIsThere) {
    std::atomic<int> won = 0;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 8; ++i)
            threads.emplace_back([&, i] {
                const std::string text(100000, static_cast<char>('a' + i));
                won += error_of([&] { write_text(path_, text, false, "test"); }) == "no error";
            });
    }
    // Nothing decides between them on a file system that cannot take a free name.
    if (GetParam() != Offers::NoLinks) {
        EXPECT_EQ(won, 1);
    }
    const std::string text = read_text(path_, "test");
    EXPECT_EQ(text, std::string(100000, text[0]));
    EXPECT_EQ(names(), Names{"a.csv"});
}

class OutputFile_ : public OutputFiles {};
INSTANTIATE_TEST_SUITE_P(Once, OutputFile_, testing::Values(Offers::All));

TEST_P(OutputFile_, HasAPartOfANameThatNobodyCanGuessAndFollowsNoLink) {
    offers_unnamed = false;
    const OutputFile one(path_, false, "test"), two(path_, false, "test");
    const Names parts = names();
    ASSERT_EQ(parts.size(), 2U);
    for (const std::string& part : parts) {
        EXPECT_EQ(part.size(), 29U) << part;
        EXPECT_TRUE(part.starts_with(".relevo-") && part.ends_with(".part")) << part;
        EXPECT_EQ(part.find(std::to_string(getpid())), std::string::npos) << part;
    }
}

TEST_P(OutputFile_, ErrorsSayWhatIsWrong) {
    const auto open = [&] { OutputFile(path_, true, "test"); };
    const std::string none = (dir_ / "none").string();
    path_ = dir_ / "none" / "a.csv";
    EXPECT_EQ(error_of(open), message("the folder " + none + " does not exist; create it first"));
    std::ofstream(dir_ / "file") << "a file";
    path_ = dir_ / "file" / "a.csv";
    EXPECT_EQ(error_of(open), message("the folder " + (dir_ / "file").string() +
                                      " does not exist; create it first"));
    for (const char* name : {"", "sub/..", "."}) {
        std::filesystem::create_directory(dir_ / "sub");
        path_ = dir_ / name;
        EXPECT_EQ(error_of(open), message("is a folder"));
    }
    path_ = std::string(5000, 'x') + "/a.csv";
    EXPECT_EQ(error_of(open), message("cannot be written, File name too long"));
    std::filesystem::create_symlink("loop", dir_ / "loop");
    path_ = dir_ / "loop";
    EXPECT_EQ(error_of(open), message("cannot be written, Too many levels of symbolic links"));
    path_ = "a\nrelevo: error: b.csv";
    std::filesystem::create_directory(dir_ / path_);
    path_ = dir_ / path_;
    EXPECT_EQ(error_of(open),
              "exit 3: test: " + dir_.string() + "/a\\nrelevo: error: b.csv: is a folder");
}

TEST_P(OutputFile_, ThatTheUserMayNotWriteIsRefusedAtOnce) {
    const std::filesystem::path locked = dir_ / "locked";
    std::filesystem::create_directory(locked);
    std::ofstream(path_) << "precious";
    chmod(path_.c_str(), 0444);
    chmod(locked.c_str(), 0555);
    chmod(dir_.c_str(), 0777);
    EXPECT_EXIT(
        {
            if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) _exit(kNotRun);
            if (access(dir_.c_str(), W_OK) != 0) _exit(kNotRun);
            const std::string folder = error_of([&] { OutputFile(locked / "a", true, "test"); });
            const std::string file = error_of([&] { OutputFile(path_, true, "test"); });
            const bool right = folder == "exit 3: test: " + (locked / "a").string() +
                                             ": the folder " + locked.string() +
                                             " cannot be written to, Permission denied" &&
                               file == message("may not be replaced, Permission denied");
            fputs((folder + "\n" + file).c_str(), stderr);
            _exit(right ? 7 : 6);
        },
        [](int status) { return WEXITSTATUS(status) == 7 || WEXITSTATUS(status) == kNotRun; }, "");
}

TEST_P(OutputFile_, MayBeWhatIsNoFile) {
    write_text("/dev/null", "nothing", false, "test");
    EXPECT_EQ(error_of([] { write_text("/dev/full", "text", false, "test"); }),
              "exit 1: test: /dev/full: cannot be written, No space left on device");
    ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
    std::string read;
    {
        const std::jthread reader([&] { std::getline(std::ifstream(path_), read); });
        OutputFile file(path_, false, "test");
        file.write("through");
        file.finish();
    }
    EXPECT_EQ(read, "through");
    EXPECT_EQ(names(), Names{"a.csv"});
}

TEST_P(OutputFile_, OnStandardOutputGoesOnWhereThatIs) {
    EXPECT_EXIT(
        {
            const int out = open(path_.c_str(), O_WRONLY | O_CREAT, 0600);
            dup2(out, STDOUT_FILENO);
            printf("before, ");
            write_text("/dev/stdout", "text", false, "test");
            printf(", after");
            fflush(stdout);
            _exit(7);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(read_text(path_, "test"), "before, text, after");
}

TEST_P(OutputFile_, IsNoFileThatTheRunReads) {
    const std::filesystem::path input = dir_ / "dem.tif", hard = dir_ / "hard.tif",
                                soft = dir_ / "soft.tif";
    std::ofstream(input) << "heights";
    std::filesystem::create_hard_link(input, hard);
    std::filesystem::create_symlink(input, soft);
    for (const std::filesystem::path& output : {input, hard, soft, dir_ / "." / "dem.tif"})
        for (const bool overwrite : {false, true}) {
            path_ = output;
            const std::string expected =
                message("is the DEM " + input.string() +
                        ", which would be overwritten; give the result another name");
            FilesInUse files;
            files.add_input(input, "the DEM");
            EXPECT_EQ(error_of([&] { files.open_output(path_, overwrite, "test"); }), expected);
            if (!overwrite) continue;
            // What is read may be known only later.
            FilesInUse later;
            later.open_output(path_, overwrite, "test");
            EXPECT_TRUE(later.replaces_any());
            EXPECT_EQ(error_of([&] { later.add_input(input, "the DEM"); }), expected);
        }
    EXPECT_EQ(read_text(input, "test"), "heights");
    FilesInUse files;
    files.add_input("/nowhere/dem.tif", "the DEM");
    files.add_input(dir_, "the DEM");
    files.open_output(dir_ / "other.png", false, "test");
    EXPECT_FALSE(files.replaces_any());
}

TEST_P(OutputFile_, IsNotTheFileOfAnotherResult) {
    std::filesystem::create_directory_symlink(dir_, dir_ / "same");
    FilesInUse files;
    files.open_output(path_, false, "test");
    EXPECT_EQ(error_of([&] { files.open_output(dir_ / "same" / "a.csv", false, "--timings"); }),
              "exit 2: --timings: " + (dir_ / "same" / "a.csv").string() +
                  ": another result has this name; give each its own file");
    files.open_output(dir_ / "b.csv", false, "test");
    files.open_output("/dev/null", false, "test");
    files.open_output("/dev/null", false, "test");
}

}  // namespace
}  // namespace relevo

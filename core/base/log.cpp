#include "base/log.h"

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/held_notices.h"
#include "base/text.h"

namespace relevo::log {
namespace {

constexpr std::string_view kPrefix = "relevo: ";

struct State {
    std::mutex mutex;
    Level level = Level::Info;
    std::function<void(Level, std::string_view)> sink;
    std::function<void()> before;
    std::optional<std::vector<std::string>> held;  // notices, while a HeldNotices lives
    std::shared_ptr<spdlog::logger> logger;

    State() {
        logger = std::make_shared<spdlog::logger>(
            "relevo", std::make_shared<spdlog::sinks::stderr_color_sink_st>());
        logger->set_level(spdlog::level::trace);
        // "relevo: warning: text"; a notice has no word before it.
        logger->set_pattern(std::string(kPrefix) + "%v");
    }
};

State& state() {
    static State instance;
    return instance;
}

constexpr std::size_t kLongestLine = 4000;
constexpr std::size_t kKeptHead = 1500, kKeptTail = 500;

/// A line without its middle where it is longer than anybody reads: values of any length come from
/// files and command lines. What it is about stands at its head, the remedy at its tail.
/// @param line  UTF-8
std::string shortened(std::string_view line) {
    if (line.size() <= kLongestLine) return std::string(line);
    const auto inside_a_letter = [&](std::size_t at) {
        return (static_cast<unsigned char>(line[at]) & 0xc0) == 0x80;
    };
    std::size_t head = kKeptHead, tail = line.size() - kKeptTail;
    while (inside_a_letter(head))
        --head;
    while (inside_a_letter(tail))
        ++tail;
    return fmt::format("{} ... ({} bytes) ... {}", line.substr(0, head), tail - head,
                       line.substr(tail));
}

/// An error may have several lines, as a driver's have. None but the first begins as a message
/// does: that would be a name's doing.
std::string shown(Level level, std::string_view message) {
    if (level != Level::Error) return shortened(printable(message));
    std::string text = printable_lines(message);
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; ++at)
        if (text.compare(at + 1, kPrefix.size(), kPrefix) == 0) text.replace(at, 1, "\\n");
    std::string lines;
    for (const std::string& line : split(text, '\n'))
        lines += shortened(line) + '\n';
    if (!lines.empty()) lines.pop_back();
    return lines;
}

void write(Level level, std::string_view message) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (level < s.level) return;
    if (level == Level::Info && s.held) {
        s.held->emplace_back(message);
        return;
    }
    if (s.sink) {
        s.sink(level, message);
        return;
    }
    if (s.before) s.before();
    const std::string text = shown(level, message);
    switch (level) {
        case Level::Debug:
            s.logger->debug("{}", text);
            break;
        case Level::Info:
            s.logger->info("{}", text);
            break;
        case Level::Warning:
            s.logger->warn("warning: {}", text);
            break;
        default:
            s.logger->error("error: {}", text);
            break;
    }
}

}  // namespace

void set_level(Level level) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    s.level = level;
}

Level level() {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    return s.level;
}

void debug(std::string_view message) {
    write(Level::Debug, message);
}

void info(std::string_view message) {
    write(Level::Info, message);
}

void warning(std::string_view message) {
    write(Level::Warning, message);
}

void error(std::string_view message) {
    write(Level::Error, message);
}

void set_before(std::function<void()> before) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    s.before = std::move(before);
}

void set_sink(std::function<void(Level, std::string_view)> sink) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    s.sink = std::move(sink);
}

HeldNotices::HeldNotices() {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.level > Level::Debug) s.held.emplace();
}

HeldNotices::~HeldNotices() {
    try {
        release();
    } catch (...) {
        // What cannot be written is no reason to end.
    }
}

void HeldNotices::release() {
    std::vector<std::string> notices;
    {
        State& s = state();
        const std::lock_guard lock(s.mutex);
        if (s.held) notices = std::move(*s.held);
        s.held.reset();
    }
    if (notices.empty()) return;
    const std::size_t more = notices.size() - 1;
    info(more == 0 ? notices.front()
                   : fmt::format("{}; {} more notice{} with -v", notices.front(), more,
                                 more == 1 ? "" : "s"));
}

}  // namespace relevo::log

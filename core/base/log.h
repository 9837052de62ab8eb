#pragma once

#include <functional>
#include <string>
#include <string_view>

/// Words for people, on standard error; standard output is for results.
/// Messages are built with fmt::format by the caller.
namespace relevo::log {

enum class Level { Debug, Info, Warning, Error, Off };

/// The least level that is written; Info at start, Warning with -q, Debug with -v.
void set_level(Level level);
Level level();

void debug(std::string_view message);  ///< only with -v
void info(std::string_view message);  ///< a notice: what was assumed, what was switched off and why
void warning(std::string_view message);  ///< the result may not be what the user expects
void error(std::string_view message);

/// Is called before every message that goes to standard error, such as to clear a line there.
void set_before(std::function<void()> before);

/// Sends every message to `sink` instead of standard error; an empty function undoes it.
/// Tests use it to compare whole messages.
void set_sink(std::function<void(Level, std::string_view)> sink);

}  // namespace relevo::log

#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

/// All verbs and their options, and how a line of words is read by them.
namespace relevo::cli {

/// Adds every verb to `app`.
void add_verbs(CLI::App& app);

/// Reads the words that follow the program's name, and runs the verb that they name. No option
/// takes an empty value, which an unset shell variable leaves, and none takes the name of another
/// option for its value.
/// @param app  as add_verbs() left it; of one line only
/// @throws Error (Usage) for words that `app` does not know, with what was probably meant; and what
///     the verb throws
void parse(CLI::App& app, std::vector<std::string> words);

/// Reads the words that follow the program's name, and runs the verb that they name.
/// @throws as parse()
void run(std::vector<std::string> words);

}  // namespace relevo::cli

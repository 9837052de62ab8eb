#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The verbs of the command line and their options. They are CLI11's, by way of these classes:
/// CLI11 is a header that takes seconds to compile, so that only verb.cpp and command_line.cpp
/// include it.
namespace relevo::cli {

/// What the value of an option must be.
struct Check {
    /// What is wrong with a value; empty if nothing is.
    std::function<std::string(const std::string&)> fault;
    std::string description;  ///< for --help: "1 to 100"
};

/// One of a list of words.
Check one_of(std::vector<std::string> words);

/// An option of a verb: a handle, which may be copied. Functions that return the option itself
/// change it and may be chained.
class Option {
  public:
    /// Of no verb: only count() may be called.
    Option() = default;
    explicit Option(CLI::Option* option) : option_(option) {}

    /// How many values the command line gives it; none to an option of no verb.
    std::size_t count() const;

    Option required(bool is = true) const;
    /// The heading of --help that it stands under.
    Option group(std::string name) const;
    Option check(Check check) const;
    /// Only together with `other`.
    Option needs(Option other) const;
    /// Never together with `other`.
    Option excludes(Option other) const;
    Option description(std::string help) const;
    /// What --help calls its value: FLOAT.
    Option type_name(std::string name) const;
    /// What separates the values in one word.
    Option delimiter(char separator) const;
    /// Takes one word each time that it is given, not all that follow.
    Option one_word() const;
    /// Takes any number of values, and none.
    Option any_number() const;

  private:
    CLI::Option* option_ = nullptr;
};

/// An option as the command line gives it.
struct GivenOption {
    std::string name;                 ///< "--tiles", "-k" or, without hyphens, "DEM"
    bool is_flag = false;             ///< it has no value
    std::vector<std::string> values;  ///< as they were written
};

/// A verb: a handle, which may be copied.
class Verb {
  public:
    explicit Verb(CLI::App& app) : app_(&app) {}

    /// @tparam Value  std::string, int or double, a std::optional of one or a std::vector of
    ///     strings; verb.cpp has the list
    /// @param name  "-o,--output", or "DEM" for one without hyphens
    /// @param to  gets the value; lives until the command line has been read
    template <typename Value>
    Option add_option(std::string name, Value& to, std::string help) const;
    /// Calls a function with the value.
    Option add_option_function(std::string name, std::function<void(const std::string&)> give,
                               std::string help) const;
    Option add_flag(std::string name, bool& to, std::string help) const;
    Option add_flag_callback(std::string name, std::function<void()> given, std::string help) const;
    /// "--ease,!--no-ease": calls a function with a positive number for the first, a negative one
    /// for the second.
    Option add_flag_function(std::string name, std::function<void(std::int64_t)> given,
                             std::string help) const;
    bool has_option(const std::string& name) const;
    Option option(const std::string& name) const;

    Verb add_verb(std::string name, std::string help) const;
    /// Its own verbs: from `least` to `most` of them are to be named.
    void require_verb(std::size_t least, std::size_t most = 1) const;
    /// Options of this verb may also be written after those below it.
    void fallthrough() const;
    /// Whether the command line names one of its own verbs.
    bool names_verb() const;
    /// How often the command line names it.
    std::size_t count() const;
    /// Its name after those above it, without that of the program: "plan sun hours".
    std::string command() const;
    /// What the command line gives of its own options, by name. Once the line has been read.
    std::vector<GivenOption> given() const;
    /// What is done once the command line has been read.
    void callback(std::function<void()> run) const;

  private:
    CLI::App* app_;
};

}  // namespace relevo::cli

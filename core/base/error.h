#pragma once

#include <stdexcept>
#include <string>

namespace relevo {

/// What went wrong, as the exit status of the program says it (docs/cli.md).
enum class ErrorCode {
    Failed = 1,      ///< the operation could not be carried out
    Usage = 2,       ///< the command line is wrong
    BadInput = 3,    ///< a file or a value given by the user cannot be used
    NoDevice = 4,    ///< no GL device that can draw
    Incomplete = 5,  ///< some of many results could not be made; the others are there
    Differ = 6,      ///< what was compared is not the same
};

/// An operation cannot continue. Caught once, in main.
///
/// The message reads `subject: what, expected E but got G; remedy`, for example
/// `alps.tif: no coordinate reference system; pass --crs EPSG:n`.
class Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}

    ErrorCode code() const { return code_; }
    int exit_status() const { return static_cast<int>(code_); }

  private:
    ErrorCode code_;
};

/// Throws `Error(ErrorCode::BadInput, printable(message))`: one line, whatever names are in it.
[[noreturn]] void bad_input(const std::string& message);

/// Throws `Error(ErrorCode::Usage, printable(message))`, one line likewise.
[[noreturn]] void bad_usage(const std::string& message);

/// Throws `Error(ErrorCode::Failed, message)`; what a driver says may have several lines.
[[noreturn]] void failed(const std::string& message);

}  // namespace relevo

#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace relevo::gl {

/// The name of a GL error: "GL_INVALID_VALUE".
std::string error_name(unsigned error);

/// The driver has reset the device: all contexts and what was made in them are lost.
class DeviceLost : public Error {
  public:
    explicit DeviceLost(const std::string& message) : Error(ErrorCode::NoDevice, message) {}
};

/// @throws DeviceLost where the driver reports that of the current context
void throw_if_lost();

/// Throws for an error that a command raised and nobody has looked at. Before a command whose own
/// errors are told apart: those then are its own.
/// @throws Error (Failed) `gl: before WHAT: GL_INVALID_ENUM`
void expect_no_error(std::string_view before);

/// Names an object for debuggers, as far as the device lets names be long.
/// @param kind  GL_TEXTURE and its like
void set_label(unsigned kind, unsigned name, std::string_view label);

}  // namespace relevo::gl

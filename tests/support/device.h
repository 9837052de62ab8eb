#pragma once

#include <string>

namespace relevo::test {

/// The GL device that tests draw on: `$RELEVO_TEST_DEVICE` ("auto", an index, a part of its name),
/// else the software device, on which the references were made.
std::string gl_device();

}  // namespace relevo::test

#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace relevo {

/// Bytes as base64 on one line. Source: RFC 4648, section 4.
std::string base64(std::span<const std::byte> bytes);

}  // namespace relevo

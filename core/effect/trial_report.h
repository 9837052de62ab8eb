#pragma once

#include <cstddef>

/// What try_module says of a module on its standard output: a mark and a name before each function
/// that it calls, then a mark, the reason why the module will not do, or nothing, and an end.
namespace relevo::effect {

/// Kinds of parameters, which try_module reads on its standard input.
inline constexpr int kValue = 0, kHostValue = 1, kText = 2;

inline constexpr char kStageMark = '\1';
inline constexpr char kVerdictMark = '\2';
inline constexpr char kReportEnd = '\3';
inline constexpr std::size_t kMaxReasonBytes = 1024;
inline constexpr std::size_t kMaxReportBytes = 4096;

}  // namespace relevo::effect

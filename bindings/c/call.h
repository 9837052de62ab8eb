#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>

#include "relevo/relevo.h"

/// What every function of the C interface goes through: arguments are checked, exceptions become
/// codes.
namespace relevo::c {

/// The call itself is wrong: RELEVO_RESULT_BAD_CALL.
struct BadCall {
    std::string message;
};
/// relevo_progress has asked for it: RELEVO_RESULT_CANCELLED.
struct Cancelled {};
/// A callback has thrown: RELEVO_RESULT_FAILED.
struct CallbackThrew {
    std::string which;
};

/// The code of the exception that is being handled; keeps its message for relevo_error().
relevo_result code_of_exception(const char* function) noexcept;
void prepare_library();

/// Does the work of a function.
/// @param function  its name, which errors of the call begin with
template <typename Body>
relevo_result guarded(const char* function, const Body& body) noexcept {
    try {
        prepare_library();
        body();
        return RELEVO_RESULT_OK;
    } catch (...) {
        return code_of_exception(function);
    }
}

/// A text for the caller, which lasts until the thread's next one.
const char* returned_text(std::string text);

/// @throws BadCall
template <typename T>
T& need(T* argument, const char* name) {
    if (!argument) throw BadCall{std::string(name) + ": null"};
    return *argument;
}

/// @throws BadCall unless `count` is what an array needs
void check_count(const char* name, std::size_t count, std::size_t needed);

/// Sizes that structs had in version 0.1: no caller has smaller ones.
template <typename T>
constexpr std::size_t kFirstSize = 0;
template <>
inline constexpr std::size_t kFirstSize<relevo_progress> = 24;
template <>
inline constexpr std::size_t kFirstSize<relevo_raster> = 88;
template <>
inline constexpr std::size_t kFirstSize<relevo_grid> = 96;
template <>
inline constexpr std::size_t kFirstSize<relevo_place> = 32;
template <>
inline constexpr std::size_t kFirstSize<relevo_event> = 40;
template <>
inline constexpr std::size_t kFirstSize<relevo_open_options> = 32;
template <>
inline constexpr std::size_t kFirstSize<relevo_picture> = 96;

/// A struct of the caller's version as one of ours; what it lacks is 0.
/// @throws BadCall for null, and for a size that no version has
template <typename T>
T read_struct(const T* given, const char* name) {
    static_assert(kFirstSize<T> > 0 && kFirstSize<T> <= sizeof(T));
    const std::size_t size = need(given, name).size;
    if (size < kFirstSize<T> || size > 16 * sizeof(T))
        throw BadCall{std::string(name) + ".size: expected " + std::to_string(sizeof(T)) +
                      " but got " + std::to_string(size)};
    T ours{};
    std::memcpy(&ours, given, std::min(size, sizeof(T)));
    return ours;
}

/// Fills a struct of the caller's version. @param size  of it
template <typename T>
void write_struct(T ours, std::size_t size, void* to) {
    ours.size = size;
    std::memcpy(to, &ours, std::min(size, sizeof(T)));
}
template <typename T>
void write_struct(const T& ours, T* to) {
    write_struct(ours, to->size, to);
}

/// Reports the progress of work to the caller.
class Progress {
  public:
    /// @param progress  may be null @throws BadCall
    explicit Progress(const relevo_progress* progress) {
        if (progress) given_ = read_struct(progress, "progress");
    }
    /// @param share  of all work, done since the last call
    /// @throws Cancelled, CallbackThrew
    void add(double share);

  private:
    relevo_progress given_{};
    double done_ = 0;
};

}  // namespace relevo::c

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <relevo/relevo.h>

/// What the functions of the module go through: results become exceptions, arrays become pointers,
/// long work runs on a thread that can be cancelled.
namespace relevo::python {

namespace py = pybind11;

/// A call of the library that failed, on its way to Python.
struct LibraryError {
    relevo_result code;
    std::string text;
};

/// @throws LibraryError with the library's sentence
void check(relevo_result result);

/// A call under way. Requires the GIL at its beginning and end.
class Calling {
  public:
    /// @throws LibraryError when Python ends, and in a process that was forked after the library
    /// was
    ///     used: its threads are not there
    Calling();
    ~Calling();
    Calling(const Calling&) = delete;
    Calling& operator=(const Calling&) = delete;
};

/// Does a call without the GIL. @throws LibraryError
template <typename Call>
void call(const Call& call_library) {
    const Calling calling;
    const py::gil_scoped_release released;
    check(call_library());
}

/// A call that takes long: fills the text with what it returns besides. It may go on after the
/// function that has asked for it, so that it owns what it uses.
using LongCall = std::function<relevo_result(const relevo_progress*, std::string&)>;

/// Does a call without the GIL on a thread of its own, while this one handles signals and calls
/// `progress`.
/// @param progress  None, or a function of the share that is done; False from it cancels
/// @returns the text
/// @throws LibraryError, and what a signal's handler or `progress` raises: at once, also if the
///     work takes a while to notice
std::string call_long(const py::object& progress, LongCall call_library);
/// Cancels all work and waits for its end: before Python ends, because threads that are then in a
/// call would end the process.
void finish_calls();

/// Keeps what the library says until Python takes it.
void keep_messages();
/// (level, text) of what was said since, level as RELEVO_MESSAGE_WARNING.
std::vector<std::pair<int, std::string>> take_messages();

/// The memory of an array, held for as long as this lives.
class Array {
  public:
    enum class Use { Read, Write };
    /// Requires the GIL, here and at the end.
    /// @param format  of the struct module: 'f', 'd', 'B'
    /// @throws LibraryError (bad call) for another type, gaps between elements, foreign byte order
    Array(const py::object& array, char format, Use use);
    ~Array() { PyBuffer_Release(&view_); }
    Array(const Array&) = delete;
    Array& operator=(const Array&) = delete;

    template <typename T>
    T* data() const {
        return static_cast<T*>(view_.buf);
    }
    std::size_t count() const { return static_cast<std::size_t>(view_.len / view_.itemsize); }
    /// Elements along a dimension. @throws LibraryError unless there are two
    std::int32_t rows() const { return side(0); }
    std::int32_t columns() const { return side(1); }

  private:
    std::int32_t side(int dimension) const;

    Py_buffer view_{};
};

/// A handle of the library, closed with the object.
template <typename Handle, void (*close_handle)(Handle*)>
class Owned {
  public:
    Owned() = default;
    ~Owned() { close(); }
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;

    Handle** receive() { return &handle_; }
    /// @throws LibraryError once it is closed
    Handle* get(const char* what) const {
        if (!handle_) throw LibraryError{RELEVO_RESULT_BAD_CALL, std::string(what) + ": closed"};
        return handle_;
    }
    bool closed() const { return handle_ == nullptr; }
    void close();

  private:
    Handle* handle_ = nullptr;
};

/// Whether this process was forked from the one that has the library's threads.
bool is_fork();

template <typename Handle, void (*close_handle)(Handle*)>
void Owned<Handle, close_handle>::close() {
    Handle* const handle = std::exchange(handle_, nullptr);
    if (handle && !is_fork()) close_handle(handle);
}

using Dem = Owned<relevo_dem, relevo_dem_close>;
using Session = Owned<relevo_session, relevo_close>;

/// A struct of the interface with its size.
template <typename T>
T sized() {
    T value{};
    value.size = sizeof value;
    return value;
}

}  // namespace relevo::python

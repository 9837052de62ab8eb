#pragma once

#include <atomic>

namespace relevo {

/// A function of a shared library that is found when it is called for the first time, so that a
/// program which never calls it need not load the library. Declared under the function's own name
/// in a namespace of ours, it takes the calls that would go to the function itself:
///
///     inline const LateFunction<decltype(::GDALClose), find> GDALClose{"GDALClose"};
///
/// @tparam Function  the function's type
/// @tparam find  loads the library where it is not loaded, and returns the address of a function;
///     throws where it cannot
template <typename Function, void* (*find)(const char* name)>
class LateFunction;

template <typename Result, typename... Arguments, void* (*find)(const char* name)>
class LateFunction<Result(Arguments...), find> {
  public:
    constexpr explicit LateFunction(const char* name) : name_(name) {}

    Result operator()(Arguments... arguments) const { return address()(arguments...); }

    /// The function itself, for who wants a pointer.
    Result (*address() const)(Arguments...) {
        Pointer found = found_.load(std::memory_order_acquire);
        if (!found) {
            found = reinterpret_cast<Pointer>(find(name_));
            found_.store(found, std::memory_order_release);
        }
        return found;
    }

  private:
    using Pointer = Result (*)(Arguments...);

    const char* name_;
    mutable std::atomic<Pointer> found_{nullptr};
};

}  // namespace relevo

#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "call.h"

namespace relevo::c {

/// Objects behind handles. A handle is a number that is never used again, so that one that is
/// closed is found out.
template <typename Handle, typename Object>
class Handles {
  public:
    Handle* add(std::shared_ptr<Object> object) {
        const std::lock_guard lock(mutex_);
        const std::uintptr_t number = next_ += 2;  // odd: no address of an object
        objects_.emplace(number, std::move(object));
        return reinterpret_cast<Handle*>(number);
    }

    /// Keeps the object also if the handle is closed meanwhile.
    /// @throws BadCall
    std::shared_ptr<Object> get(Handle* handle, const char* name) {
        need(handle, name);
        const std::lock_guard lock(mutex_);
        const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
        if (found == objects_.end()) throw BadCall{std::string(name) + ": a closed handle"};
        return found->second;
    }

    /// @returns the object, to be destroyed outside of the lock; null for an unknown handle
    std::shared_ptr<Object> remove(Handle* handle) noexcept {
        const std::lock_guard lock(mutex_);
        const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
        if (found == objects_.end()) return nullptr;
        std::shared_ptr<Object> object = std::move(found->second);
        objects_.erase(found);
        return object;
    }

  private:
    std::mutex mutex_;
    std::unordered_map<std::uintptr_t, std::shared_ptr<Object>> objects_;
    std::uintptr_t next_ = 1;
};

}  // namespace relevo::c

#include "base/object_store.h"

#include <atomic>

namespace relevo {
namespace {

std::atomic<const ObjectStore*> installed = nullptr;

}  // namespace

void install_object_store(const ObjectStore* store) {
    installed = store;
}

const ObjectStore* object_store_of(std::string_view name) {
    const ObjectStore* const store = installed;
    return store && store->has_name(name) ? store : nullptr;
}

}  // namespace relevo

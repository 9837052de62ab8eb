#include "gl/hidden_libraries.h"

#include <string_view>
#include <utility>

#include <dlfcn.h>

namespace relevo::test {
namespace {

std::vector<std::string>& hidden() {
    static std::vector<std::string> texts;
    return texts;
}

}  // namespace

HiddenLibraries::HiddenLibraries(std::vector<std::string> texts) {
    hidden() = std::move(texts);
}

HiddenLibraries::~HiddenLibraries() {
    hidden().clear();
}

}  // namespace relevo::test

/// Stands before the C library's, for all libraries of the program.
extern "C" __attribute__((visibility("default"))) void* dlopen(const char* name,
                                                               int flags) noexcept {
    using Open = void* (*)(const char*, int);
    static const auto next = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "dlopen"));
    for (const std::string& text : relevo::test::hidden())
        if (name && std::string_view(name).find(text) != std::string_view::npos) return nullptr;
    return next(name, flags);
}

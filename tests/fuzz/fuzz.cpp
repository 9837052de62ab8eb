#include "fuzz/fuzz.h"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <utility>

#include "base/log.h"
#include "base/temporary_folder.h"

namespace relevo::fuzz {
namespace {

std::map<std::string, Target::Read>& targets() {
    static std::map<std::string, Target::Read> all;
    return all;
}

Target::Read chosen = nullptr;

}  // namespace

Target::Target(std::string name, Read read) {
    chosen = read;
    targets().emplace(std::move(name), read);
}

bool choose_target(const std::string& name) {
    const auto found = targets().find(name);
    if (found == targets().end()) return false;
    chosen = found->second;
    return true;
}

const std::filesystem::path& folder() {
    static const TemporaryFolder made("relevo-fuzz");
    return made.path();
}

std::filesystem::path file(std::string_view bytes, const std::filesystem::path& name) {
    std::filesystem::path path = folder() / name;
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

}  // namespace relevo::fuzz

/// Called by libFuzzer, or by replay.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace relevo;
    log::set_level(log::Level::Off);
    fuzz::attempt([&] { fuzz::chosen({reinterpret_cast<const char*>(data), size}); });
    return 0;
}

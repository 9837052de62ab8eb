// Instead of libFuzzer: feeds a target with the files of folders, each once. In: target, folders.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// The name goes first, so that a crash shows whose it is.
void replay(const std::filesystem::path& path) {
    std::printf("%s\n", path.c_str());
    std::fflush(stdout);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || !relevo::fuzz::choose_target(argv[1])) {
        std::printf("no such target\n");
        return 1;
    }
    std::vector<std::filesystem::path> paths;
    for (int i = 2; i < argc; ++i)
        for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i]))
            if (entry.is_regular_file()) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    try {
        for (const std::filesystem::path& path : paths)
            replay(path);
    } catch (const std::exception& error) {
        std::printf("threw what is no relevo::Error: %s\n", error.what());
        return 1;
    }
    std::printf("%zu files\n", paths.size());
    return paths.empty() ? 1 : 0;
}

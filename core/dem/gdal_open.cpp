#include "dem/gdal_open.h"

#include <algorithm>

#include "dem/gdal.h"

namespace relevo::dem {
namespace {

thread_local bool may_ask_net = false;

/// While it lives, this thread opens a name.
class Opening {
  public:
    explicit Opening(const AllowedName& name) { may_ask_net = name.asks_net(); }
    ~Opening() { may_ask_net = false; }
    Opening(const Opening&) = delete;
    Opening& operator=(const Opening&) = delete;
};

}  // namespace

bool opens_of_the_net() {
    return may_ask_net;
}

Dataset open_by_gdal(const AllowedName& name, unsigned flags, const char* const* drivers,
                     const char* const* siblings) {
    const Opening opening(name);
    return Dataset(GDALOpenEx(name.c_str(), flags, drivers, nullptr, siblings));
}

void CloseVsiFile::operator()(void* file) const {
    VSIFCloseL(static_cast<VSILFILE*>(file));
}

VsiFile open_vsi(const AllowedName& name) {
    return VsiFile(VSIFOpenL(name.c_str(), "rb"));
}

VSILFILE* create_by_vsi(const AllowedName& name) {
    return VSIFOpenExL(name.c_str(), "wb", /*bSetError=*/1);
}

std::string read_vsi(const AllowedName& name, std::uint64_t most) {
    constexpr std::size_t kAtOnce = std::size_t{1} << 20;
    std::string bytes;
    const VsiFile file = open_vsi(name);
    while (file && bytes.size() < most) {
        const std::size_t before = bytes.size();
        const std::size_t wanted = std::min<std::uint64_t>(kAtOnce, most - before);
        bytes.resize(before + wanted);
        bytes.resize(before + VSIFReadL(bytes.data() + before, 1, wanted,
                                        static_cast<VSILFILE*>(file.get())));
        if (bytes.size() < before + wanted) break;
    }
    return bytes;
}

std::optional<std::uint64_t> size_by_vsi(const AllowedName& name) {
    VSIStatBufL status{};
    if (VSIStatL(name.c_str(), &status) != 0 || VSI_ISDIR(status.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace relevo::dem

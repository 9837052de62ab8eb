#include "dem/regular_files.h"

#include <cerrno>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include <cpl_vsi_virtual.h>
#include <fmt/format.h>

#include "base/log.h"
#include "base/text.h"

namespace relevo::dem {
namespace {

namespace fs = std::filesystem;

/// GDAL's own files of this machine, but for what is neither file nor folder.
class RegularFiles : public VSIFilesystemHandler {
  public:
    explicit RegularFiles(VSIFilesystemHandler* all) : all_(all) {}

    VSIVirtualHandle* Open(const char* name, const char* access, bool set_error,
                           CSLConstList options) override {
        std::error_code unknown;
        const fs::file_status status = fs::status(name, unknown);
        if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
            warn_of(name);
            errno = EINVAL;
            return nullptr;
        }
        return all_->Open(name, access, set_error, options);
    }
    int Stat(const char* name, VSIStatBufL* status, int flags) override {
        return all_->Stat(name, status, flags);
    }
    int Unlink(const char* name) override { return all_->Unlink(name); }
    int Mkdir(const char* name, long mode) override { return all_->Mkdir(name, mode); }
    int Rmdir(const char* name) override { return all_->Rmdir(name); }
    char** ReadDirEx(const char* name, int most) override { return all_->ReadDirEx(name, most); }
    char** SiblingFiles(const char* name) override { return all_->SiblingFiles(name); }
    int Rename(const char* from, const char* to) override { return all_->Rename(from, to); }
    int IsCaseSensitive(const char* name) override { return all_->IsCaseSensitive(name); }
    GIntBig GetDiskFreeSpace(const char* name) override { return all_->GetDiskFreeSpace(name); }
    int SupportsSparseFiles(const char* name) override { return all_->SupportsSparseFiles(name); }
    VSIDIR* OpenDir(const char* name, int depth, const char* const* options) override {
        return all_->OpenDir(name, depth, options);
    }
    bool IsLocal(const char* name) override { return all_->IsLocal(name); }

  private:
    void warn_of(const std::string& name) {
        {
            const std::lock_guard lock(mutex_);
            if (!warned_.insert(name).second) return;
        }
        log::warning(
            fmt::format("{}: a pipe or a device, expected a file; not read", printable(name)));
    }

    std::unique_ptr<VSIFilesystemHandler> all_;
    std::mutex mutex_;
    std::set<std::string> warned_;
};

}  // namespace

void open_regular_files_only() {
    // GDAL deletes it when the process ends.
    VSIFileManager::InstallHandler("", new RegularFiles(VSIFileManager::GetHandler("")));
}

}  // namespace relevo::dem

// The module lib/relevo/gdal.so: what is done with GDAL's C++ classes.
#include "dem/gdal_module.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <dlfcn.h>
#include <gdal_priv.h>
#include <link.h>

namespace relevo::dem {
namespace {

namespace fs = std::filesystem;

/// Drivers that ask the net, or that open whatever a file names.
constexpr std::array kRemoteDrivers = {"DAAS",   "EEDA",   "EEDAI",    "GTI",      "HTTP",
                                       "NGW",    "OGCAPI", "PLMOSAIC", "PLSCENES", "PostGISRaster",
                                       "STACIT", "STACTA", "WCS",      "WMS",      "WMTS"};
using OpenFunction = GDALDataset* (*)(GDALOpenInfo*);

struct Disarmed {
    std::vector<GDALDriver*> drivers;
    std::array<OpenFunction, kRemoteDrivers.size()> opens{};  // their own
    bool (*may_ask_net)() = nullptr;
    std::vector<std::pair<std::string, VSIFilesystemHandler*>> systems;
    bool remote_allowed = false;
};

std::mutex& mutex() {
    static std::mutex one;
    return one;
}

Disarmed& disarmed() {
    // Never destroyed: it holds what GDAL has until the process ends.
    static Disarmed& all = *new Disarmed;
    return all;
}

OpenFunction netcdf_open = nullptr;
OpenFunction geopackage_open = nullptr;

/// Others that read files with HDF5.
constexpr std::array kHdf5Drivers = {"BAG", "HDF5", "HDF5Image", "KEA"};
std::array<OpenFunction, kHdf5Drivers.size()> hdf5_open{};
std::atomic<bool> hdf5_is_used = false;

/// A function of HDF5, whichever library GDAL or its plugins are linked with; null without one.
void* hdf5_function(const char* name) {
    std::vector<std::string> libraries;
    // Only names are noted in here: dlopen would wait for a thread that loads a library, which
    // waits for the list that is held here.
    dl_iterate_phdr(
        [](dl_phdr_info* library, std::size_t, void* names) {
            if (std::strstr(library->dlpi_name, "hdf5"))
                static_cast<std::vector<std::string>*>(names)->push_back(library->dlpi_name);
            return 0;
        },
        &libraries);
    for (const std::string& library : libraries)
        if (void* const loaded = dlopen(library.c_str(), RTLD_LAZY | RTLD_NOLOAD)) {
            void* const found = dlsym(loaded, name);
            dlclose(loaded);
            if (found) return found;
        }
    return nullptr;
}

/// HDF5 prints every error on standard error, also those that its callers expect. It is switched
/// off thread by thread.
void silence_hdf5() {
    thread_local bool is_silent = false;
    if (is_silent || !hdf5_is_used) return;
    is_silent = true;
    using SetPrinting = int (*)(std::int64_t stack, void* function, void* data);
    static const auto set_printing = reinterpret_cast<SetPrinting>(hdf5_function("H5Eset_auto2"));
    constexpr std::int64_t kOfThread = 0;  // H5E_DEFAULT
    if (set_printing) set_printing(kOfThread, nullptr, nullptr);
}

void use_hdf5() {
    hdf5_is_used = true;
    silence_hdf5();
}

template <std::size_t number>
GDALDataset* open_hdf5(GDALOpenInfo* info) {
    use_hdf5();
    return hdf5_open[number](info);
}

/// netCDF's library itself goes to addresses. A group of HDF5 begins "://", too.
GDALDataset* open_local_netcdf(GDALOpenInfo* info) {
    const bool address = std::strstr(info->pszFilename, "://") != nullptr;
    if (address && !disarmed().may_ask_net()) return nullptr;
    use_hdf5();
    return netcdf_open(info);
}

template <std::size_t Driver>
GDALDataset* open_if_allowed(GDALOpenInfo* info) {
    return disarmed().may_ask_net() ? disarmed().opens[Driver](info) : nullptr;
}

template <std::size_t... Drivers>
constexpr std::array<OpenFunction, sizeof...(Drivers)> gates(std::index_sequence<Drivers...>) {
    return {open_if_allowed<Drivers>...};
}

/// A virtual raster may pass options on, and this one is SQL of any kind.
GDALDataset* open_plain_geopackage(GDALOpenInfo* info) {
    if (CSLFetchNameValue(info->papszOpenOptions, "PRELUDE_STATEMENTS")) return nullptr;
    return geopackage_open(info);
}

GDALDriver* driver(const char* name) {
    return GDALDriver::FromHandle(GDALGetDriverByName(name));
}

CPLHTTPResult* fetch_nothing(const char*, CSLConstList, GDALProgressFunc, void*,
                             CPLHTTPFetchWriteFunc, void*, void*) {
    auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    result->nStatus = 1;
    result->pszErrBuf = CPLStrdup("the net is closed to files that ask for it themselves");
    return result;
}

void close_remote_systems(bool (*is_local_file_system)(std::string_view name)) {
    VSIFilesystemPluginCallbacksStruct* const nothing = VSIAllocFilesystemPluginCallbacksStruct();
    nothing->open = [](void*, const char*, const char*) -> void* {
        errno = EACCES;
        return nullptr;
    };
    char** const prefixes = VSIGetFileSystemsPrefixes();
    for (char** prefix = prefixes; prefix && *prefix; ++prefix) {
        const std::string name = *prefix;
        if (!name.starts_with("/vsi") || is_local_file_system(name)) continue;
        VSIFilesystemHandler* const handler = VSIFileManager::GetHandler(name.c_str());
        disarmed().systems.emplace_back(name, handler);
        VSIInstallPluginHandler(name.c_str(), nothing);
    }
    CSLDestroy(prefixes);
    VSIFreeFilesystemPluginCallbacksStruct(nothing);
}

/// Has HDF5 be silent wherever one of its drivers opens a file.
template <std::size_t... number>
void silence_drivers(std::index_sequence<number...>) {
    const auto wrap = [](const char* name, OpenFunction& open, OpenFunction wrapper) {
        if (GDALDriver* const found = driver(name))
            if (found->pfnOpen) open = std::exchange(found->pfnOpen, wrapper);
    };
    (wrap(kHdf5Drivers[number], hdf5_open[number], open_hdf5<number>), ...);
}

void disarm(bool (*is_local_file_system)(std::string_view name), bool (*may_ask_net)()) {
    constexpr auto kGates = gates(std::make_index_sequence<kRemoteDrivers.size()>());
    const std::lock_guard lock(mutex());
    CPLSetConfigOption("GDAL_VRT_ENABLE_PYTHON", "NO");
    disarmed().may_ask_net = may_ask_net;
    if (GDALDriver* const memory = driver("MEM")) {
        memory->pfnOpen = nullptr;
        disarmed().drivers.push_back(memory);
    }
    for (std::size_t i = 0; i < kRemoteDrivers.size(); ++i)
        if (GDALDriver* const found = driver(kRemoteDrivers[i]); found && found->pfnOpen) {
            disarmed().opens[i] = std::exchange(found->pfnOpen, kGates[i]);
            disarmed().drivers.push_back(found);
        }
    if (GDALDriver* const netcdf = driver("netCDF"))
        netcdf_open = std::exchange(netcdf->pfnOpen, open_local_netcdf);
    if (GDALDriver* const geopackage = driver("GPKG"))
        geopackage_open = std::exchange(geopackage->pfnOpen, open_plain_geopackage);
    silence_drivers(std::make_index_sequence<kHdf5Drivers.size()>());
    close_remote_systems(is_local_file_system);
    CPLHTTPSetFetchCallback(fetch_nothing, nullptr);
}

void allow_remote() {
    const std::lock_guard lock(mutex());
    Disarmed& all = disarmed();
    if (all.drivers.empty() || std::exchange(all.remote_allowed, true)) return;
    for (const auto& [name, handler] : all.systems)
        VSIFileManager::InstallHandler(name, handler);
    CPLHTTPSetFetchCallback(nullptr, nullptr);
}

std::vector<std::string> disarmed_drivers() {
    const std::lock_guard lock(mutex());
    std::vector<std::string> names;
    for (GDALDriver* const found : disarmed().drivers)
        names.emplace_back(found->GetDescription());
    return names;
}

/// GDAL's own files of this machine, but for what is neither file nor folder.
class RegularFiles : public VSIFilesystemHandler {
  public:
    RegularFiles(VSIFilesystemHandler* all, void (*skipped)(const std::string& name))
        : all_(all), skipped_(skipped) {}

    VSIVirtualHandle* Open(const char* name, const char* access, bool set_error,
                           CSLConstList options) override {
        std::error_code unknown;
        const fs::file_status status = fs::status(name, unknown);
        if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
            skipped_(name);
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
    std::unique_ptr<VSIFilesystemHandler> all_;
    void (*skipped_)(const std::string& name);
};

void open_regular_files_only(void (*skipped)(const std::string& name)) {
    // GDAL deletes it when the process ends.
    VSIFileManager::InstallHandler("", new RegularFiles(VSIFileManager::GetHandler(""), skipped));
}

}  // namespace
}  // namespace relevo::dem

extern "C" __attribute__((visibility("default"))) const relevo::dem::GdalModule*
relevo_gdal_module() {
    static const relevo::dem::GdalModule module{
        relevo::dem::disarm, relevo::dem::allow_remote, relevo::dem::disarmed_drivers,
        relevo::dem::open_regular_files_only, relevo::dem::silence_hdf5};
    return &module;
}

#include "dem/gdal.h"

#include <string>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"
#include "dem/gdal_module.h"

namespace relevo::dem {
const GdalModule& gdal_module() {
    using Entry = const GdalModule* (*)();
    static const GdalModule& module =
        *reinterpret_cast<Entry>(geo::gdal_function(kGdalModuleEntry))();
    return module;
}

GdalStrings::~GdalStrings() {
    if (list_) CSLDestroy(list_);
}

GdalStrings::GdalStrings(GdalStrings&& other) noexcept
    : list_(std::exchange(other.list_, nullptr)) {}

void GdalStrings::add(const std::string& text) {
    list_ = CSLAddString(list_, text.c_str());
}

void GdalStrings::set(const std::string& name, const std::string& value) {
    list_ = CSLSetNameValue(list_, name.c_str(), value.c_str());
}

const char* GdalStrings::find(const std::string& name) const {
    return CSLFetchNameValue(list_, name.c_str());
}

GdalCrs::GdalCrs(const std::string& text) : handle_(OSRNewSpatialReference(nullptr)) {
    OSRSetAxisMappingStrategy(handle_, OAMS_TRADITIONAL_GIS_ORDER);
    known_ = OSRSetFromUserInput(handle_, text.c_str()) == OGRERR_NONE;
}

GdalCrs::~GdalCrs() {
    if (handle_) OSRDestroySpatialReference(handle_);
}

GdalCrs::GdalCrs(GdalCrs&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)), known_(other.known_) {}

}  // namespace relevo::dem

#pragma once

#include <string>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <cpl_vsi_error.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include "base/late_function.h"
#include "geo/gdal_library.h"

/// GDAL's C functions, found in its library when they are called: whatever runs without opening a
/// raster starts without GDAL (geo/gdal_library.h). Use them as GDAL's manual says; one that is
/// missing below is an undefined reference when the program is linked.
namespace relevo {

// Types lose what GDAL says of them in attributes, such as that a result is to be used.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"
#define RELEVO_GDAL(name) \
    inline const LateFunction<decltype(::name), geo::gdal_function> name(#name)

RELEVO_GDAL(CPLDestroyXMLNode);
RELEVO_GDAL(CPLErrorReset);
RELEVO_GDAL(CPLEscapeString);
RELEVO_GDAL(CPLGetConfigOption);
RELEVO_GDAL(CPLGetErrorHandlerUserData);
RELEVO_GDAL(CPLGetLastErrorMsg);
RELEVO_GDAL(CPLGetPath);
RELEVO_GDAL(CPLGetXMLValue);
RELEVO_GDAL(CPLParseXMLFile);
RELEVO_GDAL(CPLParseXMLString);
RELEVO_GDAL(CPLPopErrorHandler);
RELEVO_GDAL(CPLProjectRelativeFilename);
RELEVO_GDAL(CPLPushErrorHandlerEx);
RELEVO_GDAL(CPLSetConfigOption);
RELEVO_GDAL(CPLSetErrorHandler);
RELEVO_GDAL(CPLSetThreadLocalConfigOption);
RELEVO_GDAL(CPLTestBool);
RELEVO_GDAL(CSLAddString);
RELEVO_GDAL(CSLCount);
RELEVO_GDAL(CSLDestroy);
RELEVO_GDAL(CSLFetchNameValue);
RELEVO_GDAL(CSLSetNameValue);

RELEVO_GDAL(VSIAllocFilesystemPluginCallbacksStruct);
RELEVO_GDAL(VSICurlPartialClearCache);
RELEVO_GDAL(VSIErrorReset);
RELEVO_GDAL(VSIFCloseL);
RELEVO_GDAL(VSIFOpenExL);
RELEVO_GDAL(VSIFOpenL);
RELEVO_GDAL(VSIFReadL);
RELEVO_GDAL(VSIFSeekL);
RELEVO_GDAL(VSIFWriteL);
RELEVO_GDAL(VSIFileFromMemBuffer);
RELEVO_GDAL(VSIFree);
RELEVO_GDAL(VSIFreeFilesystemPluginCallbacksStruct);
RELEVO_GDAL(VSIGetLastErrorMsg);
RELEVO_GDAL(VSIGetLastErrorNo);
RELEVO_GDAL(VSIGetMemFileBuffer);
RELEVO_GDAL(VSIInstallPluginHandler);
RELEVO_GDAL(VSINetworkStatsGetAsSerializedJSON);
RELEVO_GDAL(VSIReadDirRecursive);
RELEVO_GDAL(VSIStatExL);
RELEVO_GDAL(VSIStatL);
RELEVO_GDAL(VSIUnlink);

RELEVO_GDAL(GDALAddBand);
RELEVO_GDAL(GDALAllRegister);
RELEVO_GDAL(GDALClose);
RELEVO_GDAL(GDALCreate);
RELEVO_GDAL(GDALCreateCopy);
RELEVO_GDAL(GDALDataTypeIsComplex);
RELEVO_GDAL(GDALDatasetCommitTransaction);
RELEVO_GDAL(GDALDatasetCreateLayer);
RELEVO_GDAL(GDALDatasetGetLayer);
RELEVO_GDAL(GDALDatasetGetLayerCount);
RELEVO_GDAL(GDALDatasetStartTransaction);
RELEVO_GDAL(GDALFillNodata);
RELEVO_GDAL(GDALFlushCache);
RELEVO_GDAL(GDALGetBandDataset);
RELEVO_GDAL(GDALGetBlockSize);
RELEVO_GDAL(GDALGetCacheMax64);
RELEVO_GDAL(GDALGetColorEntryAsRGB);
RELEVO_GDAL(GDALGetColorEntryCount);
RELEVO_GDAL(GDALGetDataCoverageStatus);
RELEVO_GDAL(GDALGetDataTypeName);
RELEVO_GDAL(GDALGetDataTypeSizeBytes);
RELEVO_GDAL(GDALGetDatasetDriver);
RELEVO_GDAL(GDALGetDescription);
RELEVO_GDAL(GDALGetDriverByName);
RELEVO_GDAL(GDALGetDriverShortName);
RELEVO_GDAL(GDALGetFileList);
RELEVO_GDAL(GDALGetGCPCount);
RELEVO_GDAL(GDALGetGeoTransform);
RELEVO_GDAL(GDALGetMaskBand);
RELEVO_GDAL(GDALGetMaskFlags);
RELEVO_GDAL(GDALGetMetadata);
RELEVO_GDAL(GDALGetMetadataItem);
RELEVO_GDAL(GDALGetOverview);
RELEVO_GDAL(GDALGetOverviewCount);
RELEVO_GDAL(GDALGetRasterBand);
RELEVO_GDAL(GDALGetRasterBandXSize);
RELEVO_GDAL(GDALGetRasterBandYSize);
RELEVO_GDAL(GDALGetRasterColorInterpretation);
RELEVO_GDAL(GDALGetRasterColorTable);
RELEVO_GDAL(GDALGetRasterCount);
RELEVO_GDAL(GDALGetRasterDataType);
RELEVO_GDAL(GDALGetRasterNoDataValue);
RELEVO_GDAL(GDALGetRasterNoDataValueAsInt64);
RELEVO_GDAL(GDALGetRasterNoDataValueAsUInt64);
RELEVO_GDAL(GDALGetRasterOffset);
RELEVO_GDAL(GDALGetRasterScale);
RELEVO_GDAL(GDALGetRasterUnitType);
RELEVO_GDAL(GDALGetRasterXSize);
RELEVO_GDAL(GDALGetRasterYSize);
RELEVO_GDAL(GDALGetSpatialRef);
RELEVO_GDAL(GDALIdentifyDriverEx);
RELEVO_GDAL(GDALOpenEx);
RELEVO_GDAL(GDALRasterIO);
RELEVO_GDAL(GDALSetCacheMax64);
RELEVO_GDAL(GDALSetDescription);
RELEVO_GDAL(GDALSetGeoTransform);
RELEVO_GDAL(GDALSetMetadataItem);
RELEVO_GDAL(GDALSetRasterNoDataValue);
RELEVO_GDAL(GDALSetRasterOffset);
RELEVO_GDAL(GDALSetRasterScale);
RELEVO_GDAL(GDALSetRasterUnitType);
RELEVO_GDAL(GDALSetSpatialRef);
RELEVO_GDAL(GDALValidateCreationOptions);
RELEVO_GDAL(GDALVersionInfo);

RELEVO_GDAL(OGR_FD_GetFieldCount);
RELEVO_GDAL(OGR_FD_GetFieldDefn);
RELEVO_GDAL(OGR_FD_GetFieldIndex);
RELEVO_GDAL(OGR_F_Create);
RELEVO_GDAL(OGR_F_Destroy);
RELEVO_GDAL(OGR_F_GetFID);
RELEVO_GDAL(OGR_F_GetFieldAsDouble);
RELEVO_GDAL(OGR_F_GetFieldAsString);
RELEVO_GDAL(OGR_F_GetFieldDefnRef);
RELEVO_GDAL(OGR_F_GetGeometryRef);
RELEVO_GDAL(OGR_F_IsFieldSetAndNotNull);
RELEVO_GDAL(OGR_F_SetFieldString);
RELEVO_GDAL(OGR_F_SetGeometry);
RELEVO_GDAL(OGR_Fld_Create);
RELEVO_GDAL(OGR_Fld_Destroy);
RELEVO_GDAL(OGR_Fld_GetNameRef);
RELEVO_GDAL(OGR_Fld_GetType);
RELEVO_GDAL(OGR_GT_Flatten);
RELEVO_GDAL(OGR_G_DestroyGeometry);
RELEVO_GDAL(OGR_G_GetGeometryCount);
RELEVO_GDAL(OGR_G_GetGeometryRef);
RELEVO_GDAL(OGR_G_GetGeometryType);
RELEVO_GDAL(OGR_G_GetLinearGeometry);
RELEVO_GDAL(OGR_G_GetPointCount);
RELEVO_GDAL(OGR_G_GetPoints);
RELEVO_GDAL(OGR_G_HasCurveGeometry);
RELEVO_GDAL(OGR_L_CreateFeature);
RELEVO_GDAL(OGR_L_CreateField);
RELEVO_GDAL(OGR_L_GetFeatureCount);
RELEVO_GDAL(OGR_L_GetGeomType);
RELEVO_GDAL(OGR_L_GetLayerDefn);
RELEVO_GDAL(OGR_L_GetName);
RELEVO_GDAL(OGR_L_GetNextFeature);
RELEVO_GDAL(OGR_L_GetSpatialRef);
RELEVO_GDAL(OGR_L_ResetReading);
RELEVO_GDAL(OSRDestroySpatialReference);
RELEVO_GDAL(OSRExportToWktEx);
RELEVO_GDAL(OSRGetDataAxisToSRSAxisMapping);
RELEVO_GDAL(OSRGetLinearUnits);
RELEVO_GDAL(OSRGetName);
RELEVO_GDAL(OSRGetPROJVersion);
RELEVO_GDAL(OSRIsGeographic);
RELEVO_GDAL(OSRIsLocal);
RELEVO_GDAL(OSRNewSpatialReference);
RELEVO_GDAL(OSRSetAxisMappingStrategy);
RELEVO_GDAL(OSRSetFromUserInput);

#undef RELEVO_GDAL
#pragma GCC diagnostic pop

namespace dem {

/// A list of strings as GDAL's functions take and give them.
class GdalStrings {
  public:
    GdalStrings() = default;
    ~GdalStrings();
    GdalStrings(GdalStrings&& other) noexcept;
    GdalStrings& operator=(GdalStrings&&) = delete;

    void add(const std::string& text);
    /// NAME=VALUE, in the place of another value of that name.
    void set(const std::string& name, const std::string& value);
    /// Null where there is none.
    const char* find(const std::string& name) const;
    char** list() const { return list_; }

  private:
    char** list_ = nullptr;
};

/// A CRS of GDAL's, with its axes as x and y.
class GdalCrs {
  public:
    /// @param text  any form that GDAL takes: WKT, "EPSG:2056"
    explicit GdalCrs(const std::string& text);
    ~GdalCrs();
    GdalCrs(GdalCrs&& other) noexcept;
    GdalCrs& operator=(GdalCrs&&) = delete;

    /// Whether GDAL knows it.
    bool known() const { return known_; }
    OGRSpatialReferenceH handle() const { return handle_; }

  private:
    OGRSpatialReferenceH handle_;
    bool known_;
};

}  // namespace dem
}  // namespace relevo

// Names that may be opened.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/allowed_name.h"
#include "base/error.h"
#include "support/support.h"

namespace relevo::test_allowed_name {
namespace {

using ::testing::EndsWith;

/// Of the net, of standard input or of the program's memory, in many spellings.
const std::vector<std::string> kElsewhere{"/vsicurl/http://a.org/x.tif",
                                          "/vsicurl?url=http://a.org/x.tif",
                                          "/vsis3/b/x.tif",
                                          "/vsis3_streaming/b/x.tif",
                                          "/vsigs/b/x.tif",
                                          "/vsiaz/b/x.tif",
                                          "/vsihdfs/b/x.tif",
                                          "/vsistdin/",
                                          "/vsistdin?buffer_limit=-1",
                                          "/vsimem/x.tif",
                                          "/vsisparse/x.xml",
                                          "/vsisubfile/0_9,/vsicurl/http://a.org/x.tif",
                                          "/vsicached?file=/vsicurl/http://a.org/x.tif",
                                          "/vsicrypt/key=x,file=/vsis3/b/x.tif",
                                          "/vsizip//vsicurl/http://a.org/x.zip/x.tif",
                                          "/vsizip/vsicurl/http://a.org/x.zip/x.tif",
                                          "/vsizip/{/vsicurl/http://a.org/x.zip}/x.tif",
                                          "/vsizip/{vsis3/b/x.zip}/x.tif",
                                          "/vsigzip//vsizip//vsis3/b/x.zip/x.tif.gz",
                                          "/vsitar/http://a.org/x.tar/x.tif",
                                          "/vsiwhatnot/x.tif",
                                          "http://a.org/x.tif",
                                          "HTTPS://a.org/x.tif",
                                          "ftp://a.org/x.tif",
                                          "file:///etc/passwd",
                                          "folder/http://a.org/x.tif",
                                          "vrt:///vsis3/b/x.tif",
                                          "vrt://x.tif",
                                          "WMTS:http://a.org",
                                          "wms:a.org",
                                          "STACIT:\"x.json\"",
                                          "PG:host=a.org",
                                          "NETCDF:http://a.org/x.nc:z",
                                          "NETCDF:\"http://a.org/x.nc\":z",
                                          "NETCDF:/vsis3/b/x.nc:z",
                                          "HDF5:\"/vsis3/b/x.h5\"://z",
                                          "GTIFF_DIR:1:/vsis3/b/x.tif",
                                          "ZARR:\"/vsis3/b/x.zarr\":/z",
                                          "DERIVED_SUBDATASET:LOGAMPLITUDE:/vsis3/b/x.tif",
                                          "MEM:::DATAPOINTER=1,PIXELS=1,LINES=1",
                                          "<VRTDataset/>",
                                          "{\"type\": \"FeatureCollection\"}"};

const std::vector<std::string> kHere{"x.tif",
                                     "folder/x.tif",
                                     "../x.tif",
                                     "/data/x.tif",
                                     "/data/vsi/x.tif",
                                     "/data/2026-06-21T12:00.tif",
                                     "vsi/x.tif",
                                     "/vsizip/x.zip/x.tif",
                                     "/vsizip//data/x.zip/x.tif",
                                     "/vsizip/{/data/x.zip}/x.tif",
                                     "/vsigzip/x.tif.gz",
                                     "/vsigzip//vsizip//data/x.zip/x.tif.gz",
                                     "/vsitar/x.tar/x.tif",
                                     "NETCDF:x.nc:z",
                                     "NETCDF:\"/data/x.nc\":z",
                                     "HDF5:\"x.h5\"://group/z",
                                     "GTIFF_DIR:2:/data/x.tif",
                                     "GPKG:/data/x.gpkg:z"};

TEST(AllowedName, WhatAFileNamesIsOfThisMachine) {
    for (const std::string& name : kElsewhere) {
        EXPECT_FALSE(is_of_this_machine(name)) << name;
        EXPECT_FALSE(is_allowed(name)) << name;
        EXPECT_THROW(AllowedName{name}, Error) << name;
    }
    for (const std::string& name : kHere) {
        EXPECT_TRUE(is_of_this_machine(name)) << name;
        EXPECT_EQ(AllowedName(name).text(), name);
        EXPECT_FALSE(AllowedName(name).asks_net()) << name;
    }
}

TEST(AllowedName, WhatIsWrongIsSaid) {
    EXPECT_EQ(
        test::error_of([] { AllowedName("/vsis3/b/x.tif"); }),
        "exit 2: '/vsis3/b/x.tif' is not a file of this machine; name it on the command line, "
        "or add --trust");
}

TEST(AllowedName, WhatAPersonHasWrittenMayAskTheNet) {
    const std::string name = "/vsicurl/http://given.org/folder/x.vrt";
    allow_name(name);
    EXPECT_TRUE(AllowedName(name).asks_net());
    // What that file names, and what lies below a folder.
    EXPECT_TRUE(AllowedName(name).derived("/vsis3/other/x.tif").asks_net());
    allow_name("/vsis3/given/folder");
    EXPECT_TRUE(AllowedName("/vsis3/given/folder/plan.json").asks_net());
    EXPECT_FALSE(is_allowed("/vsis3/given/folder/../other/plan.json"));
    EXPECT_FALSE(is_allowed("/vsis3/given/folders"));
    EXPECT_FALSE(is_allowed("/vsis3/given"));
    EXPECT_FALSE(is_allowed(name + "x"));
    allow_word("--set=drape.file=http://given.org/y.tif");
    EXPECT_TRUE(AllowedName("http://given.org/y.tif").asks_net());
    forget_name(name);
    EXPECT_FALSE(is_allowed(name));
}

TEST(AllowedName, AFileOfThisMachineNamesNoneOfTheNet) {
    const AllowedName index("index.gpkg");
    for (const std::string& name : kElsewhere) {
        EXPECT_FALSE(index.allows(name)) << name;
        EXPECT_THROW(index.derived(name), Error) << name;
    }
    EXPECT_EQ(index.derived("/vsigzip/x.tif.gz").text(), "/vsigzip/x.tif.gz");
}

TEST(AllowedName, AFileMayHaveAColon) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(test::scratch_dir("colon"));
    std::ofstream("WMS:x.tif") << "x";
    const std::string opened = AllowedName("WMS:x.tif").text();
    std::filesystem::current_path(before);
    EXPECT_EQ(opened, "./WMS:x.tif");  // which no driver takes for its prefix
}

}  // namespace
}  // namespace relevo::test_allowed_name

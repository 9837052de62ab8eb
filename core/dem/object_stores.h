#pragma once

namespace relevo::dem {

/// Has results with names of GDAL's file systems in the net ("/vsis3/bucket/a.tif", "/vsigs/",
/// "/vsiaz/", "/vsioss/", "/vsiswift/", "/vsihdfs/", "/vsiwebhdfs/") written there. Who may write
/// is found as GDAL finds it: AWS_ACCESS_KEY_ID, ~/.aws/credentials and so on.
void use_object_stores();

}  // namespace relevo::dem

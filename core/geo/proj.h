#pragma once

#include <proj.h>

#include "base/late_function.h"
#include "geo/gdal_library.h"

/// PROJ's C functions, found in its library when they are called: see gdal_library.h. One that is
/// missing below is an undefined reference when the program is linked.
namespace relevo {

#define RELEVO_PROJ(name) \
    inline const LateFunction<decltype(::name), geo::gdal_function> name(#name)

RELEVO_PROJ(proj_as_wkt);
RELEVO_PROJ(proj_clone);
RELEVO_PROJ(proj_context_clone);
RELEVO_PROJ(proj_context_create);
RELEVO_PROJ(proj_context_destroy);
RELEVO_PROJ(proj_context_set_fileapi);
RELEVO_PROJ(proj_coord);
RELEVO_PROJ(proj_coordoperation_get_accuracy);
RELEVO_PROJ(proj_coordoperation_get_method_info);
RELEVO_PROJ(proj_coordoperation_has_ballpark_transformation);
RELEVO_PROJ(proj_create);
RELEVO_PROJ(proj_create_crs_to_crs);
RELEVO_PROJ(proj_create_crs_to_crs_from_pj);
RELEVO_PROJ(proj_crs_get_coordinate_system);
RELEVO_PROJ(proj_crs_get_coordoperation);
RELEVO_PROJ(proj_crs_get_datum_forced);
RELEVO_PROJ(proj_crs_get_sub_crs);
RELEVO_PROJ(proj_crs_info_list_destroy);
RELEVO_PROJ(proj_cs_get_axis_count);
RELEVO_PROJ(proj_cs_get_axis_info);
RELEVO_PROJ(proj_cs_get_type);
RELEVO_PROJ(proj_destroy);
RELEVO_PROJ(proj_ellipsoid_get_parameters);
RELEVO_PROJ(proj_get_crs_info_list_from_database);
RELEVO_PROJ(proj_get_crs_list_parameters_create);
RELEVO_PROJ(proj_get_crs_list_parameters_destroy);
RELEVO_PROJ(proj_get_ellipsoid);
RELEVO_PROJ(proj_get_id_auth_name);
RELEVO_PROJ(proj_get_id_code);
RELEVO_PROJ(proj_get_name);
RELEVO_PROJ(proj_get_source_crs);
RELEVO_PROJ(proj_get_type);
RELEVO_PROJ(proj_is_crs);
RELEVO_PROJ(proj_is_equivalent_to);
RELEVO_PROJ(proj_log_func);
RELEVO_PROJ(proj_log_level);
RELEVO_PROJ(proj_normalize_for_visualization);
RELEVO_PROJ(proj_trans);
RELEVO_PROJ(proj_trans_get_last_used_operation);

#undef RELEVO_PROJ

}  // namespace relevo

# SPDX-License-Identifier: Apache-2.0
# libccd without its exported target, which names an absolute libm and so cannot be used in a sysroot.
find_path(CCD_INCLUDE_DIR ccd/ccd.h)
find_library(CCD_LIBRARY ccd)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ccd REQUIRED_VARS CCD_LIBRARY CCD_INCLUDE_DIR)
if(Ccd_FOUND AND NOT TARGET Ccd::ccd)
  add_library(Ccd::ccd UNKNOWN IMPORTED)
  set_target_properties(Ccd::ccd PROPERTIES IMPORTED_LOCATION ${CCD_LIBRARY}
                                            INTERFACE_INCLUDE_DIRECTORIES ${CCD_INCLUDE_DIR}
                                            INTERFACE_LINK_LIBRARIES m)
endif()

# SPDX-License-Identifier: Apache-2.0
# liblcm as the distribution ships it: no CMake package, and an lcm.pc that asks for glib's headers, which we do not need.
find_path(LCM_INCLUDE_DIR lcm/lcm.h)
find_library(LCM_LIBRARY lcm)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Lcm REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR)
if(Lcm_FOUND AND NOT TARGET Lcm::lcm)
  add_library(Lcm::lcm UNKNOWN IMPORTED)
  set_target_properties(Lcm::lcm PROPERTIES IMPORTED_LOCATION ${LCM_LIBRARY}
                                            INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()

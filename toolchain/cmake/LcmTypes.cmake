# SPDX-License-Identifier: Apache-2.0
# mapweld_lcm_types(TARGET file.lcm ...): generated C++ headers in the build tree, never in the source tree.
find_program(LCM_GEN lcm-gen REQUIRED)
find_path(LCM_CORETYPES_DIR lcm/lcm_coretypes.h REQUIRED)

function(mapweld_lcm_types target)
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/include)
  set(headers "")
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME_WE)
    set(header ${dir}/mapweldlcm/${name}.hpp)
    add_custom_command(OUTPUT ${header} COMMAND ${LCM_GEN} --cpp --cpp-std=c++11 --cpp-hpath ${dir}
                               ${CMAKE_CURRENT_SOURCE_DIR}/${file}
                       DEPENDS ${file} COMMENT "lcm-gen ${file}" VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${target}_generate DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_generate)
  target_include_directories(${target} SYSTEM INTERFACE $<BUILD_INTERFACE:${dir}> $<BUILD_INTERFACE:${LCM_CORETYPES_DIR}>
                                                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/mapweld>)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mapweld/mapweldlcm)
  install(FILES ${ARGN} DESTINATION ${CMAKE_INSTALL_DATADIR}/mapweld/lcmtypes)
  install(TARGETS ${target} EXPORT mapweld)
endfunction()

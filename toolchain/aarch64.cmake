# SPDX-License-Identifier: Apache-2.0
# Cross-compiles the agent for 64-bit ARM with the distribution's compiler. Libraries come from the folder that
# toolchain/fetch_sysroot fills, header-only packages (Eigen) and build tools (lcm-gen) from this machine:
#   apt-get install g++-aarch64-linux-gnu && toolchain/fetch_sysroot && cmake --preset aarch64
# MAPWELD_SYSROOT, as environment variable or cache entry, names another folder.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

if(NOT MAPWELD_SYSROOT)
  if(DEFINED ENV{MAPWELD_SYSROOT})
    set(MAPWELD_SYSROOT $ENV{MAPWELD_SYSROOT})
  else()
    cmake_path(SET MAPWELD_SYSROOT NORMALIZE "${CMAKE_CURRENT_LIST_DIR}/../build/sysroot-aarch64")
  endif()
endif()
set(MAPWELD_SYSROOT "${MAPWELD_SYSROOT}" CACHE PATH "unpacked libraries of the target")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MAPWELD_SYSROOT)
if(NOT EXISTS "${MAPWELD_SYSROOT}/usr")
  message(FATAL_ERROR "no libraries for aarch64 in ${MAPWELD_SYSROOT}: run toolchain/fetch_sysroot first")
endif()

set(CMAKE_FIND_ROOT_PATH "${MAPWELD_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${MAPWELD_SYSROOT}/usr/lib/aarch64-linux-gnu:${MAPWELD_SYSROOT}/lib/aarch64-linux-gnu")

# Tests run under emulation with the same C library as on a vehicle computer. The one that comes with the cross compiler
# is older and hangs in pthread_create there.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L ${MAPWELD_SYSROOT})

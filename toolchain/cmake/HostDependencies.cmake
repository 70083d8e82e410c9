# SPDX-License-Identifier: Apache-2.0
# What the host programs need beyond the agent's libraries.
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(PNG REQUIRED)
find_package(Lcm REQUIRED)
find_package(nanoflann REQUIRED)
find_package(Threads REQUIRED)

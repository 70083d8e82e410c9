// SPDX-License-Identifier: Apache-2.0
// mapweld-agent: options, boot, seal the heap, run.
#include <sys/mman.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "drivers/spool/boot_epoch.hpp"
#include "firmware-like/fault.hpp"
#include "firmware-like/heap_seal.hpp"
#include "firmware-like/memory_map.hpp"
#include "firmware-like/options.hpp"

namespace {

using mapweld::executive::AgentMemory;
using mapweld::executive::ParseOutcome;

constexpr int kExitOptions = 2;
constexpr int kExitResource = 3;

alignas(AgentMemory) std::byte g_memory[sizeof(AgentMemory)];

int Fail(int code, const char* message) {
  std::fprintf(stderr, "mapweld-agent: %s\n", message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  const auto parsed = mapweld::executive::ParseOptions(argc, argv);
  if (parsed.outcome == ParseOutcome::kError) return Fail(kExitOptions, parsed.message);
  if (parsed.outcome == ParseOutcome::kHelp) return std::fputs(mapweld::executive::kHelpText, stdout) < 0 ? 1 : 0;
  if (parsed.outcome == ParseOutcome::kVersion) return std::puts("mapweld-agent " MAPWELD_VERSION) < 0 ? 1 : 0;

  const auto& options = parsed.options;
  mapweld::executive::InstallFaultRecorder(options.state_dir);
  char message[512];
  const auto epoch = mapweld::spool::NextBootEpoch(options.state_dir);
  if (!epoch.ok()) {
    std::snprintf(
        message, sizeof(message),
        "cannot keep the boot count in %s: %s; create the directory or give another --state-dir", options.state_dir,
        epoch.status() == mapweld::Status::kIo ? std::strerror(errno) : "the file 'epoch' there holds no count");
    return Fail(kExitResource, message);
  }
  AgentMemory* const memory = new (g_memory) AgentMemory(options, epoch.value());
  if (!memory->agent.Boot(message)) return Fail(kExitResource, message);

  // Page faults are as slow as allocations; without the right to lock, the agent still runs.
  if (mlockall(MCL_CURRENT) != 0) std::fputs("mapweld-agent: memory is not locked (needs CAP_IPC_LOCK)\n", stderr);
  std::fprintf(stderr, "mapweld-agent: agent %d, boot %d, %.1f MiB of static memory, LiDAR on port %d, IMU from %s\n",
               options.agent_id, epoch.value(), static_cast<double>(sizeof(AgentMemory)) / (1 << 20),
               static_cast<int>(options.lidar_port),
               options.can_interface != nullptr ? options.can_interface : options.candump_path);

  mapweld::executive::SealHeap(std::getenv("MAPWELD_HEAP_ABORT") != nullptr);
  memory->agent.Run();

  const auto& counters = memory->agent.pipeline().counters();
  std::snprintf(message, sizeof(message), "agent %d ended: %.0f m, %llu scans, %llu keyframes, %lld heap calls",
                options.agent_id, memory->agent.pipeline().path_m(), static_cast<unsigned long long>(counters.scans),
                static_cast<unsigned long long>(counters.keyframes),
                static_cast<long long>(mapweld::executive::HeapCallsAfterSeal()));
  memory->~AgentMemory();
  return Fail(0, message);
}

// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/replay_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>

#include "tools/replay/replay_drive.hpp"

namespace mapweld::replay {

int RunReplay(const ReplayOptions& options) {
  try {
    Recording recording(options.dir, !options.network.can_interface.empty());
    NetworkLink link(options.network);
    double next_report_s = 10;
    const auto progress = [&](double recorded_s) {
      if (recorded_s < next_report_s) return;
      fmt::print(stderr, "agent {}: {:.0f} s replayed\n", options.network.agent_id, next_report_s);
      next_report_s += 10;
    };
    const ReplaySummary s = ReplayDrive(recording, link, options.realtime, ReplayLimits{}, progress);
    if (recording.truncated()) {
      fmt::print(stderr, "mapweld replay: {} breaks off within a packet; everything before it was replayed\n",
                 (options.dir / "lidar.pcap").string());
    }
    if (s.packets + s.packets_lost == 0) {
      throw std::runtime_error(fmt::format("{} holds no UDP datagram in one piece to port {}",
                                           (options.dir / "lidar.pcap").string(), fmt::join(kLidarPorts, " or ")));
    }
    fmt::print(
        "agent {}: {} LiDAR packets, {} CAN frames, {} and {} lost, {:.1f} s of recording in {:.1f} s, {:.1f} times "
        "real time\n",
        options.network.agent_id, s.packets, s.frames, s.packets_lost, s.frames_lost, s.recorded_s, s.wall_s,
        s.recorded_s / std::max(s.wall_s, 1e-3));
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "mapweld replay: {}\n", e.what());
    return 1;
  }
}

void AddReplayCommand(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "Play a recorded drive to an agent over UDP, CAN and LCM");
  command->add_option("dir", options->dir, "Folder with lidar.pcap and imu.candump")->required();
  command->add_option("--agent", options->network.agent_id, "The agent's id")->required()->check(CLI::Range(1, 32767));
  command->add_option("--lidar-port", options->network.lidar_port, "UDP port of the LiDAR data")->capture_default_str();
  command->add_option("--host", options->network.host, "The agent's machine")->capture_default_str();
  command->add_option("--can", options->network.can_interface, "Send the CAN frames to this interface");
  command->add_flag("--realtime", options->realtime, "Keep the recorded pace instead of the agent's");
  command->add_option("--lcm-url", options->network.lcm_url, "LCM network (default: LCM_DEFAULT_URL, else LCM's own)");
  command->callback([options] {
    if (const int code = RunReplay(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace mapweld::replay

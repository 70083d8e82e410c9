// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/doctor_command.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/config/capacity.hpp"
#include "drivers/can/socketcan_port.hpp"
#include "drivers/lidar/udp_port.hpp"
#include "tools/doctor/can_checks.hpp"
#include "tools/doctor/host_checks.hpp"
#include "tools/doctor/ip_command.hpp"
#include "tools/doctor/network_checks.hpp"

namespace mapweld::doctor {
namespace {

// What the agent on this machine is, or will be, started with.
struct DoctorOptions {
  std::string can_interface;
  double imu_hz = 400;
  std::string imu_ids;
  std::string imu_dbc;
  std::string imu_signals;
  int lidar_port = 2368;
  std::string lcm_url;
  std::string state_dir;
  std::uint64_t spool_mib = 256;
  bool json = false;
};

std::string DefaultUrl() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && url[0] != '\0' ? url : "udpm://239.255.76.67:7667?ttl=0";
}

std::vector<CanMessage> MessagesOf(const DoctorOptions& options) {
  if (options.imu_dbc.empty()) return XsensMessages(options.imu_ids);
  std::ifstream in(options.imu_dbc, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + options.imu_dbc);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return DbcMessages(text, options.imu_signals);
}

std::vector<Finding> CanFindings(const DoctorOptions& options) {
  const std::vector<CanMessage> messages = MessagesOf(options);
  std::vector<Finding> findings{CheckCanKernel()};
  if (findings.back().verdict != Verdict::kGood) return findings;
  std::string complaint;
  const auto links = RunIp({"-details", "-statistics", "link", "show", "dev", options.can_interface}, &complaint);
  for (Finding& finding : CheckCan(options.can_interface, ReadCanLink(links), messages, options.imu_hz)) {
    findings.push_back(std::move(finding));
  }
  findings.push_back(CheckReceiveBuffer("CAN", can::SocketCanPort::kReceiveBufferBytes));
  return findings;
}

std::vector<Finding> NetworkFindings(const DoctorOptions& options) {
  bus::UdpmAddress address;
  if (bus::ParseLcmUrl(options.lcm_url, &address) != Status::kOk) {
    return {{"LCM URL", Verdict::kFailure, fmt::format("'{}' is none", options.lcm_url),
             "export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=1'"}};
  }
  std::string complaint;
  const auto routes = RunIp({"route", "get", GroupText(address)}, &complaint);
  std::string unused;
  const std::string by_default = Device(RunIp({"route", "show", "default"}, &unused));
  const std::string outward = by_default.empty() ? "eth0" : by_default;
  std::vector<Finding> findings{CheckRoute(address, routes, complaint, outward), CheckTtl(address, routes, outward)};
  // Without a route no message can arrive.
  if (findings.front().verdict == Verdict::kGood) findings.push_back(CheckLoopback(address));
  findings.push_back(CheckReceiveBuffer("LCM", static_cast<int>(address.receive_buffer_bytes)));
  findings.push_back(CheckReceiveBuffer("LiDAR", lidar::UdpPort::kReceiveBufferBytes));
  findings.push_back(CheckLidarPort(options.lidar_port));
  return findings;
}

void Run(const DoctorOptions& options) {
  std::vector<Finding> findings;
  const auto add = [&](std::vector<Finding> more) { findings.insert(findings.end(), more.begin(), more.end()); };
  if (!options.can_interface.empty()) add(CanFindings(options));
  add(NetworkFindings(options));
  add({CheckClockSource(), CheckMemoryLock(kRamBudgetBytes)});
  if (!options.state_dir.empty()) add({CheckStateDirectory(options.state_dir, options.spool_mib << 20U)});
  fmt::print("{}", options.json ? FindingsJson(findings) : FindingsText(findings));
  if (ExitCode(findings) != 0) throw CLI::RuntimeError(ExitCode(findings));
}

}  // namespace

void AddDoctorCommand(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("doctor", "Check this machine for an agent and print the command that repairs each fault");
  const auto options = std::make_shared<DoctorOptions>();
  options->lcm_url = DefaultUrl();
  command->add_option("--can", options->can_interface, "SocketCAN interface with the IMU (CAN is not checked without)")
      ->check([](const std::string& name) {
        constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
        const bool good = !name.empty() && name.size() < 16 && name.find_first_not_of(kAllowed) == std::string::npos;
        return good && name[0] != '-' ? std::string() : "'" + name + "' is not the name of an interface";
      });
  command->add_option("--imu-hz", options->imu_hz, "samples per second that the IMU is set to")
      ->check(CLI::Range(1.0, 10'000.0))
      ->capture_default_str();
  command->add_option("--imu-ids", options->imu_ids, "the MTi's identifiers, as for the agent");
  CLI::Option* const dbc =
      command->add_option("--imu-dbc", options->imu_dbc, "the IMU's CAN database, as for the agent");
  CLI::Option* const signals =
      command->add_option("--imu-signals", options->imu_signals, "its six signals, as for the agent");
  dbc->needs(signals);
  signals->needs(dbc);
  command->add_option("--lidar-port", options->lidar_port, "UDP port of the LiDAR's data packets")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  command->add_option("--lcm-url", options->lcm_url, "LCM network (LCM_DEFAULT_URL, else LCM's default)");
  command->add_option("--state-dir", options->state_dir, "the agent's state directory (not checked without)");
  command->add_option("--spool-mib", options->spool_mib, "size of its spool")->check(CLI::Range(1, 1 << 20));
  command->add_flag("--json", options->json, "for programs, see docs/wire.md");
  command->callback([options] { Run(*options); });
}

}  // namespace mapweld::doctor

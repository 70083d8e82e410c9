// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/can_checks.hpp"

#include <gtest/gtest.h>

namespace mapweld::doctor {
namespace {

// What `ip -json -details -statistics link show dev can0` says of a controller, shortened.
nlohmann::json Controller() {
  return nlohmann::json::parse(R"([{"ifindex":3,"ifname":"can0","flags":["NOARP","UP","LOWER_UP","ECHO"],"mtu":16,
    "operstate":"UP","link_type":"can","linkinfo":{"info_kind":"can","info_data":{"state":"ERROR-ACTIVE",
    "berr_counter":{"tx":0,"rx":0},"restart_ms":100,"bittiming":{"bitrate":500000,"sample_point":"0.875"},
    "clock":8000000},"info_xstats":{"restarts":0,"bus_error":0,"arbitration_lost":0,"error_warning":0,
    "error_passive":0,"bus_off":2}},"stats64":{"rx":{"packets":7}}}])");
}

std::vector<Finding> Check(const nlohmann::json& links, double hz = 400) {
  return CheckCan("can0", ReadCanLink(links), XsensMessages(), hz);
}

nlohmann::json With(const std::string& pointer, const nlohmann::json& value) {
  nlohmann::json links = Controller();
  links[nlohmann::json::json_pointer(pointer)] = value;
  return links;
}

TEST(CanChecks, AreContentWithAHealthyBus) {
  const auto findings = Check(Controller());
  ASSERT_EQ(findings.size(), 4U);
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.verdict, Verdict::kGood) << finding.what;
    EXPECT_EQ(finding.repair, "");
  }
  EXPECT_EQ(ExitCode(findings), 0);
}

TEST(CanChecks, MissAnInterfaceThatIsNotThereOrIsNoCan) {
  EXPECT_EQ(ExitCode(Check(nlohmann::json::array())), 1);
  EXPECT_EQ(ExitCode(Check(With("/0/link_type", "ether"))), 1);
}

TEST(CanChecks, BringUpAnInterfaceThatIsDownWithABitRateThatFits) {
  const auto findings = Check(With("/0/flags", nlohmann::json::array({"NOARP", "ECHO"})));
  ASSERT_EQ(ExitCode(findings), 1);
  EXPECT_EQ(findings[0].repair, "ip link set can0 down; ip link set can0 up type can bitrate 500000 restart-ms 100");
}

TEST(CanChecks, TellAPassiveBusFromOneThatIsOff) {
  EXPECT_EQ(ExitCode(Check(With("/0/linkinfo/info_data/state", "BUS-OFF"))), 1);
  const auto passive = Check(With("/0/linkinfo/info_data/state", "ERROR-PASSIVE"));
  EXPECT_EQ(ExitCode(passive), 0);
  EXPECT_EQ(passive[1].verdict, Verdict::kWarning);
}

TEST(CanChecks, WarnOfABusThatNeverComesBack) {
  const auto findings = Check(With("/0/linkinfo/info_data/restart_ms", 0));
  EXPECT_EQ(findings[2].verdict, Verdict::kWarning);
  EXPECT_NE(findings[2].repair.find("restart-ms 100"), std::string::npos);
}

TEST(CanChecks, MeasureTheBitRateAgainstWhatTheImuSends) {
  const auto verdict = [](int bitrate, double hz) {
    return Check(With("/0/linkinfo/info_data/bittiming/bitrate", bitrate), hz).back().verdict;
  };
  EXPECT_EQ(verdict(125'000, 400), Verdict::kFailure) << "198 kbit/s do not fit";
  EXPECT_EQ(verdict(250'000, 400), Verdict::kWarning) << "79 %";
  EXPECT_EQ(verdict(250'000, 200), Verdict::kGood);
  EXPECT_EQ(verdict(500'000, 400), Verdict::kGood);
  EXPECT_EQ(verdict(1'000'000, 4000), Verdict::kFailure);
}

TEST(CanChecks, AskNoBitRateOfAVirtualBus) {
  const auto findings = Check(nlohmann::json::parse(
      R"([{"ifname":"vcan0","flags":["NOARP","UP","LOWER_UP"],"link_type":"can","linkinfo":{"info_kind":"vcan"}}])"));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].verdict, Verdict::kGood);
}

}  // namespace
}  // namespace mapweld::doctor

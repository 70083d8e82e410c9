// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/output_file.hpp"
#include "tools/sim/pcap_writer.hpp"

namespace mapweld::sim {
namespace {

std::uint8_t At(const std::string& bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes.at(i));
}

TEST(PcapWriter, WritesADatagramWithAllItsHeaders) {
  const TestFolder folder;
  std::vector<std::uint8_t> payload(1206, 0x5A);
  PcapWriter pcap(folder / "a.pcap", 2368);
  pcap.Write(601'001'327'104, payload);
  pcap.Close();
  const std::string file = ReadText(folder / "a.pcap");
  ASSERT_EQ(file.size(), 24U + 16 + 14 + 20 + 8 + 1206);
  EXPECT_EQ(file.substr(0, 4), std::string("\x4D\x3C\xB2\xA1", 4));
  EXPECT_EQ(At(file, 24) + 256 * At(file, 25), 601);
  EXPECT_EQ(At(file, 28) + 256 * At(file, 29) + 65536 * At(file, 30), 1'327'104);
  EXPECT_EQ(At(file, 32) + 256 * At(file, 33), 1248);
  const std::size_t ip = 24 + 16 + 14;
  std::uint32_t sum = 0;  // a valid header sums to all ones
  for (std::size_t i = 0; i < 20; i += 2) sum += At(file, ip + i) * 256U + At(file, ip + i + 1);
  EXPECT_EQ((sum & 0xFFFF) + (sum >> 16U), 0xFFFFU);
  EXPECT_EQ(At(file, ip + 2) * 256 + At(file, ip + 3), 1234);
  EXPECT_EQ(At(file, ip + 22) * 256 + At(file, ip + 23), 2368);
  EXPECT_EQ(At(file, ip + 24) * 256 + At(file, ip + 25), 1214);
  EXPECT_EQ(At(file, file.size() - 1), 0x5A);
}

TEST(OutputFile, SaysWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string message = MessageOf([] {
    OutputFile file("/dev/full");
    file.Write("text");
    file.Close();
  });
  EXPECT_THAT(message, testing::AllOf(testing::HasSubstr("/dev/full"), testing::HasSubstr("No space left"),
                                      testing::HasSubstr("-o")));
}

TEST(OutputFile, NamesAFolderThatDoesNotExist) {
  EXPECT_THAT(MessageOf([] { OutputFile file("/nonexistent-folder/x"); }), testing::HasSubstr("/nonexistent-folder/x"));
}

}  // namespace
}  // namespace mapweld::sim

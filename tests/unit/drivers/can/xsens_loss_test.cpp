// SPDX-License-Identifier: Apache-2.0
// No sample may ever be built from the frames of two groups, whatever gets lost on the way.
#include <gtest/gtest.h>

#include <random>

#include "drivers/can/xsens_codec.hpp"
#include "tests/unit/drivers/can/xsens_frames.hpp"

namespace mapweld::can {
namespace {

enum class Evidence { kStamps, kGapFlag };

struct LossCase {
  Evidence evidence;
  double loss_begins;  // probability per frame
  double loss_ends;
};

class XsensLoss : public testing::TestWithParam<LossCase> {};

TEST_P(XsensLoss, NeverMixesGroupsAndKeepsWhatIsWhole) {
  const LossCase parameter = GetParam();
  std::mt19937 random(42);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  XsensCodec codec({});
  bool losing = false;
  bool lost_before = false;
  int whole = 0;
  int samples = 0;
  constexpr int kGroups = 200'000;
  for (int k = 0; k < kGroups; ++k) {
    // The group's number is in its data, so that a mixture shows.
    const int mark = k % 8000;
    const auto group = test::Group({.ticks = static_cast<std::uint32_t>(25 * k),
                                    .counter = static_cast<std::uint16_t>(k),
                                    .gyro = {mark, 0, 0},
                                    .accel = {mark, 0, 0},
                                    .receive_ns = parameter.evidence == Evidence::kStamps ? 1 + k * 2'500'000LL : 0});
    std::size_t delivered = 0;
    for (CanFrame frame : group) {
      losing = losing ? uniform(random) >= parameter.loss_ends : uniform(random) < parameter.loss_begins;
      if (losing) {
        lost_before = true;
        continue;
      }
      frame.gap = lost_before && parameter.evidence == Evidence::kGapFlag;
      lost_before = false;
      ++delivered;
      sensor::ImuSample sample;
      if (codec.Push(frame, &sample) != Status::kOk) continue;
      ++samples;
      ASSERT_EQ(sample.t.ns, k * 2'500'000LL);
      ASSERT_EQ(sample.gyro_body.x() * 512, mark);
      ASSERT_EQ(sample.accel_body.x() * 256, mark);
    }
    whole += delivered == group.size() ? 1 : 0;
  }
  // A group without its StatusWord is still good, so there may be more samples than groups that came through whole.
  EXPECT_GE(samples, whole * 99 / 100);
  EXPECT_GT(samples, 0);
}

INSTANTIATE_TEST_SUITE_P(Losses, XsensLoss,
                         testing::Values(LossCase{Evidence::kStamps, 0.001, 0.5},
                                         LossCase{Evidence::kStamps, 0.02, 0.5}, LossCase{Evidence::kStamps, 0.01, 0.1},
                                         LossCase{Evidence::kStamps, 0.1, 0.3}, LossCase{Evidence::kGapFlag, 0.02, 0.5},
                                         LossCase{Evidence::kGapFlag, 0.1, 0.3}));

}  // namespace
}  // namespace mapweld::can

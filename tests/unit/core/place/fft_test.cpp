// SPDX-License-Identifier: Apache-2.0
#include "core/place/fft.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/place/trig_table.hpp"
#include "tests/unit/core/place/made_up_town.hpp"

namespace mapweld::place {
namespace {

TEST(Fft, AgreesWithTheDefiningSum) {
  constexpr std::size_t kN = 64;
  testing::Dice dice(1);
  std::array<Complex, kN> x{};
  for (Complex& c : x) c = {dice.Between(-1, 1), dice.Between(-1, 1)};
  std::array<Complex, kN> fast = x;
  Fft<kN>(fast);
  for (std::size_t k = 0; k < kN; ++k) {
    std::complex<double> sum = 0;
    for (std::size_t n = 0; n < kN; ++n) {
      const double angle = -2 * std::numbers::pi * static_cast<double>(k * n) / kN;
      sum += std::complex<double>(static_cast<double>(x[n].re), static_cast<double>(x[n].im)) * std::polar(1.0, angle);
    }
    EXPECT_NEAR(fast[k].re, sum.real(), 1e-5) << "bin " << k;
    EXPECT_NEAR(fast[k].im, sum.imag(), 1e-5) << "bin " << k;
  }
}

TEST(TrigTable, AgreesWithTheMathLibrary) {
  constexpr auto kTable = MakeTrigTable<256>();
  for (std::size_t i = 0; i < 256; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / 256;
    EXPECT_NEAR(kTable.sine[i], std::sin(angle), 1e-7) << i;
    EXPECT_NEAR(kTable.cosine[i], std::cos(angle), 1e-7) << i;
  }
}

TEST(DirectionTable, HasTheFourQuartersExactly) {
  constexpr auto kTable = MakeDirectionTable<64>();
  constexpr std::int32_t kOne = 1 << kDirectionShift;
  EXPECT_EQ(kTable.x[0], kOne);
  EXPECT_EQ(kTable.y[0], 0);
  EXPECT_EQ(kTable.x[16], 0);
  EXPECT_EQ(kTable.y[16], kOne);
  EXPECT_EQ(kTable.x[32], -kOne);
  EXPECT_EQ(kTable.y[48], -kOne);
}

}  // namespace
}  // namespace mapweld::place

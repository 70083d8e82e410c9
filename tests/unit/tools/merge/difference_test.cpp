// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/difference.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tools/merge/cosine_kernel.hpp"

namespace mapweld::merge {
namespace {

// Bytes over the whole range, -128 included; every seventh keyframe has no description.
Drive RandomDrive(std::size_t keyframes, unsigned seed) {
  std::mt19937 random(seed);
  Drive drive;
  drive.keyframes.resize(keyframes);
  for (std::size_t i = 0; i < keyframes; ++i) {
    for (std::int8_t& q : drive.keyframes[i].place.descriptor.q) q = static_cast<std::int8_t>(random());
    drive.keyframes[i].place.descriptor.scale = i % 7 == 3 ? 0 : 0.001F;
  }
  return drive;
}

// Descriptors of nothing but the largest numbers: what saturates in 16 bits would show.
Drive ExtremeDrive(std::size_t keyframes) {
  Drive drive = RandomDrive(keyframes, 9);
  for (Keyframe& keyframe : drive.keyframes) {
    for (std::int8_t& q : keyframe.place.descriptor.q) q = static_cast<std::int8_t>(q > 0 ? 127 : -128);
  }
  return drive;
}

void ExpectSameBits(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols) {
  const std::size_t stride = static_cast<std::size_t>(cols.size()) + 5;
  constexpr std::int16_t kUntouched = 12345;
  std::vector<std::int16_t> expected(stride * static_cast<std::size_t>(rows.size()), kUntouched);
  kernels::CosinesPortable(a, rows, b, cols, expected.data(), stride);
  for (const CosineKernel& kernel : CosineKernels()) {
    std::vector<std::int16_t> found(expected.size(), kUntouched);
    kernel.compute(a, rows, b, cols, found.data(), stride);
    EXPECT_EQ(found, expected) << kernel.name << ", rows " << rows.begin << " to " << rows.end << ", cols "
                               << cols.begin << " to " << cols.end;
  }
}

TEST(CosineKernels, GiveTheBitsOfThePlainLoopForEveryShape) {
  const DescriptorSet a = CollectDescriptors(RandomDrive(131, 1));
  const DescriptorSet b = CollectDescriptors(RandomDrive(83, 2));
  for (const int rows : {1, 5, 6, 12, 13, 97, 131}) {
    for (const int cols : {1, 7, 8, 16, 31, 33, 83}) ExpectSameBits(a, {0, rows}, b, {0, cols});
  }
  ExpectSameBits(a, {40, 131}, b, {11, 70});
  ExpectSameBits(a, {40, 40}, b, {11, 70});
}

TEST(CosineKernels, DoNotSaturate) {
  const DescriptorSet a = CollectDescriptors(ExtremeDrive(40));
  ExpectSameBits(a, {0, 40}, a, {0, 40});
}

TEST(Cosines, AreOneBetweenEqualPlacesAndZeroWithoutADescription) {
  Drive a;
  a.keyframes.resize(3);
  for (std::size_t i = 0; i < 1024; ++i) {
    a.keyframes[0].place.descriptor.q[i] = static_cast<std::int8_t>((i * 37) % 251 - 125);
    a.keyframes[1].place.descriptor.q[i] = static_cast<std::int8_t>(-a.keyframes[0].place.descriptor.q[i]);
  }
  a.keyframes[0].place.descriptor.scale = a.keyframes[1].place.descriptor.scale = 0.001F;
  const DescriptorSet set = CollectDescriptors(a);
  const Cosines cosines = ComputeCosines(set, set);
  EXPECT_EQ(cosines.at(0, 0), kCosineUnit);
  EXPECT_EQ(cosines.at(0, 1), -kCosineUnit);
  EXPECT_EQ(cosines.at(2, 0), 0);
  EXPECT_EQ(cosines.at(2, 2), 0);
  const DifferenceMatrix image = ToImage(cosines, 3, 5);
  EXPECT_EQ(image.distance[0], 0);
  EXPECT_EQ(image.distance[1], 255);
  EXPECT_EQ(image.distance[8], 255);
  EXPECT_EQ(image.drive_b, 5);
}

TEST(Cosines, OfDrivesThatGrewAreThoseFromNothing) {
  const Drive a = RandomDrive(60, 3);
  const Drive b = RandomDrive(45, 4);
  Drive a_before = a;
  Drive b_before = b;
  a_before.keyframes.resize(37);
  b_before.keyframes.resize(29);
  const Cosines before = ComputeCosines(CollectDescriptors(a_before), CollectDescriptors(b_before));
  const Cosines grown = GrowCosines(before, CollectDescriptors(a), CollectDescriptors(b));
  EXPECT_EQ(grown.c, ComputeCosines(CollectDescriptors(a), CollectDescriptors(b)).c);
  EXPECT_TRUE(GrowCosines({}, CollectDescriptors(a), CollectDescriptors(Drive{})).c.empty());
}

}  // namespace
}  // namespace mapweld::merge

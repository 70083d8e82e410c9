// SPDX-License-Identifier: Apache-2.0
#include "core/nn/model_blob.hpp"

#include <gtest/gtest.h>

#include "tests/support/made_up_model.hpp"

namespace mapweld::nn {
namespace {

constexpr std::size_t kFirstEntry = ModelBlob::kHeaderBytes;
constexpr std::size_t kSecondEntry = kFirstEntry + ModelBlob::kEntryBytes;

std::vector<std::uint8_t> TwoTensors() {
  return MakeUpModel("test-1", {{"a.weight", TensorType::kInt8, {1, 2, 8, 4}, std::vector<std::uint8_t>(64, 0x81)},
                                {"a.bias", TensorType::kInt32, {3}, {1, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0, 1, 0, 0}}});
}

// Changes one number, repairs the checksum and expects the reason.
void ExpectFault(std::size_t at, std::uint32_t value, BlobFault fault, Status status) {
  std::vector<std::uint8_t> blob = TwoTensors();
  PutNumber(blob, at, value);
  PutNumber(blob, 16, Crc32(std::span(blob).subspan(20)));
  const AlignedCopy copy(blob);
  ModelBlob model;
  EXPECT_EQ(model.Open(copy.bytes()), status) << at;
  EXPECT_EQ(model.fault(), fault) << at << ": " << BlobFaultName(model.fault());
  EXPECT_EQ(model.tensors(), 0U);
}

TEST(ModelBlob, FindsTensorsByNameTypeAndShape) {
  const AlignedCopy blob(TwoTensors());
  ModelBlob model;
  ASSERT_EQ(model.Open(blob.bytes()), Status::kOk) << BlobFaultName(model.fault());
  EXPECT_EQ(model.name(), "test-1");
  const auto weight = model.Find<std::int8_t>("a.weight", {1, 2, 8, 4});
  ASSERT_TRUE(weight.ok());
  EXPECT_EQ(weight.value().size(), 64U);
  EXPECT_EQ(weight.value()[63], -127);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(weight.value().data()) % ModelBlob::kAlignment, 0U);
  const auto bias = model.Find<std::int32_t>("a.bias", {3});
  ASSERT_TRUE(bias.ok());
  EXPECT_EQ(bias.value()[1], -1);
  EXPECT_EQ(bias.value()[2], 256);
}

TEST(ModelBlob, SaysWhyATensorIsNotThere) {
  const AlignedCopy blob(TwoTensors());
  ModelBlob model;
  EXPECT_EQ(model.Find<std::int32_t>("a.bias", {3}).status(), Status::kEmpty) << "nothing is open yet";
  ASSERT_EQ(model.Open(blob.bytes()), Status::kOk);
  EXPECT_EQ(model.Find<std::int32_t>("a.bia", {3}).status(), Status::kEmpty);
  EXPECT_EQ(model.Find<std::int32_t>("a.bias", {4}).status(), Status::kVersion);
  EXPECT_EQ(model.Find<std::int32_t>("a.bias", {3, 1}).status(), Status::kVersion);
  EXPECT_EQ(model.Find<float>("a.bias", {3}).status(), Status::kVersion);
}

TEST(ModelBlob, RefusesEachFaultWithItsOwnReason) {
  ExpectFault(0, 0x4C4C5546, BlobFault::kMagic, Status::kVersion);
  ExpectFault(8, 2, BlobFault::kVersion, Status::kVersion);
  ExpectFault(12, 1 << 20, BlobFault::kSize, Status::kBadInput);
  ExpectFault(20, 1025, BlobFault::kDirectory, Status::kBadInput);
  ExpectFault(20, 100, BlobFault::kDirectory, Status::kBadInput);
  ExpectFault(24, 1, BlobFault::kDirectory, Status::kBadInput);
  ExpectFault(32, 0, BlobFault::kName, Status::kBadInput);
  ExpectFault(kFirstEntry + 32, 0, BlobFault::kType, Status::kBadInput);
  ExpectFault(kFirstEntry + 32, 4, BlobFault::kType, Status::kBadInput);
  ExpectFault(kFirstEntry + 36, 2, BlobFault::kShape, Status::kBadInput);
  ExpectFault(kFirstEntry + 36, 0, BlobFault::kShape, Status::kBadInput);
  ExpectFault(kFirstEntry + 36, 0x40000000, BlobFault::kShape, Status::kBadInput);
  ExpectFault(kFirstEntry + 52, 256 + 4, BlobFault::kMisaligned, Status::kBadInput);
  ExpectFault(kFirstEntry + 52, 0, BlobFault::kOverlap, Status::kBadInput);  // over the header
  ExpectFault(kFirstEntry + 60, 1, BlobFault::kDirectory, Status::kBadInput);
  ExpectFault(kSecondEntry + 52, 256, BlobFault::kOverlap, Status::kBadInput);  // over the first tensor
  ExpectFault(kSecondEntry + 52, 0xFFFFFFC0, BlobFault::kOverlap, Status::kBadInput);
}

TEST(ModelBlob, RefusesRepeatedAndUnterminatedNames) {
  std::vector<std::uint8_t> blob = TwoTensors();
  std::copy_n(blob.begin() + kFirstEntry, ModelBlob::kNameBytes, blob.begin() + kSecondEntry);
  RepairHeader(blob);
  ModelBlob model;
  EXPECT_EQ(model.Open(AlignedCopy(blob).bytes()), Status::kBadInput);
  EXPECT_EQ(model.fault(), BlobFault::kName);
  blob = TwoTensors();
  std::fill_n(blob.begin() + kFirstEntry, ModelBlob::kNameBytes, std::uint8_t{'x'});
  RepairHeader(blob);
  EXPECT_EQ(model.Open(AlignedCopy(blob).bytes()), Status::kBadInput);
  EXPECT_EQ(model.fault(), BlobFault::kName);
}

TEST(ModelBlob, RefusesABlobThatIsShortChangedOrMisplaced) {
  const std::vector<std::uint8_t> good = TwoTensors();
  ModelBlob model;
  EXPECT_EQ(model.Open({}), Status::kBadInput);
  EXPECT_EQ(model.fault(), BlobFault::kTooShort);
  EXPECT_EQ(model.Open(AlignedCopy(std::span(good).first(good.size() - 1)).bytes()), Status::kBadInput);
  EXPECT_EQ(model.fault(), BlobFault::kSize);
  std::vector<std::uint8_t> changed = good;
  changed.back() ^= 1U;
  EXPECT_EQ(model.Open(AlignedCopy(changed).bytes()), Status::kCrc);
  EXPECT_EQ(model.fault(), BlobFault::kChecksum);
  EXPECT_EQ(model.Open(AlignedCopy(good, 4).bytes()), Status::kBadInput);
  EXPECT_EQ(model.fault(), BlobFault::kMisaligned);
}

}  // namespace
}  // namespace mapweld::nn

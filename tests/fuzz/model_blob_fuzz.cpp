// SPDX-License-Identifier: Apache-2.0
// The input is a model blob; once as it is and once with size and checksum made right, to get at the directory.
#include <cstdlib>

#include "core/nn/model_blob.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/made_up_model.hpp"

namespace mapweld::fuzz {
namespace {

void OpenAndRead(const Bytes& bytes) {
  const nn::AlignedCopy copy(bytes);
  nn::ModelBlob model;
  if (model.Open(copy.bytes()) != Status::kOk) {
    FUZZ_REQUIRE(model.fault() != nn::BlobFault::kNone && model.tensors() == 0 && model.name().empty());
    return;
  }
  FUZZ_REQUIRE(model.fault() == nn::BlobFault::kNone && !model.name().empty());
  std::int64_t sum = 0;
  const auto weights = model.Find<std::int8_t>("w", {1, 1, 8, 4});
  if (weights.ok()) {
    for (const std::int8_t w : weights.value()) sum += w;
  }
  const auto bias = model.Find<std::int32_t>("b", {2});
  if (bias.ok()) {
    for (const std::int32_t b : bias.value()) sum += b;
  }
  FUZZ_REQUIRE(std::abs(sum) <= (std::int64_t{1} << 33));  // uses what was read
}

}  // namespace

std::vector<Bytes> Seeds() {
  using nn::TensorType;
  return {nn::MakeUpModel("m", {}), nn::MakeUpModel("m", {{"w", TensorType::kInt8, {1, 1, 8, 4}, Bytes(32, 7)},
                                                          {"b", TensorType::kInt32, {2}, {1, 2, 3, 4, 5, 6, 7, 8}},
                                                          {"scale", TensorType::kFloat32, {1}, {0, 0, 128, 63}}})};
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  fuzz::Bytes bytes(data, data + size);
  fuzz::OpenAndRead(bytes);
  nn::RepairHeader(bytes);
  fuzz::OpenAndRead(bytes);
  return 0;
}

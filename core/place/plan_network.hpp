// SPDX-License-Identifier: Apache-2.0
// Three int8 convolutions over the polar image of the plan view, what of their output and of the image itself does not
// change when the vehicle turns, and one fully connected layer. tools/train makes the weights.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/nn/arena.hpp"
#include "core/nn/conv2d.hpp"
#include "core/nn/kernels.hpp"
#include "core/nn/model_blob.hpp"
#include "core/place/angular_features.hpp"
#include "core/place/image_features.hpp"
#include "core/place/plan_image.hpp"

namespace mapweld::place {

class PlanNetwork {
 public:
  static constexpr std::size_t kOutputs = 256;

  // Takes the network's layers out of a model; it must outlive this. kVersion, kEmpty: it is of another network;
  // kBadInput, kOutOfRange: a layer's numbers make no sense. Nothing else may be called before this gave kOk.
  Status Open(const nn::ModelBlob& model, const nn::Kernels& kernels);

  // image_features: of the same image. out: unit length. The same bits on every machine. 11 million multiply-adds, 128
  // transforms of length 64.
  void Run(const PlanImage& image, const ImageFeatures& image_features, std::span<float, kOutputs> out);

 private:
  static constexpr std::size_t kRings = PlanImage::kRings;
  static constexpr std::size_t kBands = PlanImage::kBands;
  static constexpr nn::ConvGeometry kFirst{.height = kRings, .width = kAngles, .channels = kBands, .stride_y = 2};
  static constexpr std::size_t kFirstChannels = 16;
  static constexpr std::size_t kMapRings = kFirst.out_height();
  static constexpr nn::ConvGeometry kSecond{.height = kMapRings, .width = kAngles, .channels = kFirstChannels};
  static constexpr std::size_t kSecondChannels = 32;
  static constexpr nn::ConvGeometry kThird{.height = kMapRings, .width = kAngles, .channels = kSecondChannels};
  static constexpr std::size_t kMapChannels = 16;

  // Of every channel the power at orders 0..11, of neighbouring channels the relation at orders 1..8.
  static constexpr std::size_t kMapOrders = 12;
  static constexpr std::size_t kRelationOrders = 8;
  static constexpr std::size_t kMapPower = kMapChannels * kMapRings * kMapOrders;
  static constexpr std::size_t kMapRelations = kMapChannels / 2 * kMapRings * kRelationOrders;
  static constexpr std::size_t kMapFeatures = kMapPower + 2 * kMapRelations;
  static constexpr std::size_t kFeatures = kMapFeatures + ImageFeatures::kSize;

  void Prepare(const PlanImage& image);
  void Convolve();
  void FillMapFeatures();

  static constexpr auto kPlan = nn::PlanArena(std::array{
      nn::Buffer{kRings * kAngles * nn::RowStride(kBands), 0, 1},             // image
      nn::Buffer{kMapRings * kAngles * nn::RowStride(kFirstChannels), 1, 2},  // first map
      nn::Buffer{kMapRings * kAngles * nn::RowStride(kSecondChannels), 2, 3},
      nn::Buffer{kMapRings * kAngles * nn::RowStride(kMapChannels), 3, 4},
      nn::Buffer{nn::ConvScratchBytes(kThird), 1, 3},
  });

  const nn::Kernels* kernels_ = nullptr;
  nn::ConvLayer first_;
  nn::ConvLayer second_;
  nn::ConvLayer third_;
  nn::LinearLayer last_;
  std::span<const float> input_scale_;  // per band: int8 = pixel * scale + offset
  std::span<const float> input_offset_;
  std::span<const float> map_scale_;  // [1] the value of one step of the last map
  std::span<const float> feature_scale_;
  std::span<const float> feature_offset_;
  std::span<const float> output_scale_;

  alignas(nn::kArenaAlignment) std::array<std::int8_t, kPlan.bytes> arena_;
  std::array<std::array<std::array<Complex, kMapOrders>, kMapRings>, kMapChannels> map_orders_;
  std::array<float, kMapFeatures> map_features_;
  std::array<std::int8_t, nn::RowStride(kFeatures)> quantized_;
  std::array<std::int32_t, nn::SumStride(kOutputs)> sums_;
};

}  // namespace mapweld::place

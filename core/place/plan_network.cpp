// SPDX-License-Identifier: Apache-2.0
#include "core/place/plan_network.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/place/normalize.hpp"

namespace mapweld::place {
namespace {

std::int8_t ToInt8(float value, float lowest) {
  return static_cast<std::int8_t>(std::floor(std::clamp(value, lowest, 127.0F) + 0.5F));
}

// A tensor's name: layer and part, for example "first.bias".
class Name {
 public:
  Name(std::string_view layer, std::string_view part) {
    for (const char c : layer) text_[size_++] = c;
    for (const char c : part) text_[size_++] = c;
  }
  operator std::string_view() const { return {text_.data(), size_}; }  // NOLINT: stands for the text

 private:
  std::array<char, nn::ModelBlob::kNameBytes> text_{};
  std::size_t size_ = 0;
};

struct LayerShape {
  std::size_t inputs;
  std::size_t outputs;
};

std::uint32_t Dim(std::size_t n) {
  return static_cast<std::uint32_t>(n);
}

// The layer's arrays; the first that is missing decides the status.
Status ReadLayer(const nn::ModelBlob& model, std::string_view layer, const LayerShape& shape, bool requantizes,
                 nn::LinearParameters* p) {
  const std::size_t padded = nn::SumStride(shape.outputs);
  const auto weights =
      model.Find<std::int8_t>(Name(layer, ".weight"), {Dim(padded / 8), Dim(nn::RowStride(shape.inputs) / 4), 8, 4});
  if (!weights.ok()) return weights.status();
  const auto bias = model.Find<std::int32_t>(Name(layer, ".bias"), {Dim(padded)});
  if (!bias.ok()) return bias.status();
  p->inputs = shape.inputs;
  p->outputs = shape.outputs;
  p->weights = weights.value();
  p->bias = bias.value();
  p->lowest = requantizes ? 0 : -127;
  if (!requantizes) return Status::kOk;
  const auto multiplier = model.Find<std::int32_t>(Name(layer, ".multiplier"), {Dim(padded)});
  if (!multiplier.ok()) return multiplier.status();
  const auto shift = model.Find<std::int32_t>(Name(layer, ".shift"), {Dim(padded)});
  if (!shift.ok()) return shift.status();
  p->multiplier = multiplier.value();
  p->shift = shift.value();
  return Status::kOk;
}

Status ReadConv(const nn::ModelBlob& model, std::string_view name, const nn::ConvGeometry& geometry,
                std::size_t outputs, nn::ConvLayer* layer) {
  nn::LinearParameters parameters;
  const Status status = ReadLayer(model, name, {geometry.inputs(), outputs}, true, &parameters);
  if (status != Status::kOk) return status;
  const Result<nn::ConvLayer> made = nn::MakeConv2d(geometry, parameters);
  if (!made.ok()) return made.status();
  *layer = made.value();
  return Status::kOk;
}

Status ReadFloats(const nn::ModelBlob& model, std::string_view name, std::size_t n, std::span<const float>* out) {
  const auto found = model.Find<float>(name, {Dim(n)});
  if (!found.ok()) return found.status();
  *out = found.value();
  return std::all_of(out->begin(), out->end(), [](float v) { return std::isfinite(v); }) ? Status::kOk
                                                                                         : Status::kOutOfRange;
}

}  // namespace

Status PlanNetwork::Open(const nn::ModelBlob& model, const nn::Kernels& kernels) {
  kernels_ = &kernels;
  nn::LinearParameters last;
  for (const Status status : {
           ReadConv(model, "first", kFirst, kFirstChannels, &first_),
           ReadConv(model, "second", kSecond, kSecondChannels, &second_),
           ReadConv(model, "third", kThird, kMapChannels, &third_),
           ReadLayer(model, "last", {kFeatures, kOutputs}, false, &last),
           ReadFloats(model, "input.scale", kBands, &input_scale_),
           ReadFloats(model, "input.offset", kBands, &input_offset_),
           ReadFloats(model, "map.scale", 1, &map_scale_),
           ReadFloats(model, "feature.scale", kFeatures, &feature_scale_),
           ReadFloats(model, "feature.offset", kFeatures, &feature_offset_),
           ReadFloats(model, "output.scale", kOutputs, &output_scale_),
       }) {
    if (status != Status::kOk) return status;
  }
  const Result<nn::LinearLayer> made = nn::MakeLinear(last);
  if (!made.ok()) return made.status();
  last_ = made.value();
  return Status::kOk;
}

void PlanNetwork::Run(const PlanImage& image, const ImageFeatures& image_features, std::span<float, kOutputs> out) {
  Prepare(image);
  Convolve();
  FillMapFeatures();
  quantized_.fill(0);
  const auto quantize = [this](std::span<const float> features, std::size_t first) {
    for (std::size_t i = 0; i < features.size(); ++i) {
      quantized_[first + i] = ToInt8(features[i] * feature_scale_[first + i] + feature_offset_[first + i], -127);
    }
  };
  quantize(map_features_, 0);
  quantize(image_features.all(), kMapFeatures);
  kernels_->linear_sums(last_, quantized_.data(), 1, sums_.data());
  for (std::size_t i = 0; i < kOutputs; ++i) out[i] = static_cast<float>(sums_[i]) * output_scale_[i];
  ScaleToLength(out, 1);
}

void PlanNetwork::Prepare(const PlanImage& image) {
  std::int8_t* pixel = arena_.data() + kPlan.offset[0];
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    for (std::size_t d = 0; d < kAngles; ++d, pixel += nn::RowStride(kBands)) {
      for (std::size_t b = 0; b < kBands; ++b) {
        pixel[b] = ToInt8(static_cast<float>(image.At(b, ring, d)) * input_scale_[b] + input_offset_[b], -127);
      }
      for (std::size_t b = kBands; b < nn::RowStride(kBands); ++b) pixel[b] = 0;
    }
  }
}

void PlanNetwork::Convolve() {
  const auto at = [this](std::size_t buffer) { return arena_.data() + kPlan.offset[buffer]; };
  const std::span<std::int8_t> scratch(at(4), nn::ConvScratchBytes(kThird));
  nn::Conv2d(*kernels_, first_, at(0), scratch, at(1));
  nn::Conv2d(*kernels_, second_, at(1), scratch, at(2));
  nn::Conv2d(*kernels_, third_, at(2), scratch, at(3));
}

void PlanNetwork::FillMapFeatures() {
  const std::int8_t* map = arena_.data() + kPlan.offset[3];
  constexpr std::size_t kStride = nn::RowStride(kMapChannels);
  const float step = map_scale_[0];
  for (std::size_t ring = 0; ring < kMapRings; ++ring) {
    for (std::size_t c = 0; c < kMapChannels; c += 2) {
      std::array<Complex, kAngles> lines;
      for (std::size_t d = 0; d < kAngles; ++d) {
        const std::int8_t* values = map + (ring * kAngles + d) * kStride + c;
        lines[d] = {static_cast<float>(values[0]) * step, static_cast<float>(values[1]) * step};
      }
      AngularOrders(lines, &map_orders_[c][ring], &map_orders_[c + 1][ring]);
    }
  }
  float* power = map_features_.data();
  for (const auto& channel : map_orders_) {
    for (const auto& ring : channel) {
      for (const Complex& order : ring) *power++ = PressedPower(order);
    }
  }
  float* re = power;
  float* im = power + kMapRelations;
  for (std::size_t c = 0; c < kMapChannels; c += 2) {
    for (std::size_t ring = 0; ring < kMapRings; ++ring) {
      for (std::size_t k = 1; k <= kRelationOrders; ++k) {
        const Complex relation = PressedRelation(map_orders_[c][ring][k], map_orders_[c + 1][ring][k]);
        *re++ = relation.re;
        *im++ = relation.im;
      }
    }
  }
}

}  // namespace mapweld::place

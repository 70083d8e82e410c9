// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/nn/nn_bench.hpp"

#ifdef MAPWELD_HAVE_XNNPACK
#include <xnnpack.h>

#include <memory>
#include <stdexcept>

namespace mapweld::bench {
namespace {

// An operator with its data.
struct Peer {
  std::vector<std::int8_t> weights, x, y;
  std::vector<std::int32_t> bias;
  xnn_operator_t op = nullptr;
  Peer(std::size_t weight_count, std::size_t x_count, std::size_t y_count, std::size_t outputs)
      : weights(weight_count), x(x_count + 64), y(y_count + 64), bias(outputs, 1) {
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<std::int8_t>(i * 37 % 127);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<std::int8_t>(i * 29 % 127);
  }
  Peer(const Peer&) = delete;
  ~Peer() { xnn_delete_operator(op); }
};

void Check(xnn_status status) {
  if (status != xnn_status_success) throw std::runtime_error("XNNPACK refused the layer");
}

Work Runs(std::shared_ptr<Peer> peer) {
  return [peer] { Check(xnn_run_operator(peer->op, nullptr)); };
}

}  // namespace

Work XnnpackLinear(std::size_t count, std::size_t inputs, std::size_t outputs) {
  Check(xnn_initialize(nullptr));
  auto peer = std::make_shared<Peer>(inputs * outputs, count * inputs, count * outputs, outputs);
  Check(xnn_create_fully_connected_nc_qs8(inputs, outputs, inputs, outputs, 0, 0.02F, 0.01F, peer->weights.data(),
                                          peer->bias.data(), 0, 1.0F, -127, 127, 0, &peer->op));
  Check(xnn_setup_fully_connected_nc_qs8(peer->op, count, peer->x.data(), peer->y.data(), nullptr));
  return Runs(peer);
}

Work XnnpackConv(std::size_t height, std::size_t width, std::size_t channels, std::size_t kernel, std::size_t outputs) {
  Check(xnn_initialize(nullptr));
  const std::size_t pixels = height * width;
  const auto k = static_cast<std::uint32_t>(kernel), half = k / 2;
  auto peer =
      std::make_shared<Peer>(kernel * kernel * channels * outputs, pixels * channels, pixels * outputs, outputs);
  Check(xnn_create_convolution2d_nhwc_qs8(half, half, half, half, k, k, 1, 1, 1, 1, 1, channels, outputs, channels,
                                          outputs, 0, 0.02F, 0.01F, peer->weights.data(), peer->bias.data(), 0, 1.0F,
                                          -127, 127, 0, &peer->op));
  Check(xnn_setup_convolution2d_nhwc_qs8(peer->op, 1, height, width, peer->x.data(), peer->y.data(), nullptr));
  return Runs(peer);
}

}  // namespace mapweld::bench
#else
namespace mapweld::bench {
Work XnnpackLinear(std::size_t, std::size_t, std::size_t) {
  return {};
}
Work XnnpackConv(std::size_t, std::size_t, std::size_t, std::size_t, std::size_t) {
  return {};
}
}  // namespace mapweld::bench
#endif

// SPDX-License-Identifier: Apache-2.0
// A uniform cubic B-spline: twice continuously differentiable, exact derivatives, local. It passes close to its control
// points (h^2/6 times the second derivative away), not through them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

namespace mapweld::sim {

template <int N>
class UniformSpline {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  // Control point i belongs to parameter i * step. At least two. Outside its range the spline stays at its ends.
  UniformSpline(std::vector<Vector> control, double step) : control_(std::move(control)), step_(step) {}

  [[nodiscard]] double end() const { return static_cast<double>(control_.size() - 1) * step_; }

  [[nodiscard]] Vector Value(double x) const {
    const auto [i, u] = Locate(x);
    const double v = 1 - u;
    return (v * v * v * At(i - 1) + (3 * u * u * u - 6 * u * u + 4) * At(i) +
            (3 * v * v * v - 6 * v * v + 4) * At(i + 1) + u * u * u * At(i + 2)) /
           6;
  }
  [[nodiscard]] Vector Derivative(double x) const {
    const auto [i, u] = Locate(x);
    const double v = 1 - u;
    return (-v * v * At(i - 1) + (3 * u * u - 4 * u) * At(i) - (3 * v * v - 4 * v) * At(i + 1) + u * u * At(i + 2)) /
           (2 * step_);
  }
  [[nodiscard]] Vector SecondDerivative(double x) const {
    const auto [i, u] = Locate(x);
    const double v = 1 - u;
    return (v * At(i - 1) + (3 * u - 2) * At(i) + (3 * v - 2) * At(i + 1) + u * At(i + 2)) / (step_ * step_);
  }

 private:
  [[nodiscard]] std::pair<std::ptrdiff_t, double> Locate(double x) const {
    const auto last = static_cast<std::ptrdiff_t>(control_.size()) - 2;
    const double at = std::clamp(x / step_, 0.0, static_cast<double>(last + 1));
    const std::ptrdiff_t i = std::min(static_cast<std::ptrdiff_t>(at), last);
    return {i, at - static_cast<double>(i)};
  }
  // One point beyond each end, continued in a straight line.
  [[nodiscard]] Vector At(std::ptrdiff_t i) const {
    const auto n = static_cast<std::ptrdiff_t>(control_.size());
    if (i < 0) return 2 * control_[0] - control_[1];
    if (i >= n) return 2 * control_[static_cast<std::size_t>(n - 1)] - control_[static_cast<std::size_t>(n - 2)];
    return control_[static_cast<std::size_t>(i)];
  }
  std::vector<Vector> control_;
  double step_;
};

}  // namespace mapweld::sim

// SPDX-License-Identifier: Apache-2.0
// The inner loops of the block Cholesky: N x N column-major blocks, N small and fixed, so that the compiler keeps a
// column in registers.
#pragma once

#include <cmath>

namespace mapweld::pose_graph {

// c -= a * b^T
template <int N>
inline void SubtractProduct(const double* a, const double* b, double* c) {
  for (int col = 0; col < N; ++col) {
    double sum[static_cast<unsigned>(N)];
    for (int i = 0; i < N; ++i) sum[i] = c[col * N + i];
    for (int k = 0; k < N; ++k) {
      const double factor = b[k * N + col];
      for (int i = 0; i < N; ++i) sum[i] -= a[k * N + i] * factor;
    }
    for (int i = 0; i < N; ++i) c[col * N + i] = sum[i];
  }
}

// c -= a * a^T, at least its lower triangle
template <int N>
inline void SubtractSquare(const double* a, double* c) {
  SubtractProduct<N>(a, a, c);
}

// Lower triangle of c becomes its Cholesky factor, the upper one zero. False where c is not positive definite.
template <int N>
inline bool FactorizeBlock(double* c) {
  for (int col = 0; col < N; ++col) {
    for (int k = 0; k < col; ++k) {
      const double factor = c[k * N + col];
      for (int i = col; i < N; ++i) c[col * N + i] -= c[k * N + i] * factor;
    }
    const double pivot = c[col * N + col];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / std::sqrt(pivot);
    for (int i = col; i < N; ++i) c[col * N + i] *= inverse;
    for (int i = 0; i < col; ++i) c[col * N + i] = 0;
  }
  return true;
}

// x := x * l^-T for a lower triangular l
template <int N>
inline void DivideByTransposed(const double* l, double* x) {
  for (int col = 0; col < N; ++col) {
    for (int k = 0; k < col; ++k) {
      const double factor = l[k * N + col];
      for (int i = 0; i < N; ++i) x[col * N + i] -= x[k * N + i] * factor;
    }
    const double inverse = 1 / l[col * N + col];
    for (int i = 0; i < N; ++i) x[col * N + i] *= inverse;
  }
}

}  // namespace mapweld::pose_graph

// SPDX-License-Identifier: Apache-2.0
// Sparse Cholesky factorisation in dense blocks of N x N, for systems whose unknowns come in groups of N: poses (6),
// rotations (3), positions (1). Left-looking by columns; the same input gives the same bits.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/pose_graph/block_kernels.hpp"
#include "tools/pose_graph/block_pattern.hpp"

namespace mapweld::pose_graph {

template <int N>
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, N, N>;
  template <int M>
  using Rhs = std::vector<Eigen::Matrix<double, N, M>>;  // one block of rows per node, M right-hand sides

  // `pattern` must outlive this.
  explicit BlockCholesky(const BlockPattern* pattern)
      : pattern_(pattern), diagonal_(pattern->position.size()), lower_(pattern->rows.size()) {}

  // The matrix is put together here, then factorised in place.
  void SetZero() {
    for (Block& block : diagonal_) block.setZero();
    for (Block& block : lower_) block.setZero();
  }
  // diagonal(k) of the k-th node in the order of elimination; lower(i) with the pattern's number of the block, whose
  // rows belong to the node that is eliminated later.
  Block& diagonal(int k) { return diagonal_[static_cast<std::size_t>(k)]; }
  Block& lower(std::size_t block) { return lower_[block]; }
  [[nodiscard]] const Block& diagonal(int k) const { return diagonal_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const Block& lower(std::size_t block) const { return lower_[block]; }

  // False when the matrix is not positive definite or not finite; it is spoiled then.
  bool Factorize() {
    const int n = pattern_->columns();
    std::vector<std::size_t> cursor(pattern_->begin.begin(), pattern_->begin.end() - 1);
    std::vector<int> first(static_cast<std::size_t>(n), -1);  // column whose next block lies in this row
    std::vector<int> next(static_cast<std::size_t>(n), -1);
    std::vector<std::size_t> slot(static_cast<std::size_t>(n));
    const auto wait = [&](int column) {
      const auto c = static_cast<std::size_t>(column);
      if (cursor[c] == pattern_->begin[c + 1]) return;
      int& head = first[static_cast<std::size_t>(pattern_->rows[cursor[c]])];
      next[c] = head;
      head = column;
    };
    for (int k = 0; k < n; ++k) {
      const auto column = static_cast<std::size_t>(k);
      const std::size_t begin = pattern_->begin[column];
      const std::size_t end = pattern_->begin[column + 1];
      for (std::size_t i = begin; i < end; ++i) slot[static_cast<std::size_t>(pattern_->rows[i])] = i;
      for (int left = first[column]; left >= 0;) {
        const auto from = static_cast<std::size_t>(left);
        const int after = next[from];
        const std::size_t own = cursor[from]++;
        SubtractSquare<N>(lower_[own].data(), diagonal_[column].data());
        for (std::size_t i = own + 1; i < pattern_->begin[from + 1]; ++i) {
          SubtractProduct<N>(lower_[i].data(), lower_[own].data(),
                             lower_[slot[static_cast<std::size_t>(pattern_->rows[i])]].data());
        }
        wait(left);
        left = after;
      }
      if (!FactorizeBlock<N>(diagonal_[column].data())) return false;
      for (std::size_t i = begin; i < end; ++i) DivideByTransposed<N>(diagonal_[column].data(), lower_[i].data());
      wait(k);
    }
    return true;
  }

  // Solves in place. x is indexed by the order of elimination.
  template <int M>
  void Solve(Rhs<M>* x) const {
    const int n = pattern_->columns();
    for (int k = 0; k < n; ++k) {
      const auto column = static_cast<std::size_t>(k);
      auto& own = (*x)[column];
      diagonal_[column].template triangularView<Eigen::Lower>().solveInPlace(own);
      for (std::size_t i = pattern_->begin[column]; i < pattern_->begin[column + 1]; ++i) {
        (*x)[static_cast<std::size_t>(pattern_->rows[i])].noalias() -= lower_[i] * own;
      }
    }
    for (int k = n - 1; k >= 0; --k) {
      const auto column = static_cast<std::size_t>(k);
      auto& own = (*x)[column];
      for (std::size_t i = pattern_->begin[column]; i < pattern_->begin[column + 1]; ++i) {
        own.noalias() -= lower_[i].transpose() * (*x)[static_cast<std::size_t>(pattern_->rows[i])];
      }
      diagonal_[column].template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
    }
  }

  // Replaces the factor by the blocks of the inverse where the factor has blocks, both triangles of the diagonal ones
  // (Takahashi, Fagan, Chen 1973). Costs twice a factorisation.
  void InvertInPattern() {
    std::vector<Block> scaled;
    for (int k = pattern_->columns() - 1; k >= 0; --k) {
      const auto column = static_cast<std::size_t>(k);
      const std::size_t begin = pattern_->begin[column];
      const std::size_t count = pattern_->begin[column + 1] - begin;
      const Block inverse = diagonal_[column].template triangularView<Eigen::Lower>().solve(Block::Identity());
      scaled.clear();
      for (std::size_t i = 0; i < count; ++i) scaled.push_back(lower_[begin + i] * inverse);
      for (std::size_t i = 0; i < count; ++i) {
        Block sum = Block::Zero();
        const int row = pattern_->rows[begin + i];
        for (std::size_t j = 0; j < count; ++j) {
          const int other = pattern_->rows[begin + j];
          if (row == other) sum.noalias() -= diagonal_[static_cast<std::size_t>(row)] * scaled[j];
          if (row > other) sum.noalias() -= lower_[pattern_->BlockAt(row, other)] * scaled[j];
          if (row < other) sum.noalias() -= lower_[pattern_->BlockAt(other, row)].transpose() * scaled[j];
        }
        lower_[begin + i] = sum;
      }
      Block own = inverse.transpose() * inverse;
      for (std::size_t i = 0; i < count; ++i) own.noalias() -= scaled[i].transpose() * lower_[begin + i];
      diagonal_[column] = 0.5 * (own + own.transpose());
    }
  }

 private:
  const BlockPattern* pattern_;
  std::vector<Block> diagonal_;
  std::vector<Block> lower_;
};

}  // namespace mapweld::pose_graph

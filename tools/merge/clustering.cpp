// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/clustering.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

namespace mapweld::merge {
namespace {

constexpr double kZero = 1e-9;
constexpr int kRounds = 100;

// The connected components among `members`, each sorted.
std::vector<std::vector<int>> Components(const Eigen::MatrixXd& weights, const std::vector<int>& members) {
  std::vector<std::vector<int>> out;
  std::vector<int> left = members;
  while (!left.empty()) {
    std::vector<int> component{left.front()};
    left.erase(left.begin());
    for (std::size_t i = 0; i < component.size(); ++i) {
      for (auto at = left.begin(); at != left.end();) {
        if (weights(component[i], *at) > 0) {
          component.push_back(*at);
          at = left.erase(at);
        } else {
          ++at;
        }
      }
    }
    std::sort(component.begin(), component.end());
    out.push_back(component);
  }
  return out;
}

// k-means on rows; starts from the rows furthest apart, so that it is the same every time.
std::vector<int> KMeans(const Eigen::MatrixXd& rows, int k) {
  Eigen::MatrixXd centers(k, rows.cols());
  centers.row(0) = rows.row(0);
  for (int c = 1; c < k; ++c) {
    Eigen::Index furthest = 0;
    Eigen::VectorXd distance(rows.rows());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      distance(i) = (centers.topRows(c).rowwise() - rows.row(i)).rowwise().squaredNorm().minCoeff();
    }
    distance.maxCoeff(&furthest);
    centers.row(c) = rows.row(furthest);
  }
  std::vector<int> label(static_cast<std::size_t>(rows.rows()), -1);
  for (int round = 0; round < kRounds; ++round) {
    bool changed = false;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      Eigen::Index nearest = 0;
      (centers.rowwise() - rows.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
      int& to = label[static_cast<std::size_t>(i)];
      changed = changed || to != static_cast<int>(nearest);
      to = static_cast<int>(nearest);
    }
    if (!changed) break;
    for (int c = 0; c < k; ++c) {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(rows.cols());
      int n = 0;
      for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        if (label[static_cast<std::size_t>(i)] != c) continue;
        sum += rows.row(i);
        ++n;
      }
      if (n > 0) centers.row(c) = sum / n;
    }
  }
  return label;
}

// How many groups ascending eigenvalues, of which the first is 0, speak of.
int NumberOfGroups(const Eigen::VectorXd& eigenvalues, const WeightConfig& config) {
  int groups = 1;
  for (int k = 2; k < static_cast<int>(eigenvalues.size()) && eigenvalues(k - 1) <= std::max(config.theta, kZero);
       ++k) {
    if (eigenvalues(k) >= config.eigengap * std::max(eigenvalues(k - 1), kZero)) groups = k;
  }
  return groups;
}

std::vector<std::vector<int>> Split(const Eigen::MatrixXd& weights, const std::vector<int>& component,
                                    const WeightConfig& config) {
  const auto n = static_cast<Eigen::Index>(component.size());
  if (n < 2) return {component};
  Eigen::MatrixXd w(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      w(i, k) = weights(component[static_cast<std::size_t>(i)], component[static_cast<std::size_t>(k)]);
    }
  }
  const Eigen::VectorXd inverse_root = w.rowwise().sum().array().rsqrt();
  const Eigen::MatrixXd laplacian =
      Eigen::MatrixXd::Identity(n, n) - inverse_root.asDiagonal() * w * inverse_root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(laplacian);
  const int k = NumberOfGroups(solver.eigenvalues(), config);
  if (k < 2) return {component};
  Eigen::MatrixXd rows = solver.eigenvectors().leftCols(k);
  rows.rowwise().normalize();
  const std::vector<int> label = KMeans(rows, k);
  std::vector<std::vector<int>> out;
  for (int c = 0; c < k; ++c) {
    std::vector<int> members;
    for (std::size_t i = 0; i < component.size(); ++i) {
      if (label[i] == c) members.push_back(component[i]);
    }
    for (std::vector<int>& part : Components(weights, members)) out.push_back(std::move(part));
  }
  return out;
}

}  // namespace

std::vector<std::vector<int>> ClusterDrives(const Eigen::MatrixXd& weights, const WeightConfig& config) {
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(weights.rows()); ++i) all.push_back(i);
  std::vector<std::vector<int>> groups;
  for (const std::vector<int>& component : Components(weights, all)) {
    for (std::vector<int>& group : Split(weights, component, config)) groups.push_back(std::move(group));
  }
  std::sort(groups.begin(), groups.end(), [](const std::vector<int>& x, const std::vector<int>& y) {
    return x.size() != y.size() ? x.size() > y.size() : x.front() < y.front();
  });
  return groups;
}

}  // namespace mapweld::merge

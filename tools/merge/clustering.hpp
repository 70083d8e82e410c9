// SPDX-License-Identifier: Apache-2.0
// Which drives belong together (paper, Algorithm 1), on the normalised Laplacian L = I - D^-1/2 W D^-1/2: the paper's
// L = W - D has the wrong sign, and only the normalised form goes with its objective (eq. 11). Its eigenvalues lie in
// 0..2 whatever the size of the weights, so one theta serves all.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/merge/merge_config.hpp"

namespace mapweld::merge {

// `weights` is symmetric, not negative, 0 on the diagonal. The number of groups is that of the eigenvalues below a
// clear gap: all up to theta, the next one at least `eigengap` times as large. In a line of drives, each tied to the
// next, the eigenvalues grow as 1, 4, 9: hence a line is not cut, however long, and two groups with hardly a tie are.
// Without any gap, and with theta = 0, the groups are the connected components. A group is always connected. Each group
// sorted; the largest group first, then by lowest drive. Cost: one dense eigenvalue problem per connected component,
// 0.1 s for 300 drives.
std::vector<std::vector<int>> ClusterDrives(const Eigen::MatrixXd& weights, const WeightConfig& config);

}  // namespace mapweld::merge

// SPDX-License-Identifier: Apache-2.0
// The place descriptor made by hand, without training; docs/descriptor.md has its formulas.
#pragma once

#include <span>

#include "core/place/descriptor.hpp"
#include "core/place/projection_spectrum.hpp"

namespace mapweld::place {

// spectrum: of all structure. out: unit length. 32 transforms of length 128.
void HandmadeCode(const ProjectionSpectrum& spectrum, std::span<float, kDescriptorDim> out);

}  // namespace mapweld::place

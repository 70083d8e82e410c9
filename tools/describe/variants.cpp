// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/place/describer.hpp"
#include "tools/baselines/m2dp.hpp"
#include "tools/baselines/scan_context.hpp"
#include "tools/baselines/solid.hpp"
#include "tools/describe/cosine.hpp"

namespace mapweld::describe {
namespace {

// Compares all 1024 bytes.
class CosineComparison : public PlaceMethod {
 public:
  Status Describe(const submap::Submap&, place::PlaceDescription*) override { return Status::kNotReady; }
  [[nodiscard]] Features Prepare(const place::PlaceDescription& place) const override {
    return UnitFeatures(place.descriptor, place::kDescriptorDim);
  }
  [[nodiscard]] float Distance(const Features& a, const Features& b) const override { return CosineDistance(a, b); }
};

// The agent's own.
template <place::Describer::Method kMethod>
class AgentDescriptor final : public CosineComparison {
 public:
  Status Describe(const submap::Submap& submap, place::PlaceDescription* place) override {
    return describer_->Describe(submap, place);
  }
  [[nodiscard]] bool IsUnfamiliar() const override { return describer_->unfamiliarity() > 1; }

 private:
  std::unique_ptr<place::Describer> describer_ = std::make_unique<place::Describer>(kMethod);
};

struct Variant {
  std::string_view name;
  std::unique_ptr<PlaceMethod> (*make)();
};

template <class Method>
std::unique_ptr<PlaceMethod> Make() {
  return std::make_unique<Method>();
}

constexpr std::array kVariants = {
    Variant{"trained", Make<AgentDescriptor<place::Describer::Method::kTrained>>},
    Variant{"handmade", Make<AgentDescriptor<place::Describer::Method::kHandmade>>},
    Variant{"scan-context", Make<baselines::ScanContext>},
    Variant{"solid", Make<baselines::Solid>},
    Variant{"m2dp", Make<baselines::M2dp>},
};

}  // namespace

std::vector<std::string> VariantNames() {
  std::vector<std::string> names;
  for (const Variant& variant : kVariants) names.emplace_back(variant.name);
  return names;
}

std::string VariantList() {
  return fmt::format("{}", fmt::join(VariantNames(), ", "));
}

bool IsVariant(std::string_view name) {
  return std::any_of(kVariants.begin(), kVariants.end(), [&](const Variant& v) { return v.name == name; });
}

std::unique_ptr<PlaceMethod> MakeVariant(std::string_view name) {
  for (const Variant& variant : kVariants) {
    if (variant.name == name) return variant.make();
  }
  throw std::runtime_error(fmt::format("there is no descriptor '{}'; there are {}", name, VariantList()));
}

std::unique_ptr<PlaceMethod> MakeCosineComparison() {
  return std::make_unique<CosineComparison>();
}

}  // namespace mapweld::describe

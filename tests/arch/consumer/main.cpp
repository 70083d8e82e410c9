// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "core/place/describer.hpp"
#include "drivers/messages/channel.hpp"

int main() {
  const auto describer = std::make_unique<mapweld::place::Describer>();
  const auto submap = std::make_unique<mapweld::submap::Submap>();
  mapweld::place::PlaceDescription description;
  mapweld::messages::ChannelBuffer buffer;
  const bool refused = describer->Describe(*submap, &description) != mapweld::Status::kOk;
  return refused && mapweld::messages::FormatChannel(&buffer, 3, mapweld::messages::Kind::kPose).ok() ? 0 : 1;
}

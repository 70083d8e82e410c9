// SPDX-License-Identifier: Apache-2.0
// A store with a little of everything, filled step by step; each step can be done again without harm.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/store/history.hpp"

namespace mapweld::test {

inline merge::Keyframe SmallKeyframe(int drive, int index) {
  merge::Keyframe keyframe;
  keyframe.t = {index * 500'000'000LL};
  keyframe.odom_T_body.t = {5.0 * index, 0.1 * drive, 1.0 / (1 + index)};
  keyframe.path_m = 5.0 * index;
  for (std::size_t i = 0; i < keyframe.place.descriptor.q.size(); ++i) {
    keyframe.place.descriptor.q[i] =
        static_cast<std::int8_t>((i * 31 + static_cast<std::size_t>(7 * index + drive)) % 127);
  }
  keyframe.place.descriptor.scale = 0.01F;
  return keyframe;
}

inline merge::SubmapCloud SmallSubmap(int drive, int index) {
  merge::SubmapCloud cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.points.emplace_back(0.5F * static_cast<float>(i % 25), 0.37F * static_cast<float>(i / 25),
                              static_cast<float>(drive + index) / 7.0F);
  }
  return cloud;
}

class SmallCity {
 public:
  static constexpr int kDrives = 2;
  static constexpr int kKeyframes = 4;

  using Step = std::function<void(store::CityStore*)>;
  static std::vector<Step> Steps() {
    std::vector<Step> steps;
    for (int d = 0; d < kDrives; ++d) {
      for (int k = 0; k < kKeyframes; ++k) {
        steps.push_back([d, k](store::CityStore* city) {
          city->Write([&] {
            const store::DriveKey drive = DriveOf(city, d);
            city->AddKeyframe(drive, k, SmallKeyframe(d, k));
            if (k % 2 == 0) city->AddSubmap(drive, k, store::Encode(SmallSubmap(d, k)));
          });
        });
      }
      steps.push_back([d](store::CityStore* city) { store::RecordMerge(city, Merged(city, d + 1)); });
    }
    steps.push_back([](store::CityStore* city) {
      store::AddRuling(city, {store::Ruling::Kind::kRefusePair, "agent_1", "agent_2", "today"});
    });
    return steps;
  }
  // Every record, key and body.
  static store::Bytes Digest(store::CityStore* city) {
    store::Bytes digest;
    for (std::size_t t = 0; t < store::kTableNames.size(); ++t) {
      city->database().ForEach(static_cast<store::Table>(t), 0, INT64_MAX, [&](const store::Record& record) {
        const std::string key = std::to_string(t) + "/" + std::to_string(record.key) + (record.damaged ? "!" : ":");
        digest.insert(digest.end(), key.begin(), key.end());
        digest.insert(digest.end(), record.body.begin(), record.body.end());
      });
    }
    return digest;
  }

 private:
  static store::DriveKey DriveOf(store::CityStore* city, int d) {
    store::DriveInfo info;
    info.agent = static_cast<std::int16_t>(d + 1);
    info.epoch = 1;
    info.name = "agent_" + std::to_string(info.agent);
    const auto known = city->FindDrive(info.name);
    return known.has_value() ? known->key : city->AddDrive(info);
  }
  // The state after the first n drives. A step that is done again finds a later state and must not go back to its own.
  static store::MergeRecord Merged(store::CityStore* city, int n) {
    store::MergeRecord record;
    record.when = "today";
    record.cause = "merge";
    for (int d = 0; d < n; ++d) {
      record.drives.push_back("agent_" + std::to_string(d + 1));
      record.keyframes.push_back(kKeyframes);
      record.groups.push_back({d});
      record.merged_T_body.emplace_back();
      for (int k = 0; k < kKeyframes; ++k) record.merged_T_body.back().push_back(SmallKeyframe(d, k).odom_T_body);
    }
    const auto last = store::LastMerge(city);
    if (last.has_value() && last->record.drives.size() > record.drives.size()) return last->record;
    return record;
  }
};

}  // namespace mapweld::test

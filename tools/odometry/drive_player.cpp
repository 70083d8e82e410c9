// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/drive_player.hpp"

#include <memory>

#include "drivers/can/xsens_codec.hpp"
#include "drivers/lidar/velodyne_codec.hpp"
#include "tools/replay/recording.hpp"

namespace mapweld::odometry {

void PlayDrive(const std::filesystem::path& drive, SensorSink* sink) {
  replay::Recording recording(drive, true);
  can::XsensCodec imu{can::XsensOptions{}};
  lidar::VelodyneCodec lidar(lidar::kVlp16);
  const auto packet = std::make_unique<sensor::LidarPacket>();
  sensor::ImuSample sample;
  replay::Event event;
  while (recording.Next(&event)) {
    if (event.lidar.empty()) {
      if (imu.Push(event.frame, &sample) != Status::kOk) continue;
      lidar.clock().Anchor(sample.t);
      sink->OnImu(sample);
    } else if (lidar.Decode(event.lidar, {event.stamp_ns}, packet.get()) == Status::kOk) {
      sink->OnPacket(*packet);
    }
  }
}

}  // namespace mapweld::odometry

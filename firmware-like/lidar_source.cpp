// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/lidar_source.hpp"

#include <array>
#include <string_view>

#include "firmware-like/read_file.hpp"

namespace mapweld::executive {
namespace {

time::ClockMode ClockModeOf(const Options& options) {
  return options.time_source == TimeSource::kShared ? time::ClockMode::kShared : time::ClockMode::kReceive;
}

const lidar::VelodyneModel& VelodyneOf(LidarModel model) {
  if (model == LidarModel::kHdl32e) return lidar::kHdl32e;
  return model == LidarModel::kVlp32c ? lidar::kVlp32c : lidar::kVlp16;
}

}  // namespace

LidarSource::LidarSource(const Options& options)
    : velodyne_(VelodyneOf(options.lidar_model), ClockModeOf(options)),
      hesai_(ClockModeOf(options)),
      ouster_(ClockModeOf(options)),
      codec_(&velodyne_) {
  if (options.lidar_model == LidarModel::kXt32) codec_ = &hesai_;
  if (options.lidar_model == LidarModel::kOs1) codec_ = &ouster_;
}

Status LidarSource::ApplyCalibration(LidarModel model, std::string_view text) {
  if (model == LidarModel::kOs1) {
    lidar::OusterMetadata metadata;
    const Status status = lidar::ParseOusterMetadata(text, &metadata);
    if (status == Status::kOk) ouster_.Configure(metadata);
    return status;
  }
  lidar::BeamTable table;
  const Status status = lidar::ParseHesaiAngles(text, lidar::HesaiXt32::kChannels, &table);
  if (status == Status::kOk) hesai_.SetAngles(table);
  return status;
}

Status LidarSource::LoadCalibration(const Options& options) {
  if (options.lidar_calibration_path == nullptr) return Status::kOk;
  std::array<char, kMaxSetupFileBytes> text;
  std::size_t bytes = 0;
  if (const Status status = ReadFile(options.lidar_calibration_path, text, &bytes); status != Status::kOk) {
    return status;
  }
  return ApplyCalibration(options.lidar_model, {text.data(), bytes});
}

}  // namespace mapweld::executive

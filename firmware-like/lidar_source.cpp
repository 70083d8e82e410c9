// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/lidar_source.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>

namespace mapweld::executive {
namespace {

time::ClockMode ClockModeOf(const Options& options) {
  return options.time_source == TimeSource::kShared ? time::ClockMode::kShared : time::ClockMode::kReceive;
}

const lidar::VelodyneModel& VelodyneOf(LidarModel model) {
  if (model == LidarModel::kHdl32e) return lidar::kHdl32e;
  return model == LidarModel::kVlp32c ? lidar::kVlp32c : lidar::kVlp16;
}

// kFull when the file does not fit.
Status ReadWhole(const char* path, std::span<char> buffer, std::size_t* bytes) {
  const int fd = ::open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return Status::kIo;
  ssize_t got = 0;
  for (*bytes = 0; *bytes < buffer.size(); *bytes += static_cast<std::size_t>(got)) {
    got = ::read(fd, buffer.data() + *bytes, buffer.size() - *bytes);
    if (got <= 0) break;
  }
  const int why = errno;
  (void)::close(fd);
  errno = why;
  if (got < 0) return Status::kIo;
  return *bytes < buffer.size() ? Status::kOk : Status::kFull;
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
  std::array<char, kMaxCalibrationBytes> text;
  std::size_t bytes = 0;
  if (const Status status = ReadWhole(options.lidar_calibration_path, text, &bytes); status != Status::kOk) {
    return status;
  }
  return ApplyCalibration(options.lidar_model, {text.data(), bytes});
}

}  // namespace mapweld::executive

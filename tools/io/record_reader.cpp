// SPDX-License-Identifier: Apache-2.0
#include "tools/io/record_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

Rgb Unpack(std::uint32_t packed) {
  return {static_cast<std::uint8_t>(packed >> 16U), static_cast<std::uint8_t>(packed >> 8U),
          static_cast<std::uint8_t>(packed)};
}

// PCL stores colour in the bits of a float. Text files hold that float, or the integer in newer ones.
Rgb UnpackField(double value, Scalar type) {
  if (type == Scalar::kFloat) return Unpack(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  return Unpack(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
}

std::uint8_t ToByte(double value, Scalar type) {
  const double scale = type == Scalar::kFloat || type == Scalar::kDouble ? 255.0 : 1.0;  // float colours are 0..1
  return static_cast<std::uint8_t>(std::lround(std::fmin(std::fmax(value * scale, 0.0), 255.0)));
}

// `value(field)` gives the number of one field of one record.
template <class Value>
void AppendPoint(const PointFields& fields, const Value& value, PointCloud* cloud) {
  cloud->points.emplace_back(static_cast<float>(value(*fields.xyz[0])), static_cast<float>(value(*fields.xyz[1])),
                             static_cast<float>(value(*fields.xyz[2])));
  if (fields.intensity != nullptr) cloud->intensities.push_back(static_cast<float>(value(*fields.intensity)));
  if (fields.packed_rgb != nullptr) {
    cloud->colors.push_back(UnpackField(value(*fields.packed_rgb), fields.packed_rgb->type));
  } else if (fields.rgb[2] != nullptr) {
    Rgb color;
    for (std::size_t i = 0; i < 3; ++i) color[i] = ToByte(value(*fields.rgb[i]), fields.rgb[i]->type);
    cloud->colors.push_back(color);
  }
}

[[noreturn]] void FailTruncated(const std::filesystem::path& path, std::size_t have, std::size_t need,
                                std::size_t offset) {
  throw std::runtime_error(
      fmt::format("{} is truncated: {} bytes of points from offset {} on, where its header promises {}; copy or record "
                  "the file again",
                  path.string(), have, offset, need));
}

bool FitsInto(std::size_t records, std::size_t record_bytes, std::size_t available) {
  return record_bytes == 0 || records <= available / record_bytes;
}

}  // namespace

PointFields::PointFields(const std::filesystem::path& path, const RecordLayout& layout)
    : xyz{layout.Find("x"), layout.Find("y"), layout.Find("z")}, intensity(layout.Find("intensity")) {
  if (xyz[0] == nullptr || xyz[1] == nullptr || xyz[2] == nullptr) {
    throw std::runtime_error(
        fmt::format("{} has no x, y and z fields; export the cloud with coordinates", path.string()));
  }
  if (intensity == nullptr) intensity = layout.Find("scalar_intensity");
  packed_rgb = layout.Find("rgb");
  if (packed_rgb == nullptr) packed_rgb = layout.Find("rgba");
  const RecordField* separate[3] = {layout.Find("red"), layout.Find("green"), layout.Find("blue")};
  if (separate[0] != nullptr && separate[1] != nullptr && separate[2] != nullptr) {
    for (std::size_t i = 0; i < 3; ++i) rgb[i] = separate[i];
  }
}

PointCloud ReadTextRecords(const std::filesystem::path& path, std::string_view body, const RecordLayout& layout,
                           std::size_t count, int first_line) {
  const PointFields fields(path, layout);
  PointCloud cloud;
  int line_number = first_line - 1;
  while (cloud.points.size() < count && !body.empty()) {
    const std::size_t end = std::min(body.find('\n'), body.size());
    const auto words = SplitWords(body.substr(0, end));
    body.remove_prefix(std::min(end + 1, body.size()));
    ++line_number;
    if (words.empty()) continue;
    const auto fail = [&](std::string_view what) {
      throw std::runtime_error(
          fmt::format("{}:{}: {}; repair the file or export it again", path.string(), line_number, what));
    };
    if (words.size() < layout.words()) {
      fail(fmt::format("found {} values where each point has {}", words.size(), layout.words()));
    }
    AppendPoint(
        fields,
        [&](const RecordField& field) {
          double value = 0;
          if (!ParseNumber(words[field.word], &value)) {
            fail(fmt::format("'{}' is not a number", words[field.word].substr(0, 40)));
          }
          return value;
        },
        &cloud);
  }
  if (cloud.points.size() < count) {
    throw std::runtime_error(
        fmt::format("{} is truncated: {} points, where its header promises {}; copy or record the "
                    "file again",
                    path.string(), cloud.points.size(), count));
  }
  return cloud;
}

PointCloud ReadBinaryRecords(const std::filesystem::path& path, std::string_view body, const RecordLayout& layout,
                             std::size_t count, std::size_t offset) {
  const PointFields fields(path, layout);
  if (!FitsInto(count, layout.bytes(), body.size())) FailTruncated(path, body.size(), count * layout.bytes(), offset);
  PointCloud cloud;
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* record = body.data() + i * layout.bytes();
    AppendPoint(
        fields, [&](const RecordField& f) { return ReadScalar(record + f.offset, f.type); }, &cloud);
  }
  return cloud;
}

PointCloud ReadBinaryColumns(const std::filesystem::path& path, std::string_view columns, const RecordLayout& layout,
                             std::size_t count) {
  const PointFields fields(path, layout);
  if (!FitsInto(count, layout.bytes(), columns.size())) FailTruncated(path, columns.size(), count * layout.bytes(), 0);
  PointCloud cloud;
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = [&](const RecordField& f) {
      const std::size_t width = ScalarBytes(f.type) * f.count;
      return ReadScalar(columns.data() + f.offset * count + i * width, f.type);
    };
    AppendPoint(fields, value, &cloud);
  }
  return cloud;
}

}  // namespace mapweld::io

// SPDX-License-Identifier: Apache-2.0
// Turns the records of a PCD or PLY body into points. Bodies come as one string; nothing is read past its end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "tools/io/point_cloud.hpp"
#include "tools/io/record_layout.hpp"

namespace mapweld::io {

// Where x, y, z and the optional values are. Throws when x, y or z is missing.
struct PointFields {
  PointFields(const std::filesystem::path& path, const RecordLayout& layout);
  const RecordField* xyz[3];
  const RecordField* intensity = nullptr;
  const RecordField* rgb[3] = {nullptr, nullptr, nullptr};  // PLY: one value each
  const RecordField* packed_rgb = nullptr;                  // PCD: 0x00RRGGBB, as an integer or in the bits of a float
};

// `count` text records, one to a line. `first_line` is the line number of the body's first line.
PointCloud ReadTextRecords(const std::filesystem::path& path, std::string_view body, const RecordLayout& layout,
                           std::size_t count, int first_line);
// `count` binary records from byte `offset` of the file on.
PointCloud ReadBinaryRecords(const std::filesystem::path& path, std::string_view body, const RecordLayout& layout,
                             std::size_t count, std::size_t offset);
// The same with all first fields, then all second fields and so on, as binary_compressed PCD files have it.
PointCloud ReadBinaryColumns(const std::filesystem::path& path, std::string_view columns, const RecordLayout& layout,
                             std::size_t count);

}  // namespace mapweld::io

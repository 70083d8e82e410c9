// SPDX-License-Identifier: Apache-2.0
#include "tools/io/ply.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "tools/io/atomic_file.hpp"
#include "tools/io/record_reader.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

struct Header {
  bool ascii = false;
  RecordLayout vertex;
  std::size_t vertices = 0;
  // Elements in front of the vertices: to be skipped.
  std::size_t bytes_before = 0;
  std::size_t lines_before = 0;
  std::size_t body_offset = 0;
  int body_line = 0;
};

std::optional<Scalar> ScalarOf(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, Scalar>, 16> kTypes = {{{"char", Scalar::kInt8},
                                                                           {"int8", Scalar::kInt8},
                                                                           {"uchar", Scalar::kUint8},
                                                                           {"uint8", Scalar::kUint8},
                                                                           {"short", Scalar::kInt16},
                                                                           {"int16", Scalar::kInt16},
                                                                           {"ushort", Scalar::kUint16},
                                                                           {"uint16", Scalar::kUint16},
                                                                           {"int", Scalar::kInt32},
                                                                           {"int32", Scalar::kInt32},
                                                                           {"uint", Scalar::kUint32},
                                                                           {"uint32", Scalar::kUint32},
                                                                           {"float", Scalar::kFloat},
                                                                           {"float32", Scalar::kFloat},
                                                                           {"double", Scalar::kDouble},
                                                                           {"float64", Scalar::kDouble}}};
  for (const auto& [name, scalar] : kTypes) {
    if (name == type) return scalar;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  Header Read() {
    if (NextLine() != std::vector<std::string_view>{"ply"}) Fail("this is no PLY file");
    bool format_known = false;
    for (auto words = NextLine(); words.empty() || words[0] != "end_header"; words = NextLine()) {
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format" && words.size() >= 2) {
        if (words[1] != "ascii" && words[1] != "binary_little_endian") {
          Fail(fmt::format("format {} is not supported, only ascii and binary_little_endian", words[1].substr(0, 40)));
        }
        header_.ascii = words[1] == "ascii";
        format_known = true;
      } else if (words[0] == "element" && words.size() == 3) {
        BeginElement(words[1], words[2]);
      } else if (words[0] == "property" && words.size() >= 3) {
        AddProperty(words);
      } else {
        Fail(fmt::format("'{}' is no PLY header entry", words[0].substr(0, 40)));
      }
    }
    if (!format_known) Fail("the header names no format");
    if (place_ == Place::kBefore) Fail("there is no vertex element");
    header_.body_offset = at_;
    header_.body_line = line_ + 1;
    return header_;
  }

 private:
  enum class Place { kBefore, kVertices, kAfter };

  [[noreturn]] void Fail(std::string_view what) const {
    throw std::runtime_error(
        fmt::format("{}:{}: {}; export the cloud as binary PLY again", path_.string(), line_, what));
  }

  std::vector<std::string_view> NextLine() {
    const std::size_t end = bytes_.find('\n', at_);
    ++line_;
    if (end == std::string_view::npos || end - at_ > 4096) Fail("no PLY header that ends with end_header");
    auto words = SplitWords(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    return words;
  }

  void BeginElement(std::string_view name, std::string_view count) {
    FinishElement();
    double value = -1;
    if (!ParseNumber(count, &value) || !(value >= 0 && value < 4294967296.0)) {
      Fail(fmt::format("'{}' is not a count", count.substr(0, 40)));
    }
    element_count_ = static_cast<std::size_t>(value);
    if (place_ == Place::kVertices) place_ = Place::kAfter;
    if (name == "vertex" && place_ == Place::kBefore) {
      place_ = Place::kVertices;
      header_.vertices = element_count_;
    }
  }

  // Counts what the element that just ended puts in front of the vertices.
  void FinishElement() {
    if (place_ == Place::kBefore) {
      header_.bytes_before += element_count_ * element_bytes_;
      header_.lines_before += element_count_;
    }
    element_bytes_ = 0;
  }

  void AddProperty(const std::vector<std::string_view>& words) {
    if (place_ == Place::kAfter) return;
    const auto type = ScalarOf(words[1]);
    if (!type || words.size() != 3) {
      Fail(fmt::format("cannot read property {} {}, only plain numbers", words[1].substr(0, 40),
                       words.back().substr(0, 40)));
    }
    if (place_ == Place::kVertices) {
      header_.vertex.Add(std::string(words[2]), *type, 1);
    } else {
      element_bytes_ += ScalarBytes(*type);
    }
  }

  std::filesystem::path path_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
  Place place_ = Place::kBefore;
  std::size_t element_count_ = 0;
  std::size_t element_bytes_ = 0;
  Header header_;
};

}  // namespace

PointCloud ReadPly(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path);
  const Header header = HeaderReader(path, bytes).Read();
  std::string_view body = std::string_view(bytes).substr(header.body_offset);
  if (!header.ascii) {
    const std::size_t skip = std::min(header.bytes_before, body.size());
    return ReadBinaryRecords(path, body.substr(skip), header.vertex, header.vertices, header.body_offset + skip);
  }
  int line = header.body_line;
  for (std::size_t i = 0; i < header.lines_before && !body.empty(); ++i, ++line) {
    body.remove_prefix(std::min(body.find('\n'), body.size() - 1) + 1);
  }
  return ReadTextRecords(path, body, header.vertex, header.vertices, line);
}

void WritePly(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding) {
  const bool colored = !cloud.colors.empty();
  const bool shaded = !cloud.intensities.empty();
  AtomicFile file(path);
  file.Write(fmt::format("ply\nformat {} 1.0\ncomment metres\nelement vertex {}\n",
                         encoding == Encoding::kAscii ? "ascii" : "binary_little_endian", cloud.points.size()));
  file.Write("property float x\nproperty float y\nproperty float z\n");
  if (colored) file.Write("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  if (shaded) file.Write("property float intensity\n");
  file.Write("end_header\n");
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (encoding == Encoding::kAscii) {
      file.Write(fmt::format("{} {} {}", p.x(), p.y(), p.z()));
      if (colored) file.Write(fmt::format(" {} {} {}", cloud.colors[i][0], cloud.colors[i][1], cloud.colors[i][2]));
      if (shaded) file.Write(fmt::format(" {}", cloud.intensities[i]));
      file.Write("\n");
      continue;
    }
    file.Write(std::string_view(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float)));
    if (colored) file.Write(std::span<const std::uint8_t>(cloud.colors[i]));
    if (shaded) file.Write(std::string_view(reinterpret_cast<const char*>(&cloud.intensities[i]), sizeof(float)));
  }
  file.Commit();
}

}  // namespace mapweld::io

// SPDX-License-Identifier: Apache-2.0
#include "tools/io/pcd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "tools/io/atomic_file.hpp"
#include "tools/io/lzf.hpp"
#include "tools/io/record_reader.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

constexpr std::uint64_t kMostPoints = 1ULL << 32U;  // PCL counts in 32 bits

struct Header {
  RecordLayout layout;
  std::uint64_t points = 0;
  std::string data;  // ascii, binary, binary_compressed
  std::size_t body_offset = 0;
  int body_line = 0;
};

std::optional<Scalar> ScalarOf(std::string_view type, std::size_t bytes) {
  constexpr Scalar kSigned[] = {Scalar::kInt8, Scalar::kInt16, Scalar::kInt32, Scalar::kInt64};
  constexpr Scalar kUnsigned[] = {Scalar::kUint8, Scalar::kUint16, Scalar::kUint32, Scalar::kUint64};
  const std::size_t power = bytes == 1 ? 0 : bytes == 2 ? 1 : bytes == 4 ? 2 : bytes == 8 ? 3 : 4;
  if (type == "F" && power == 2) return Scalar::kFloat;
  if (type == "F" && power == 3) return Scalar::kDouble;
  if (type == "I" && power < 4) return kSigned[power];
  if (type == "U" && power < 4) return kUnsigned[power];
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  Header Read() {
    while (header_.data.empty()) ReadLine();
    BuildLayout();
    // POINTS is the count; files that leave it out have WIDTH times HEIGHT.
    header_.points = points_.value_or(width_ * height_);
    if (header_.points > kMostPoints) Fail(fmt::format("{} points are more than any PCD file holds", header_.points));
    header_.body_offset = at_;
    header_.body_line = line_ + 1;
    return header_;
  }

 private:
  [[noreturn]] void Fail(std::string_view what) const {
    throw std::runtime_error(
        fmt::format("{}:{}: {}; export the file as PCD 0.7 again", path_.string(), std::max(line_, 1), what));
  }

  std::uint64_t Unsigned(std::string_view word) const {
    double value = -1;
    if (!ParseNumber(word, &value) || !(value >= 0 && value < 1e15)) {
      Fail(fmt::format("'{}' is not a count", word.substr(0, 40)));
    }
    return static_cast<std::uint64_t>(value);
  }

  void ReadLine() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos || end - at_ > 4096) Fail("no PCD header that ends with a DATA line");
    ++line_;
    const auto words = SplitWords(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    if (words.empty() || words[0].front() == '#') return;
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    if (words[0] == "FIELDS" || words[0] == "COLUMNS") {
      names_ = values;
    } else if (words[0] == "SIZE") {
      sizes_ = values;
    } else if (words[0] == "TYPE") {
      types_ = values;
    } else if (words[0] == "COUNT") {
      counts_ = values;
    } else if (words[0] == "WIDTH" || words[0] == "HEIGHT" || words[0] == "POINTS") {
      if (values.size() != 1) Fail(fmt::format("{} needs one number", words[0]));
      const std::uint64_t count = Unsigned(values[0]);
      if (count > kMostPoints) Fail(fmt::format("{} is too large", values[0]));
      if (words[0] == "WIDTH") width_ = count;
      if (words[0] == "HEIGHT") height_ = count;
      if (words[0] == "POINTS") points_ = count;
    } else if (words[0] == "DATA") {
      if (values.size() != 1) Fail("DATA needs one word");
      header_.data = values[0];
    } else if (words[0] != "VERSION" && words[0] != "VIEWPOINT") {
      Fail(fmt::format("'{}' is no PCD header entry", words[0].substr(0, 40)));
    }
  }

  void BuildLayout() {
    const bool binary = header_.data != "ascii";
    if (names_.empty()) Fail("the header names no FIELDS");
    if (sizes_.size() != names_.size() || types_.size() != names_.size() ||
        (!counts_.empty() && counts_.size() != names_.size())) {
      Fail("FIELDS, SIZE, TYPE and COUNT differ in length");
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      auto type = ScalarOf(types_[i], static_cast<std::size_t>(Unsigned(sizes_[i])));
      if (!type) Fail(fmt::format("field {} has the unknown type {}{}", names_[i], types_[i], sizes_[i]));
      const std::uint64_t count = counts_.empty() ? 1 : Unsigned(counts_[i]);
      if (count < 1 || count > 1'000'000) Fail(fmt::format("field {} has COUNT {}", names_[i], count));
      // Colour in the bits of a float is read as the integer it is: some colours are no valid floats.
      if (binary && type == Scalar::kFloat && (names_[i] == "rgb" || names_[i] == "rgba")) type = Scalar::kUint32;
      header_.layout.Add(std::string(names_[i]), *type, static_cast<std::size_t>(count));
    }
  }

  std::filesystem::path path_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
  Header header_;
  std::vector<std::string_view> names_, sizes_, types_, counts_;
  std::uint64_t width_ = 0;
  std::uint64_t height_ = 1;
  std::optional<std::uint64_t> points_;
};

// Two little-endian 32-bit sizes (compressed, uncompressed), then the LZF block.
std::string Decompress(const std::filesystem::path& path, std::string_view body, std::size_t offset) {
  const auto fail = [&](std::string_view what) {
    throw std::runtime_error(
        fmt::format("{}: {} at offset {}; copy or record the file again", path.string(), what, offset));
  };
  std::uint32_t sizes[2] = {};
  if (body.size() < sizeof(sizes)) fail("truncated before the sizes of its compressed points");
  std::memcpy(sizes, body.data(), sizeof(sizes));
  body.remove_prefix(sizeof(sizes));
  if (sizes[0] > body.size()) {
    fail(fmt::format("truncated, {} of {} compressed bytes are there", body.size(), sizes[0]));
  }
  std::string columns;
  if (!DecompressLzf(body.substr(0, sizes[0]), sizes[1], &columns)) fail("damaged compressed points");
  return columns;
}

}  // namespace

PointCloud ReadPcd(const std::filesystem::path& path) {
  const std::string bytes = ReadFile(path);
  const Header header = HeaderReader(path, bytes).Read();
  const auto count = static_cast<std::size_t>(header.points);
  const std::string_view body = std::string_view(bytes).substr(header.body_offset);
  if (header.data == "ascii") return ReadTextRecords(path, body, header.layout, count, header.body_line);
  if (header.data == "binary") return ReadBinaryRecords(path, body, header.layout, count, header.body_offset);
  if (header.data == "binary_compressed") {
    if (count == 0) return {};
    return ReadBinaryColumns(path, Decompress(path, body, header.body_offset), header.layout, count);
  }
  throw std::runtime_error(fmt::format("{}: DATA {} is unknown; export as ascii, binary or binary_compressed",
                                       path.string(), header.data.substr(0, 40)));
}

void WritePcd(const std::filesystem::path& path, const PointCloud& cloud, Encoding encoding) {
  const bool colored = !cloud.colors.empty();
  const bool shaded = !cloud.intensities.empty();
  const auto line = [&](std::string_view key, std::string_view xyz, std::string_view rgb, std::string_view intensity) {
    return fmt::format("{} {}{}{}\n", key, xyz, colored ? rgb : "", shaded ? intensity : "");
  };
  AtomicFile file(path);
  file.Write("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n");
  file.Write(line("FIELDS", "x y z", " rgb", " intensity"));
  file.Write(line("SIZE", "4 4 4", " 4", " 4"));
  file.Write(line("TYPE", "F F F", " U", " F"));
  file.Write(line("COUNT", "1 1 1", " 1", " 1"));
  file.Write(fmt::format("WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA {1}\n", cloud.points.size(),
                         encoding == Encoding::kAscii ? "ascii" : "binary"));
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    std::uint32_t rgb = 0;
    if (colored) {
      for (const std::uint8_t channel : cloud.colors[i]) rgb = (rgb << 8U) | channel;
    }
    if (encoding == Encoding::kAscii) {
      file.Write(fmt::format("{} {} {}", p.x(), p.y(), p.z()));  // the shortest text that reads back to the same float
      if (colored) file.Write(fmt::format(" {}", rgb));
      if (shaded) file.Write(fmt::format(" {}", cloud.intensities[i]));
      file.Write("\n");
      continue;
    }
    file.Write(std::string_view(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float)));
    if (colored) file.Write(std::string_view(reinterpret_cast<const char*>(&rgb), sizeof(rgb)));
    if (shaded) file.Write(std::string_view(reinterpret_cast<const char*>(&cloud.intensities[i]), sizeof(float)));
  }
  file.Commit();
}

}  // namespace mapweld::io

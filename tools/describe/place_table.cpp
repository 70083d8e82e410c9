// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/place_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "tools/io/atomic_file.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::describe {
namespace {

constexpr std::size_t kFixedColumns = 5;
constexpr std::size_t kColumns = kFixedColumns + place::kDescriptorDim + place::kSignatureDim;

std::string Header() {
  std::string header = "scan,x,y,z,scale";
  for (int i = 0; i < place::kDescriptorDim; ++i) fmt::format_to(std::back_inserter(header), ",d{}", i);
  for (int i = 0; i < place::kSignatureDim; ++i) fmt::format_to(std::back_inserter(header), ",o{}", i);
  return header;
}

template <std::size_t N>
void AppendBytes(const std::array<std::int8_t, N>& q, std::string* line) {
  for (const std::int8_t v : q) fmt::format_to(std::back_inserter(*line), ",{}", v);
}

template <std::size_t N>
void ReadBytes(const io::TextRows& table, const io::TextRow& row, std::size_t first, std::array<std::int8_t, N>* q) {
  for (std::size_t i = 0; i < N; ++i) {
    const double value = table.Number(row, first + i);
    if (value != std::floor(value) || value < -128 || value > 127) {
      table.Fail(row, fmt::format("'{}' in column {} is not an integer from -128 to 127", row.words[first + i],
                                  first + i + 1));
    }
    (*q)[i] = static_cast<std::int8_t>(value);
  }
}

}  // namespace

void WritePlaceTable(const std::filesystem::path& file, const std::vector<PlaceRow>& rows) {
  io::AtomicFile out(file);
  out.Write(Header() + '\n');
  std::string line;
  for (const PlaceRow& row : rows) {
    const geom::Vec3d& p = row.position;
    line = fmt::format("{},{:.4f},{:.4f},{:.4f},{}", row.scan, p.x(), p.y(), p.z(), row.place.descriptor.scale);
    AppendBytes(row.place.descriptor.q, &line);
    AppendBytes(row.place.orientation.q, &line);
    out.Write(line + '\n');
  }
  out.Commit();
}

std::vector<PlaceRow> ReadPlaceTable(const std::filesystem::path& file) {
  const io::TextRows table(file);
  const std::string header = Header();
  const auto is_header = [&](const io::TextRow& row) { return row.words == io::SplitWords(header); };
  if (table.rows().empty() || !is_header(table.rows().front())) {
    throw std::runtime_error(fmt::format(
        "{} does not begin with 'scan,x,y,z,scale,d0,...,d{},o0,...,o{}'; is it a table of mapweld describe?",
        file.string(), place::kDescriptorDim - 1, place::kSignatureDim - 1));
  }
  std::vector<PlaceRow> rows;
  for (std::size_t i = 1; i < table.rows().size(); ++i) {
    const io::TextRow& text = table.rows()[i];
    table.ExpectColumns(text, kColumns, "scan, position, scale, descriptor and signature");
    PlaceRow row;
    const double scan = table.Number(text, 0);
    if (scan != std::floor(scan) || std::abs(scan) > 1e9) table.Fail(text, "the scan is not an integer");
    row.scan = static_cast<int>(scan);
    row.position = {table.Number(text, 1), table.Number(text, 2), table.Number(text, 3)};
    const double scale = table.Number(text, 4);
    if (scale < 0) table.Fail(text, "the scale is negative");
    row.place.descriptor.scale = row.place.orientation.scale = static_cast<float>(scale);
    ReadBytes(table, text, kFixedColumns, &row.place.descriptor.q);
    ReadBytes(table, text, kFixedColumns + place::kDescriptorDim, &row.place.orientation.q);
    rows.push_back(row);
  }
  if (rows.empty()) throw std::runtime_error(fmt::format("{} has a header but no rows", file.string()));
  return rows;
}

}  // namespace mapweld::describe

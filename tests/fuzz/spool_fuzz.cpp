// SPDX-License-Identifier: Apache-2.0
// The input is a spool file found at boot. First byte: whether the segments' headers are made valid, and the checksums
// of the records, so that the code behind them is reached.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "core/base/crc32.hpp"
#include "drivers/spool/record_spool.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace mapweld::fuzz {
namespace {

constexpr std::int32_t kEpoch = 3;

std::size_t SegmentBytes(const Bytes& file) {
  return file.size() / spool::kSegments / 8 * 8;
}

void PatchHeaders(Bytes* file) {
  for (std::size_t i = 0; i < spool::kSegments; ++i) {
    const auto header =
        spool::EncodeSegmentHeader({.use = static_cast<std::uint32_t>(1 + i), .file_bytes = file->size()});
    const std::size_t begin = i * SegmentBytes(*file);
    std::copy_n(header.begin(), std::min(header.size(), file->size() - begin),
                file->begin() + static_cast<std::ptrdiff_t>(begin));
  }
}

void PatchRecords(std::span<std::uint8_t> segment) {
  for (std::size_t at = spool::SegmentHeader::kBytes; at + spool::RecordHeader::kBytes <= segment.size();) {
    spool::RecordHeaderBytes raw;
    std::copy_n(segment.begin() + static_cast<std::ptrdiff_t>(at), raw.size(), raw.begin());
    spool::RecordHeader header;
    const std::size_t room = segment.size() - at - raw.size();
    if (spool::DecodeRecordHeader(raw, &header) == Status::kBadInput || header.length > room) return;
    header.crc = Crc32(segment.subspan(at + raw.size(), header.length));
    std::ranges::copy(spool::EncodeRecordHeader(header), segment.begin() + static_cast<std::ptrdiff_t>(at));
    at += spool::RecordBytes(header.length);
  }
}

void PatchAllRecords(Bytes* file) {
  for (std::size_t i = 0; i < spool::kSegments; ++i) {
    PatchRecords(std::span(*file).subspan(i * SegmentBytes(*file), SegmentBytes(*file)));
  }
}

}  // namespace

std::vector<Bytes> Seeds() {
  Bytes file(4 * 192);
  PatchHeaders(&file);
  for (std::uint32_t segment = 0; segment < spool::kSegments; ++segment) {
    std::size_t at = segment * SegmentBytes(file) + spool::SegmentHeader::kBytes;
    for (std::int32_t i = 0; i < 2; ++i) {
      const auto length = static_cast<std::uint32_t>(20 + 13 * i);
      const auto raw = spool::EncodeRecordHeader(
          {.use = 1 + segment, .kind = 1, .index = i, .epoch = kEpoch, .length = length, .crc = 0});
      std::ranges::copy(raw, file.begin() + static_cast<std::ptrdiff_t>(at));
      at += spool::RecordBytes(length);
    }
  }
  PatchAllRecords(&file);
  Bytes as_it_is = file;
  as_it_is.insert(as_it_is.begin(), 0);
  file.insert(file.begin(), 3);
  return {as_it_is, file};
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  fuzz::Input input(data, size);
  const std::uint64_t selector = input.Number(1);
  fuzz::Bytes file = input.Rest();
  if ((selector & 1U) != 0) fuzz::PatchHeaders(&file);
  if ((selector & 2U) != 0) fuzz::PatchAllRecords(&file);
  static const int fd = ::memfd_create("spool", 0);  // one for all inputs: making files is what costs
  static const std::string path = "/proc/self/fd/" + std::to_string(fd);
  FUZZ_REQUIRE(::ftruncate(fd, 0) == 0);
  FUZZ_REQUIRE(::pwrite(fd, file.data(), file.size(), 0) == static_cast<ssize_t>(file.size()));

  static spool::RecordSpool spool;
  const std::uint64_t recovered_before = spool.counters().recovered;
  if (spool.Open(path.c_str(), file.size()) == Status::kOk) {
    FUZZ_REQUIRE(spool.counters().recovered - recovered_before == spool.size());
    fuzz::Bytes out(file.size());
    for (std::int32_t index = 0; index < 4; ++index) {
      const Result<std::size_t> got = spool.Read({fuzz::kEpoch, 1, index}, out);
      FUZZ_REQUIRE(got.ok() || got.status() == Status::kEmpty || got.status() == Status::kCrc);
    }
    spool::RecordSpool::Key last;
    FUZZ_REQUIRE(spool.LastBefore(1 << 30, 1, &last) != Status::kOk || spool.Has(last));
    const fuzz::Bytes content{1, 2, 3, 4, 5};
    const spool::RecordSpool::Key key{fuzz::kEpoch, 9, 77};
    FUZZ_REQUIRE(spool.Append(key, content) == Status::kOk);
    const Result<std::size_t> got = spool.Read(key, out);
    FUZZ_REQUIRE(got.ok() && got.value() == content.size() && std::equal(content.begin(), content.end(), out.begin()));
  }
  spool.Close();
  return 0;
}

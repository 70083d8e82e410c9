// SPDX-License-Identifier: Apache-2.0
// The input is a spool file found at boot. First byte: whether the file header is made valid, and the checksums of the
// records, so that the code behind them is reached.
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

void PatchHeader(Bytes* file) {
  const spool::FileHeaderBytes header = spool::EncodeFileHeader({.epoch = kEpoch, .file_bytes = file->size()});
  std::copy_n(header.begin(), std::min(header.size(), file->size()), file->begin());
}

void PatchRecordChecksums(Bytes* file) {
  for (std::size_t at = spool::FileHeader::kBytes; at + spool::RecordHeader::kBytes <= file->size();) {
    spool::RecordHeaderBytes raw;
    std::copy_n(file->begin() + static_cast<std::ptrdiff_t>(at), raw.size(), raw.begin());
    spool::RecordHeader header;
    const std::size_t room = file->size() - at - raw.size();
    if (spool::DecodeRecordHeader(raw, &header) != Status::kOk || header.length > room) return;
    const std::span<const std::uint8_t> content = std::span(*file).subspan(at + raw.size(), header.length);
    header.crc = Crc32(content, spool::RecordCrcSeed(header));
    raw = spool::EncodeRecordHeader(header);
    std::ranges::copy(raw, file->begin() + static_cast<std::ptrdiff_t>(at));
    at += spool::RecordBytes(header.length);
  }
}

}  // namespace

std::vector<Bytes> Seeds() {
  Bytes file(400);
  PatchHeader(&file);
  std::size_t at = spool::FileHeader::kBytes;
  for (std::int32_t i = 0; i < 3; ++i) {
    const auto length = static_cast<std::uint32_t>(20 + 13 * i);
    const auto raw = spool::EncodeRecordHeader({.kind = 1, .index = i, .epoch = kEpoch, .length = length, .crc = 0});
    std::ranges::copy(raw, file.begin() + static_cast<std::ptrdiff_t>(at));
    at += spool::RecordBytes(length);
  }
  PatchRecordChecksums(&file);
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
  if ((selector & 1U) != 0) fuzz::PatchHeader(&file);
  if ((selector & 2U) != 0) fuzz::PatchRecordChecksums(&file);
  const int fd = ::memfd_create("spool", 0);
  FUZZ_REQUIRE(::write(fd, file.data(), file.size()) == static_cast<ssize_t>(file.size()));

  static spool::RecordSpool spool;
  const std::string path = "/proc/self/fd/" + std::to_string(fd);
  const std::uint64_t recovered_before = spool.counters().recovered;
  if (spool.Open(path.c_str(), file.size(), fuzz::kEpoch) == Status::kOk) {
    FUZZ_REQUIRE(spool.counters().recovered - recovered_before == spool.size());
    fuzz::Bytes out(file.size());
    for (std::int32_t index = 0; index < 4; ++index) {
      const Result<std::size_t> got = spool.Read(1, index, out);
      FUZZ_REQUIRE(got.ok() || got.status() == Status::kEmpty);
    }
    const fuzz::Bytes content{1, 2, 3, 4, 5};
    const std::uint64_t room = spool.free_bytes();
    const Status status = spool.Append(9, 77, content);
    FUZZ_REQUIRE((status == Status::kOk) == (room >= spool::RecordBytes(content.size())));
    if (status == Status::kOk) {
      const Result<std::size_t> got = spool.Read(9, 77, out);
      FUZZ_REQUIRE(got.ok() && got.value() == content.size() &&
                   std::equal(content.begin(), content.end(), out.begin()));
    }
  }
  spool.Close();
  ::close(fd);
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "drivers/spool/record_spool.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>

#include "core/base/crc32.hpp"

namespace mapweld::spool {
namespace {

bool ReadAt(int fd, std::span<std::uint8_t> out, std::uint64_t at) {
  return ::pread(fd, out.data(), out.size(), static_cast<off_t>(at)) == static_cast<ssize_t>(out.size());
}

bool WriteAt(int fd, std::span<const std::uint8_t> bytes, std::uint64_t at) {
  return ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(at)) == static_cast<ssize_t>(bytes.size());
}

}  // namespace

void RecordSpool::Close() {
  if (fd_ >= 0) (void)::close(fd_);
  fd_ = -1;
  file_bytes_ = end_ = 0;
  records_ = 0;
}

Status RecordSpool::Open(const char* path, std::uint64_t bytes, std::int32_t epoch) {
  Close();
  if (bytes < FileHeader::kBytes + RecordBytes(1) || bytes > kMaxFileBytes) return Status::kOutOfRange;
  fd_ = ::open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd_ < 0) return Status::kIo;
  Status status = ::flock(fd_, LOCK_EX | LOCK_NB) == 0 ? Status::kOk : Status::kIo;
  if (status == Status::kOk && !Recover(bytes, epoch)) status = Start(bytes, epoch);
  if (status != Status::kOk) {
    const int why = errno;
    Close();
    errno = why;
  }
  return status;
}

// An empty spool. Cutting to nothing first makes the file read as zeros, so that no old record is ever taken for a new
// one.
Status RecordSpool::Start(std::uint64_t bytes, std::int32_t epoch) {
  epoch_ = epoch;
  file_bytes_ = bytes;
  end_ = FileHeader::kBytes;
  records_ = 0;
  if (::ftruncate(fd_, 0) != 0) return Status::kIo;
  if (const int why = ::posix_fallocate(fd_, 0, static_cast<off_t>(bytes)); why != 0) {
    errno = why;
    return Status::kIo;
  }
  const FileHeaderBytes header = EncodeFileHeader({.epoch = epoch, .file_bytes = bytes});
  return WriteAt(fd_, header, 0) && ::fsync(fd_) == 0 ? Status::kOk : Status::kIo;
}

bool RecordSpool::Recover(std::uint64_t bytes, std::int32_t epoch) {
  struct stat info {};
  if (::fstat(fd_, &info) != 0 || info.st_size != static_cast<off_t>(bytes)) return false;
  FileHeaderBytes raw;
  FileHeader header;
  if (!ReadAt(fd_, raw, 0) || DecodeFileHeader(raw, &header) != Status::kOk) return false;
  if (header.epoch != epoch || header.file_bytes != bytes) return false;
  epoch_ = epoch;
  file_bytes_ = bytes;
  end_ = FileHeader::kBytes;
  records_ = 0;
  while (RecoverRecord()) ++counters_.recovered;
  return true;
}

// Takes the record at end_ into the index; false at the first place that does not hold a whole one.
bool RecordSpool::RecoverRecord() {
  RecordHeaderBytes raw;
  RecordHeader header;
  if (records_ == index_.size() || free_bytes() < RecordBytes(1)) return false;
  if (!ReadAt(fd_, raw, end_) || DecodeRecordHeader(raw, &header) != Status::kOk) return false;
  if (header.epoch != epoch_ || header.length == 0 || RecordBytes(header.length) > free_bytes()) return false;
  std::uint32_t crc = RecordCrcSeed(header);
  std::array<std::uint8_t, 4096> piece;
  for (std::uint64_t done = 0; done < header.length;) {
    const std::size_t now = std::min<std::uint64_t>(piece.size(), header.length - done);
    if (!ReadAt(fd_, std::span(piece).first(now), end_ + RecordHeader::kBytes + done)) return false;
    crc = Crc32(std::span(piece).first(now), crc);
    done += now;
  }
  if (crc != header.crc) return false;
  Remember(header);
  return true;
}

void RecordSpool::Remember(const RecordHeader& header) {
  index_[records_++] = {.index = header.index,
                        .offset8 = static_cast<std::uint32_t>(end_ / 8),
                        .length = header.length,
                        .kind = header.kind};
  end_ += RecordBytes(header.length);
}

Status RecordSpool::Append(std::uint8_t kind, std::int32_t index, std::span<const std::uint8_t> content) {
  if (fd_ < 0) return Status::kIo;
  if (content.empty() || content.size() > std::numeric_limits<std::uint32_t>::max()) return Status::kOutOfRange;
  if (records_ == index_.size() || RecordBytes(content.size()) > free_bytes()) {
    ++counters_.full;
    return Status::kFull;
  }
  RecordHeader header{
      .kind = kind, .index = index, .epoch = epoch_, .length = static_cast<std::uint32_t>(content.size()), .crc = 0};
  header.crc = Crc32(content, RecordCrcSeed(header));
  RecordHeaderBytes raw = EncodeRecordHeader(header);
  // pwritev does not write through these pointers; the interface is older than const.
  const std::array<iovec, 2> iov{{{.iov_base = raw.data(), .iov_len = raw.size()},
                                  {.iov_base = const_cast<std::uint8_t*>(content.data()), .iov_len = content.size()}}};
  const auto bytes = static_cast<ssize_t>(raw.size() + content.size());
  if (::pwritev(fd_, iov.data(), static_cast<int>(iov.size()), static_cast<off_t>(end_)) != bytes) {
    ++counters_.io_errors;
    return Status::kIo;
  }
  Remember(header);
  ++counters_.appended;
  counters_.appended_bytes += content.size();
  return Status::kOk;
}

// From the newest to the oldest, so that a repeated index gives its last record.
const RecordSpool::Entry* RecordSpool::Find(std::uint8_t kind, std::int32_t index) const {
  for (std::size_t i = records_; i > 0; --i) {
    const Entry& entry = index_[i - 1];
    if (entry.kind == kind && entry.index == index) return &entry;
  }
  return nullptr;
}

Result<std::size_t> RecordSpool::Read(std::uint8_t kind, std::int32_t index, std::span<std::uint8_t> out) {
  const Entry* entry = Find(kind, index);
  if (entry == nullptr) return Status::kEmpty;
  if (out.size() < entry->length) return Status::kFull;
  const std::uint64_t at = std::uint64_t{entry->offset8} * 8;
  const std::span<std::uint8_t> content = out.first(entry->length);
  RecordHeaderBytes raw;
  RecordHeader header;
  if (!ReadAt(fd_, raw, at) || !ReadAt(fd_, content, at + RecordHeader::kBytes)) {
    ++counters_.io_errors;
    return Status::kIo;
  }
  const bool whole = DecodeRecordHeader(raw, &header) == Status::kOk && header.kind == kind && header.index == index &&
                     header.length == entry->length && Crc32(content, RecordCrcSeed(header)) == header.crc;
  if (!whole) {
    ++counters_.crc_errors;
    return Status::kCrc;
  }
  return content.size();
}

Status RecordSpool::Sync() {
  if (fd_ >= 0 && ::fdatasync(fd_) == 0) return Status::kOk;
  ++counters_.io_errors;
  return Status::kIo;
}

}  // namespace mapweld::spool

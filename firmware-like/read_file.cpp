// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/read_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace mapweld::executive {

Status ReadFile(const char* path, std::span<char> buffer, std::size_t* bytes) {
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

}  // namespace mapweld::executive

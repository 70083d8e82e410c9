// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace mapweld::sim {

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), buffer_(1U << 18U), file_(std::fopen(path.c_str(), "wb")) {
  if (file_ == nullptr) Fail();
  (void)std::setvbuf(file_.get(), buffer_.data(), _IOFBF, buffer_.size());
}

void OutputFile::Write(const void* bytes, std::size_t n) {
  if (std::fwrite(bytes, 1, n, file_.get()) != n) Fail();
}

void OutputFile::Close() {
  if (std::fflush(file_.get()) != 0) Fail();
  if (std::fclose(file_.release()) != 0) Fail();
}

void OutputFile::Fail() const {
  const int error = errno;
  const char* remedy = error == ENOSPC ? "; free some space or choose another disk with -o" : "";
  throw std::runtime_error(fmt::format("cannot write {}: {}{}", path_.string(), std::strerror(error), remedy));
}

}  // namespace mapweld::sim

// SPDX-License-Identifier: Apache-2.0
// A file to write whose every failure, a full disk above all, becomes an exception with the file's name.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace mapweld::sim {

class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);
  void Write(std::string_view text) { Write(text.data(), text.size()); }
  void Write(std::span<const std::uint8_t> bytes) { Write(bytes.data(), bytes.size()); }
  // Must be the last call; a file that is dropped without it may be incomplete.
  void Close();

 private:
  void Write(const void* bytes, std::size_t n);
  [[noreturn]] void Fail() const;
  struct Closer {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  std::filesystem::path path_;
  std::vector<char> buffer_;  // outlives the file that uses it
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace mapweld::sim

// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/ip_command.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace mapweld::doctor {
namespace {

constexpr int kNoProgram = 127;

// Standard output and, behind it, what went wrong.
struct Output {
  std::string text;
  int code = kNoProgram;
};

Output Run(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));  // exec does not write
  argv.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
    ::execvp(argv[0], argv.data());
    ::_exit(kNoProgram);
  }
  ::close(ends[1]);
  Output output;
  std::array<char, 4096> piece;
  for (ssize_t got = 0; (got = ::read(ends[0], piece.data(), piece.size())) > 0;) {
    output.text.append(piece.data(), static_cast<std::size_t>(got));
  }
  ::close(ends[0]);
  int status = 0;
  if (child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status)) output.code = WEXITSTATUS(status);
  return output;
}

}  // namespace

nlohmann::json RunIp(const std::vector<std::string>& arguments, std::string* complaint) {
  std::vector<std::string> command{"ip", "-json"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const Output output = Run(command);
  if (output.code == kNoProgram) {
    throw std::runtime_error("the program 'ip' is needed; install it with 'apt-get install iproute2'");
  }
  auto json = nlohmann::json::parse(output.text, nullptr, false);
  if (output.code == 0 && json.is_array()) return json;
  *complaint = output.text.substr(0, output.text.find('\n'));
  return nlohmann::json::array();
}

}  // namespace mapweld::doctor

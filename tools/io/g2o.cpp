// SPDX-License-Identifier: Apache-2.0
#include "tools/io/g2o.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "tools/io/atomic_file.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

std::string PoseText(const geom::Pose3& pose) {
  return fmt::format("{:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}", pose.t.x(), pose.t.y(), pose.t.z(),
                     pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w());
}

class Parser {
 public:
  explicit Parser(std::string_view name) : name_(name) {}

  void Line(std::string_view text) {
    ++line_;
    words_ = SplitWords(text);
    if (words_.empty() || words_.front().front() == '#') return;
    const std::string_view record = words_.front();
    if (record == "VERTEX_SE3:QUAT") {
      Vertex();
    } else if (record == "EDGE_SE3:QUAT") {
      Edge();
    } else if (record == "FIX") {
      for (std::size_t i = 1; i < words_.size(); ++i) fixed_.push_back({Id(i), line_});
    } else if (record != "PARAMS_SE3OFFSET") {
      Fail(fmt::format("'{}' is not known here; VERTEX_SE3:QUAT, EDGE_SE3:QUAT and FIX are", record.substr(0, 40)));
    }
  }

  PoseGraphFile Finish() {
    for (const auto& [id, line] : fixed_) {
      const auto at = index_.find(id);
      line_ = line;
      if (at == index_.end()) Fail(fmt::format("FIX names vertex {}, which is not in the file", id));
      out_.vertices[at->second].fixed = true;
    }
    return std::move(out_);
  }

 private:
  struct Fixed {
    std::int64_t id;
    int line;
  };

  void Vertex() {
    Expect(9, "id x y z qx qy qz qw");
    PoseGraphVertex vertex{Id(1), PoseAt(2), false};
    if (!vertex.world_T_vertex.IsValid()) {
      Fail(fmt::format("vertex {} is not a pose: finite numbers and a quaternion of unit length", vertex.id));
    }
    if (!index_.emplace(vertex.id, out_.vertices.size()).second) {
      Fail(fmt::format("vertex {} is there twice; remove one", vertex.id));
    }
    out_.vertices.push_back(vertex);
  }

  void Edge() {
    Expect(31, "id id x y z qx qy qz qw and the upper triangle of the 6 x 6 information");
    PoseGraphEdge edge{Id(1), Id(2), PoseAt(3), geom::Mat6d::Zero(), line_};
    std::size_t word = 10;
    for (Eigen::Index r = 0; r < 6; ++r) {
      for (Eigen::Index c = r; c < 6; ++c) edge.information(r, c) = edge.information(c, r) = Number(word++);
    }
    out_.edges.push_back(edge);
  }

  void Expect(std::size_t words, std::string_view meaning) const {
    if (words_.size() == words) return;
    Fail(fmt::format("found {} values where {} belong ({})", words_.size() - 1, words - 1, meaning));
  }
  [[nodiscard]] geom::Pose3 PoseAt(std::size_t word) const {
    geom::Pose3 pose;
    pose.t = {Number(word), Number(word + 1), Number(word + 2)};
    pose.q = geom::Quatd(Number(word + 6), Number(word + 3), Number(word + 4), Number(word + 5));
    if (pose.IsValid()) pose.q.normalize();
    return pose;
  }
  [[nodiscard]] double Number(std::size_t word) const {
    double value = 0;
    if (!ParseNumber(words_[word], &value)) Fail(fmt::format("'{}' is not a number", words_[word].substr(0, 40)));
    return value;
  }
  [[nodiscard]] std::int64_t Id(std::size_t word) const {
    const std::string_view text = words_[word];
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      Fail(fmt::format("'{}' is not the number of a vertex", text.substr(0, 40)));
    }
    return value;
  }
  [[noreturn]] void Fail(std::string_view what) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", name_, line_, what));
  }

  std::string_view name_;
  int line_ = 0;
  std::vector<std::string_view> words_;
  PoseGraphFile out_;
  std::unordered_map<std::int64_t, std::size_t> index_;
  std::vector<Fixed> fixed_;
};

}  // namespace

PoseGraphFile ParseG2o(std::string_view text, std::string_view name) {
  Parser parser(name);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.Line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.Finish();
}

PoseGraphFile ReadG2o(const std::filesystem::path& path) {
  return ParseG2o(ReadFile(path), path.string());
}

void WriteG2o(const std::filesystem::path& path, const PoseGraphFile& graph) {
  AtomicFile file(path);
  for (const PoseGraphVertex& v : graph.vertices) {
    file.Write(fmt::format("VERTEX_SE3:QUAT {} {}\n", v.id, PoseText(v.world_T_vertex)));
  }
  for (const PoseGraphVertex& v : graph.vertices) {
    if (v.fixed) file.Write(fmt::format("FIX {}\n", v.id));
  }
  for (const PoseGraphEdge& e : graph.edges) {
    std::string line = fmt::format("EDGE_SE3:QUAT {} {} {}", e.a, e.b, PoseText(e.a_T_b));
    for (Eigen::Index r = 0; r < 6; ++r) {
      for (Eigen::Index c = r; c < 6; ++c) {
        line += fmt::format(" {:.9g}", e.information(r, c));
      }
    }
    file.Write(line += '\n');
  }
  file.Commit();
}

}  // namespace mapweld::io

// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/serve_command.hpp"

#include <memory>
#include <string>
#include <vector>

#include "tools/report/outcome.hpp"
#include "tools/serve/server.hpp"

namespace mapweld::serve {

void AddServeCommand(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("serve", "Collect drives from agents over LCM, merge them, send poses back");
  struct Arguments {
    ServeOptions options;
    std::vector<std::string> truth;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-o,--out", arguments->options.out, "folder for map, trajectories and report.html")->required();
  command->add_option("--store", arguments->options.store,
                      "file that keeps the city: what was received survives a crash, and the next run goes on from it");
  command
      ->add_option("--agents", arguments->options.agents,
                   "end when this many agents have ended their drives; "
                   "without it, on Ctrl-C")
      ->check(CLI::Range(1, 32767));
  command->add_option("--lcm-url", arguments->options.lcm_url, "LCM network (LCM_DEFAULT_URL, else LCM's default)");
  command
      ->add_option_function<double>(
          "--submap-rate", [arguments](double kb_per_s) { arguments->options.submap_bytes_per_s = kb_per_s * 1e3; },
          "kB/s of submaps asked of all agents together, most valuable first; without it, what the agents allow")
      ->check(CLI::PositiveNumber);
  command->add_option("--truth", arguments->truth,
                      "NAME=FILE: true trajectory of a drive, for the errors in the report");
  command->callback([arguments] {
    for (const std::string& truth : arguments->truth) arguments->options.truth.insert(report::ParseTruth(truth));
    Server(arguments->options).Run();
  });
}

}  // namespace mapweld::serve

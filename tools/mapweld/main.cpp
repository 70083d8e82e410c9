// SPDX-License-Identifier: Apache-2.0
// The `mapweld` command. Each subcommand lives with the library it drives.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tools/describe/describe_command.hpp"
#include "tools/doctor/doctor_command.hpp"
#include "tools/eval/eval_command.hpp"
#include "tools/mapweld/merge_command.hpp"
#include "tools/odometry/odometry_command.hpp"
#include "tools/pose_graph/optimize_command.hpp"
#include "tools/replay/replay_command.hpp"
#include "tools/serve/serve_command.hpp"
#include "tools/sim/sim_command.hpp"
#include "tools/spy/spy_command.hpp"
#include "tools/store/store_commands.hpp"

int main(int argc, char** argv) {
  CLI::App app("Merges the LiDAR maps of many vehicles into one, without GPS and without an initial guess.", "mapweld");
  app.set_version_flag("--version", "mapweld " MAPWELD_VERSION);
  app.require_subcommand(1);
  mapweld::merge::AddMergeCommand(app);
  mapweld::serve::AddServeCommand(app);
  mapweld::describe::AddDescribeCommand(app);
  mapweld::store::AddStoreCommands(app);
  mapweld::eval::AddEvalCommand(app);
  mapweld::sim::AddSimCommand(app);
  mapweld::replay::AddReplayCommand(app);
  mapweld::odometry::AddOdometryCommand(app);
  mapweld::pose_graph::AddOptimizeCommand(app);
  mapweld::spy::AddSpyCommand(app);
  mapweld::doctor::AddDoctorCommand(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // A mistyped option is what went wrong, even where it leaves another one without a value.
    const std::vector<std::string> unknown = app.remaining(true);
    unknown.empty() ? app.exit(error) : app.exit(CLI::ExtrasError(unknown));
    return 2;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mapweld: %s\n", error.what());
    return 1;
  }
  return 0;
}

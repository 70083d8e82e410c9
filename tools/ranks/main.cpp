// SPDX-License-Identifier: Apache-2.0
// mpirun -n 4 mapweld-ranks merge RECORDINGS -o OUT: what `mapweld merge` does, by many processes.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>

#include "tools/mapweld/merge_command.hpp"
#include "tools/ranks/mpi_crew.hpp"

int main(int argc, char** argv) {
  mapweld::ranks::Mpi mpi(&argc, &argv);
  CLI::App app("Merges maps by many processes under MPI, with the bytes of `mapweld merge`.", "mapweld-ranks");
  app.require_subcommand(1);
  mapweld::merge::AddMergeCommand(app, [&](mapweld::merge::Progress* progress) {
    return std::make_unique<mapweld::ranks::MpiCrew>(&mpi, progress);
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = mpi.rank() == 0 ? app.exit(error) : error.get_exit_code();
    mpi.End(code == 0 ? 0 : 2);
  } catch (const std::exception& error) {
    if (mpi.rank() == 0) std::fprintf(stderr, "mapweld-ranks: %s\n", error.what());
    mpi.End(1);
  }
  mpi.End(0);
}

#pragma once
/// \file The sub-commands of cutterflow. Each adds itself with its options; its callback does the work and throws Failure.
#include <CLI/CLI.hpp>

namespace cutterflow::cli {

void add_new(CLI::App& app);
void add_check(CLI::App& app);
void add_inspect(CLI::App& app);
void add_repair(CLI::App& app);
void add_clump(CLI::App& app);
void add_generate_cutter(CLI::App& app);
void add_generate_solid(CLI::App& app);
void add_mesh(CLI::App& app);
void add_run(CLI::App& app);
void add_report(CLI::App& app);
void add_measure(CLI::App& app);
void add_sweep(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_compare(CLI::App& app);
void add_replay(CLI::App& app);
void add_verify(CLI::App& app);
void add_params(CLI::App& app);

}  // namespace cutterflow::cli

// What the program does: one function per command.
#pragma once

#include <span>
#include <string>

#include "settings.h"

namespace varve::cli {

/// Runs the command line without the program's name. Returns the exit code, or throws what the command throws.
int run(std::span<const std::string> arguments);

int run_resolve(Settings& settings);
int run_probe(Settings& settings);
int run_compare(Settings& settings);
int run_synth(Settings& settings);
int run_jitter(Settings& settings);
int run_measure(Settings& settings);
int run_floor(Settings& settings);
int run_help(Settings& settings);
int run_version(Settings& settings);

/// Puts the role files where the library looks for them.
void finish_job(Settings& settings);

}  // namespace varve::cli

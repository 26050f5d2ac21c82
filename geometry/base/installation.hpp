#pragma once
/// \file Where the program that runs, its companions and its files stand. No path of the machine that built them is compiled in.
#include <filesystem>

namespace cutterflow {

/// Parts of one installation, below any prefix; a build folder is laid out alike.
struct Installation {
    std::filesystem::path prefix;
    std::filesystem::path programs;      ///< prefix/bin: cutterflow, cutterFoam, ...
    std::filesystem::path verification;  ///< prefix/libexec/cutterflow/verification: one program per case
    std::filesystem::path data;          ///< prefix/share/cutterflow: docs/, validation/cases/, cases/examples/, as in the source tree
};

/// The installation that a program belongs to: the nearest folder above it with share/cutterflow/docs/references.bib.
/// \throws UserError  when there is none, as for a program that was copied elsewhere alone
Installation installation_of(const std::filesystem::path& program);

/// The installation of the running program.
Installation installation();

}  // namespace cutterflow

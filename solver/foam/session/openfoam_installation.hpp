#pragma once
/// \file The OpenFOAM installation that a program works with.

namespace cutterflow::foam {

/// A program that calls this finds OpenFOAM's own files (etc/controlDict ...) without an environment: where WM_PROJECT_DIR is not set, the
/// program starts itself anew with the installation that it was built for, before any of OpenFOAM's libraries is initialised.
/// \throws UserError  when libraries, WM_PROJECT_VERSION or WM_PROJECT_DIR are of another version than the one it was built for
void require_openfoam_of_build();

}  // namespace cutterflow::foam

#pragma once
/// \file constant/couplingProperties as plain settings.
#include <optional>

#include "solver/ports/dem_settings.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::foam {

class FoamSession;

/// The case's settings of rock. Paths are absolute.
struct CouplingDictionary {
    coupling::CouplingSettings coupling;
    std::optional<coupling::DemSettings> dem;  ///< with rock; without a log
};

/// Reads constant/couplingProperties (docs/design/001-contracts.md lists its keys) and, with rock, constant/g and rho and nu of
/// constant/transportProperties. A case without the file is a pure flow. Collective.
/// \throws UserError  with every mistake of the file: unknown key (with the nearest known one), wrong type, missing
CouplingDictionary read_coupling_dictionary(FoamSession& session);

}  // namespace cutterflow::foam

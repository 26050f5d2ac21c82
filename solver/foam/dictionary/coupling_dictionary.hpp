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

/// Reads constant/couplingProperties and, with rock, constant/g and (but for medium none) rho and nu of constant/transportProperties. A
/// case without the file is a pure flow. What sets the time step in system/controlDict is checked too. Collective. Every section and key,
/// with default, unit and bounds: docs/user/your_own_case.md.
///
/// Usage
/// \verbatim
/// medium     fluid;                                            // or none: rock moves by weight and contacts alone
/// patches { outlet top; steel (blades floor); }               // optional
/// soil { surface "constant/triSurface/bank.stl"; permeability 0; }                       // optional
/// rock                                                        // optional
/// {
///     feed     "constant/rockFeed.csv";
///     contact  { youngsModulus 1e8; maxSpeed 1; }             // optional: pairs { rock_steel { friction 0.3; } } ...
///     walls    ( { name a; file "constant/a.stl"; rotating false; } );                    // optional
///     domain   { type box; lower (0 0 0); upper (1 1 1); walls (zMin); }
///     // domain { type cylinder; axisPoint (0 0 0); radius 1; zMin 0; zMax 1; walls (zMin zMax); }
/// }
/// kernel     { map gaussian; sampling gaussian; gamma 1; minWidthInCells 1.5; maxSolidFraction 0.7; }  // optional
/// closures   { drag brown_lawler; hindrance di_felice; addedMass 0.5; lift none; }        // optional
/// fates      { contour "constant/contour.csv"; ringRadius 0.4; zBackplate 0.03; binWidth 0.03; mouth { ... } }   // optional
/// outflow    { offset 0.015; startTime 1; }                   // optional, needs fates
/// velocity   { startTime 1; sets ( { name a; file "constant/a.csv"; } ); }                // optional, needs a turning zone
/// stop       { undecided 0.05; }                              // optional; needs fates, but for atRest, idle and below
/// checkpoint { interval 0.25; keep 2; }                       // optional
/// record     { startTime 1; endTime 2; blades 6; }            // optional, needs a turning zone
/// replay     { recording "../flow/recording"; }               // optional, needs rock; the flow is then not solved
/// \endverbatim
/// \throws UserError  with every mistake of the file: unknown key (with the nearest known one), wrong type, missing, out of bounds, or that
/// it is no dictionary
/// \throws CaseFileError  where OpenFOAM cannot read a file
CouplingDictionary read_coupling_dictionary(FoamSession& session);

}  // namespace cutterflow::foam

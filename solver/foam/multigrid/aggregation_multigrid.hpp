#pragma once
/// \file A preconditioner for the pressure: multigrid of clusters of cells, kept for the whole run.
///
/// In fvSolution, for symmetric matrices:
///
///     preconditioner  aggregationMultigrid;
///
/// One W-cycle over clusters of some eight cells, clusters of some eight clusters and so on: a Gauss-Seidel sweep in the order of the
/// cells from zero, the correction by the next level gone through twice, a sweep against that order. Where cells meet across a coupled
/// patch, of another rank or of a sliding interface, either sweep takes the values before it. The last level, some hundred clusters of all
/// ranks, is solved exactly. Both sweeps are each other's transpose, so that conjugate gradients may use it. Levels are in single
/// precision.
///
/// Clusters come from the mesh (area over distance of the faces) and are the same for a resumed run; their matrices are those of each
/// solution (Galerkin). Source of the method: Braess1995.
#include <string>
#include <vector>

#include "dictionary.H"

namespace cutterflow::foam {

/// A linear solver's section of fvSolution as cutterFoam takes it: with the value of cutterFoamPreconditioner, if there is one, in place of
/// `preconditioner`, which is for programs that know OpenFOAM's alone.
Foam::dictionary own_linear_solver(const Foam::dictionary& section);

}  // namespace cutterflow::foam

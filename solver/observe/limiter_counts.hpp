#pragma once
/// \file How often the coupling of rock and fluid fell back on a bound.

namespace cutterflow::coupling {

/// Of one step, over the whole mesh.
struct LimiterCounts {
    int swept_cells = 0;    ///< beside walls that sweep more rock than may be taken from one cell: the rest is laid over the rock's kernel
    int wake_rocks = 0;     ///< whose own wake is larger than what is taken out of the slip at most (physics::k_largest_wake)
    int hidden_rocks = 0;   ///< that saw no cell of water and were mapped from the nearest cell's centre
    int cramped_rocks = 0;  ///< that saw too few cells to lie in and were laid over cells behind steel, or in soil, as well
};

}  // namespace cutterflow::coupling

#pragma once
/// \file Tasks that do not need each other, such as runs of programs.
#include <cstddef>
#include <functional>

namespace cutterflow {

/// Calls task(0) to task(count - 1), each once, at most `jobs` and k_most_children at a time.
/// \throws what the first one that failed threw, once those that had begun have ended; no further one is begun
/// \throws Interrupted  the same way, when the user stops the program, also between the programs that a task runs
void side_by_side(std::size_t count, int jobs, const std::function<void(std::size_t)>& task);

}  // namespace cutterflow

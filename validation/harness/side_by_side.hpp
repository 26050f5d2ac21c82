#pragma once
/// \file Runs of a case that do not need each other.
#include <cstddef>
#include <functional>

namespace cutterflow::validation {

/// Calls task(0) to task(count - 1), each once, as many at a time as there are cores: for tasks that wait for a program of one rank.
/// \throws what the first one that failed threw, once those that had begun have ended; no further one is begun
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace cutterflow::validation

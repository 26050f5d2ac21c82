#pragma once
/// \file Tasks that do not need each other, such as runs of programs.
#include <cstddef>
#include <functional>

namespace cutterflow {

/// Calls task(0) to task(count - 1), each once, at most `jobs` at a time.
/// \throws what the first one that failed threw, once those that had begun have ended; no further one is begun
void side_by_side(std::size_t count, int jobs, const std::function<void(std::size_t)>& task);

}  // namespace cutterflow

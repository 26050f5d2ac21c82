#include "validation/fuzz/kinds.hpp"

#include "validation/fuzz/run_kinds.hpp"
#include "validation/fuzz/scene_kinds.hpp"
#include "validation/fuzz/surface_kinds.hpp"

namespace cutterflow::validation {

std::vector<FuzzKind> fuzz_kinds() {
    std::vector<FuzzKind> kinds = surface_kinds();
    for (FuzzKind& kind : run_kinds()) kinds.push_back(std::move(kind));
    for (FuzzKind& kind : scene_kinds()) kinds.push_back(std::move(kind));
    return kinds;
}

}  // namespace cutterflow::validation

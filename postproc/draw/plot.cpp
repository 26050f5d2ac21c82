#include "postproc/draw/plot.hpp"

namespace cutterflow::postproc {

bool is_named(const Series& series) {
    return !series.name.empty() || !series.point_names.empty();
}

}  // namespace cutterflow::postproc

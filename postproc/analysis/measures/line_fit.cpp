#include "postproc/analysis/measures/line_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cutterflow::postproc {

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n, mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
        yy += (y[i] - mean_y) * (y[i] - mean_y);
    }
    const double slope = xy / xx;
    return {slope, mean_y - slope * mean_x, yy > 0.0 ? slope * xy / yy : 0.0, std::sqrt(std::max(0.0, yy - slope * xy) / n), x.size()};
}

}  // namespace cutterflow::postproc

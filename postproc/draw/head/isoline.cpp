#include "postproc/draw/head/isoline.hpp"

#include <array>
#include <limits>

namespace cutterflow::postproc {

namespace {

struct Corner {
    double x, y, value;
};

/// Where the level crosses the edges of a triangle: two places or none.
void add_crossing(const std::array<Corner, 3>& corners, double level, Isoline& line) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i < 3; ++i) {
        const Corner &a = corners[i], &b = corners[(i + 1) % 3];
        if ((a.value < level) == (b.value < level)) continue;
        const double share = (level - a.value) / (b.value - a.value);
        x.push_back(a.x + share * (b.x - a.x));
        y.push_back(a.y + share * (b.y - a.y));
    }
    if (x.size() != 2) return;
    constexpr double gap = std::numeric_limits<double>::quiet_NaN();
    line.x.insert(line.x.end(), {x[0], x[1], gap});
    line.y.insert(line.y.end(), {y[0], y[1], gap});
}

}  // namespace

Isoline isoline(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& value, double level) {
    Isoline line;
    for (std::size_t j = 0; j + 1 < y.size(); ++j)
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
            const auto corner = [&](std::size_t a, std::size_t b) { return Corner{x[a], y[b], value[a + b * x.size()]}; };
            add_crossing({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)}, level, line);
            add_crossing({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)}, level, line);
        }
    return line;
}

}  // namespace cutterflow::postproc

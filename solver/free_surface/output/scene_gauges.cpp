#include "solver/free_surface/output/scene_gauges.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::free_surface {

namespace {

/// Height [m] of the surface in a column, from cell `lowest` up.
double column_level(const SurfaceRun& run, int i, int j, int lowest) {
    const StaggeredGrid& grid = run.grid();
    const WaterFraction& water = run.water();
    double level = lowest * grid.spacing();
    int below = -1;
    for (int k = lowest; k < grid.cells(2); ++k) {
        const int cell = grid.at(i, j, k);
        if (water.kind[cell] == CellKind::closed) continue;
        if (water.kind[cell] == CellKind::air) {
            if (below >= 0 && below == cell - grid.stride(2))
                level += grid.spacing() * (surface_distance(water.fraction[below], water.fraction[cell]) - 0.5);
            return level;
        }
        level = (k + 1) * grid.spacing();
        below = cell;
    }
    return level;
}

/// Volume flow [m3/s] through a face that has water on one of its sides.
double flow(const SurfaceRun& run, int d, int face) {
    const auto is_water = [&](int cell) { return run.water().kind[cell] == CellKind::water; };
    if (!is_water(face) && !is_water(face - run.grid().stride(d))) return 0.0;
    return run.cells().open[d][face] * run.velocity()[d][face] * run.grid().face_area();
}

void read_pipe(const SurfaceRun& run, const PipeGauge& pipe, SceneReading& reading) {
    const StaggeredGrid& grid = run.grid();
    const double h = grid.spacing();
    const auto plane = [&](double place) { return static_cast<int>(std::lround(place / h)); };
    const int bottom = plane(pipe.bottom), top = std::min(plane(pipe.top), grid.cells(2));  // it may reach out of the tank
    const int left = plane(pipe.axis - 0.5 * pipe.inner_width), right = plane(pipe.axis + 0.5 * pipe.inner_width);
    int inside = 0;
    for (int j = 0; j < grid.cells(1); ++j) {
        for (int i = left; i < right; ++i, ++inside) {
            reading.mouth_flow += flow(run, 2, grid.at(i, j, bottom));
            reading.level_in_pipe += column_level(run, i, j, bottom);
        }
        for (int k = bottom; k < top; ++k) reading.hole_flow += flow(run, 0, grid.at(left, j, k)) - flow(run, 0, grid.at(right, j, k));
    }
    reading.level_in_pipe /= std::max(1, inside);
    const WaterParticles& water = run.particles();
    for (std::size_t p = 0; p < water.size(); ++p) {
        const double z = water.position[2][p];
        if (pipe.is_inside(water.position[0][p]) && z > pipe.bottom && z < pipe.top) reading.volume_in_pipe += water.volume;
    }
}

void read_bodies(const SurfaceRun& run, const std::optional<PipeGauge>& pipe, SceneReading& reading) {
    const double count = static_cast<double>(run.bodies().size());
    for (const Body& body : run.bodies()) {
        reading.mean_place += body.position / count;
        reading.farthest = std::max(reading.farthest, body.position.x() + body.radius);
        if (pipe && body.position.z() <= pipe->bottom) continue;
        ++reading.bodies_in_pipe;
        reading.rise_in_pipe += body.velocity.z();
    }
    if (reading.bodies_in_pipe > 0) reading.rise_in_pipe /= reading.bodies_in_pipe;
}

}  // namespace

GaugeReading read_gauge(const SurfaceRun& run, const Gauge& gauge) {
    const StaggeredGrid& grid = run.grid();
    const auto clamped = [&](int n, int d) { return std::clamp(n, 0, grid.cells(d) - 1); };
    const double h = grid.spacing();
    GaugeReading reading;
    const auto cell_at = [&](double place, int d) { return clamped(static_cast<int>(std::floor(place / h)), d); };
    const int across = grid.is_plane() ? 0 : cell_at(gauge.y, 1);
    reading.level = column_level(run, cell_at(gauge.x, 0), across, 0);
    if (!gauge.z) return reading;
    const Vec3 s = Vec3(gauge.x, gauge.y, *gauge.z) / h - Vec3::Constant(0.5);
    const std::array<int, 3> low{static_cast<int>(std::floor(s.x())), grid.is_plane() ? 0 : static_cast<int>(std::floor(s.y())),
                                 static_cast<int>(std::floor(s.z()))};
    double sum = 0.0, weights = 0.0;
    for (const int a : {0, 1}) {
        for (const int b : {0, 1}) {
            if (grid.is_plane() && b == 1) continue;
            for (const int c : {0, 1}) {
                const int cell = grid.at(clamped(low[0] + a, 0), clamped(low[1] + b, 1), clamped(low[2] + c, 2));
                if (run.cells().closed[cell]) continue;
                const double wide = grid.is_plane() ? 1.0 : 1.0 - std::abs(s.y() - low[1] - b);
                const double weight = (1.0 - std::abs(s.x() - low[0] - a)) * wide * (1.0 - std::abs(s.z() - low[2] - c));
                sum += weight * run.pressure()[cell];
                weights += weight;
            }
        }
    }
    if (weights > 0.0) reading.pressure = sum / weights;
    return reading;
}

SceneReading read_gauges(const SurfaceRun& run, const std::optional<PipeGauge>& pipe) {
    SceneReading reading;
    const StaggeredGrid& grid = run.grid();
    int columns = 0;
    for (int i = 0; i < grid.cells(0); ++i) {
        if (pipe && !pipe->is_outside((i + 0.5) * grid.spacing())) continue;
        for (int j = 0; j < grid.cells(1); ++j, ++columns) reading.level += column_level(run, i, j, 0);
    }
    reading.level /= std::max(1, columns);
    if (pipe) read_pipe(run, *pipe, reading);
    read_bodies(run, pipe, reading);
    return reading;
}

}  // namespace cutterflow::free_surface

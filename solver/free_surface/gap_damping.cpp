#include "solver/free_surface/gap_damping.hpp"

#include <algorithm>
#include <cmath>

#include "solver/free_surface/cell_lists.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_band_cells = 2.0;

struct GapContact {
    Vec3 point, normal, velocity;
};

/// Of a body and something else that moves as a whole.
void add_contact(const Body& body, const Vec3& point, const Vec3& velocity, double gap, std::vector<GapContact>& contacts) {
    const Vec3 way = point - body.position;
    const double distance = way.norm();
    if (distance == 0.0 || distance - body.radius >= gap) return;
    contacts.push_back({point, way / distance, 0.5 * (velocity_at(body, point) + velocity)});
}

std::vector<GapContact> contacts_of(const StaggeredGrid& grid, const GapSolids& solids, double gap) {
    const auto& bodies = solids.bodies;
    std::vector<GapContact> contacts;
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = a + 1; b < bodies.size(); ++b) {
            const Vec3 way = bodies[b].position - bodies[a].position;
            const double between = way.norm() - bodies[a].radius - bodies[b].radius;
            if (between >= gap) continue;
            const Vec3 normal = way.normalized();
            const Vec3 point = bodies[a].position + (bodies[a].radius + 0.5 * between) * normal;
            contacts.push_back({point, normal, 0.5 * (velocity_at(bodies[a], point) + velocity_at(bodies[b], point))});
        }
        for (const int d : grid.directions()) {
            if (d == 1 && !bodies[a].sphere) continue;  // a cylinder reaches to both walls
            for (const double wall : {0.0, grid.extent(d)}) {
                Vec3 point = bodies[a].position;
                point[d] = wall;
                add_contact(bodies[a], point, Vec3::Zero(), gap, contacts);
            }
        }
        for (const StillSolid& solid : solids.still)
            add_contact(bodies[a], nearest_on(solid, bodies[a].position), Vec3::Zero(), gap, contacts);
        for (std::size_t n = 0; n < solids.gates.size(); ++n)
            add_contact(bodies[a], nearest_on(solids.gates[n], bodies[a].position), Vec3(0, 0, solids.lift[n]), gap, contacts);
    }
    return contacts;
}

/// For each cell the contacts whose band may reach into it. \param spheres  else contacts are lines across the tank
CellLists contacts_by_cell(const StaggeredGrid& grid, const std::vector<GapContact>& contacts, double reach, bool spheres) {
    CellLists lists;
    lists.clear(grid.size());
    for (std::size_t n = 0; n < contacts.size(); ++n) {
        std::array<int, 3> from{0, 0, 0}, to{0, grid.cells(1) - 1, 0};
        for (const int d : grid.directions()) {
            if (d == 1 && !spheres) continue;
            const double place = contacts[n].point[d] / grid.spacing(), cells = reach / grid.spacing();
            from[d] = std::clamp(static_cast<int>(std::floor(place - cells)), 0, grid.cells(d) - 1);
            to[d] = std::clamp(static_cast<int>(std::floor(place + cells)), 0, grid.cells(d) - 1);
        }
        for (int k = from[2]; k <= to[2]; ++k) {
            for (int j = from[1]; j <= to[1]; ++j) {
                for (int i = from[0]; i <= to[0]; ++i) lists.add(grid.at(i, j, k), static_cast<int>(n));
            }
        }
    }
    return lists;
}

}  // namespace

double damp_gaps(const GapDampingSettings& settings, const StaggeredGrid& grid, const GapSolids& solids, double step, double density,
                 WaterParticles& particles) {
    const double band = k_band_cells * grid.spacing(), half_gap = 0.5 * (settings.gap + grid.spacing());
    const double mass = density * particles.volume, exponent = step / settings.time;
    const std::vector<GapContact> contacts = contacts_of(grid, solids, settings.gap);
    const bool spheres = !solids.bodies.empty() && solids.bodies[0].sphere;  // bodies of a scene have one shape
    const CellLists nearby = contacts_by_cell(grid, contacts, std::hypot(band, half_gap), spheres);
    double taken = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 place = particles.place(p);
        nearby.for_each(cell_of(grid, place), [&](int n) {
            const GapContact& contact = contacts[n];
            Vec3 arm = place - contact.point;
            if (!spheres) arm.y() = 0.0;
            const double across = arm.dot(contact.normal);
            const double along = (arm - across * contact.normal).norm();
            if (std::abs(across) > half_gap || along >= band) return;
            const double share = settings.remaining + (1.0 - settings.remaining) * along / band;
            const double kept = share > 0.0 ? std::pow(share, exponent) : 0.0;
            const Vec3 relative = particles.speed(p) - contact.velocity;
            for (const int d : grid.directions()) particles.velocity[d][p] -= (1.0 - kept) * relative[d];
            taken += mass * (1.0 - kept) * relative.norm();
        });
    }
    return taken;
}

}  // namespace cutterflow::free_surface

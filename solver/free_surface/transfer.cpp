#include "solver/free_surface/transfer.hpp"

#include <algorithm>

#include "solver/free_surface/kernel.hpp"
#include "solver/free_surface/mirror.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_wall_distance = 1e-6;  // of a cell

/// Kernel of a point for the nodes of all fields: on faces and in centres of each direction.
struct PointKernel {
    std::array<KernelWeights, 3> face, centre;
};

/// One node that a point sees.
struct NodeBlock {
    int first = 0;              ///< index of the lowest node
    const double* weight[3]{};  ///< of the nodes in x, y, z
    int across = 3;             ///< nodes in y
};

class Kernels {
public:
    explicit Kernels(const StaggeredGrid& grid, const SlipWalls* walls = nullptr)
        : grid_(grid), walls_(walls && !walls->empty() ? walls : nullptr), inverse_(1.0 / grid.spacing()) {
        for (int d = 0; d < 3; ++d) largest_[d] = grid.cells(d) - k_wall_distance;
    }

    /// \param place  [m]
    void set(const Vec3& place, PointKernel& kernel) const {
        for (const int d : grid_.directions()) {
            const double s = place[d] * inverse_;
            kernel.face[d] = quadratic_weights(s);
            kernel.centre[d] = quadratic_weights(s - 0.5);
        }
    }

    /// Nodes of the faces of a direction; 3: of cell centres.
    NodeBlock nodes(const PointKernel& kernel, int direction) const {
        const auto along = [&](int d) -> const KernelWeights& { return d == direction ? kernel.face[d] : kernel.centre[d]; };
        if (grid_.is_plane()) {
            const KernelWeights &x = along(0), &z = along(2);
            return {grid_.at(x.first, 0, z.first), {x.weight.data(), &k_one, z.weight.data()}, 1};
        }
        const KernelWeights &x = along(0), &y = along(1), &z = along(2);
        return {grid_.at(x.first, y.first, z.first), {x.weight.data(), y.weight.data(), z.weight.data()}, 3};
    }

    double gather(const NodeBlock& block, const std::vector<double>& field) const {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < block.across; ++j) {
                const double* row = field.data() + block.first + j * grid_.stride(1) + k * grid_.stride(2);
                sum += block.weight[2][k] * block.weight[1][j] *
                       (block.weight[0][0] * row[0] + block.weight[0][1] * row[1] + block.weight[0][2] * row[2]);
            }
        }
        return sum;
    }

    void scatter(const NodeBlock& block, std::vector<double>& share, std::vector<double>& momentum, double velocity) const {
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < block.across; ++j) {
                const int row = block.first + j * grid_.stride(1) + k * grid_.stride(2);
                const double weight = block.weight[2][k] * block.weight[1][j];
                for (int i = 0; i < 3; ++i) {
                    const double w = weight * block.weight[0][i];
                    share[row + i] += w;
                    momentum[row + i] += w * velocity;
                }
            }
        }
    }

    void scatter(const NodeBlock& block, std::vector<double>& share) const {
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < block.across; ++j) {
                const int row = block.first + j * grid_.stride(1) + k * grid_.stride(2);
                const double weight = block.weight[2][k] * block.weight[1][j];
                for (int i = 0; i < 3; ++i) share[row + i] += weight * block.weight[0][i];
            }
        }
    }

    Vec3 gather(const Vec3& place, const FaceField& field) const {
        PointKernel kernel;
        set(place, kernel);
        return gather(kernel, field);
    }

    Vec3 gather(const PointKernel& kernel, const FaceField& field) const {
        Vec3 value = Vec3::Zero();
        if (walls_ && walls_->near[nodes(kernel, 3).first + middle(3)]) {
            for (const int d : grid_.directions()) value[d] = gather_beside_walls(nodes(kernel, d), d, field[d]);
        } else {
            for (const int d : grid_.directions()) value[d] = gather(nodes(kernel, d), field[d]);
        }
        return value;
    }

    void keep_inside(Vec3& place) const {
        for (const int d : grid_.directions()) {
            place[d] = std::clamp(place[d], k_wall_distance * grid_.spacing(), largest_[d] * grid_.spacing());
        }
    }

private:
    static constexpr double k_one = 1.0;

    /// From the lowest node of a block to the middle one in all directions but `along` (3: in all).
    int middle(int along) const {
        int way = 0;
        for (const int d : grid_.directions()) way += d == along ? 0 : grid_.stride(d);
        return way;
    }

    double gather_beside_walls(const NodeBlock& block, int direction, const std::vector<double>& field) const {
        const std::vector<std::uint8_t>& closed = walls_->closed[direction];
        const int own_row = block.first + middle(direction);
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < block.across; ++j) {
                for (int i = 0; i < 3; ++i) {
                    const int node = block.first + i + j * grid_.stride(1) + k * grid_.stride(2);
                    const int place[3] = {i, j, k};
                    const int own = own_row + place[direction] * grid_.stride(direction);
                    sum += block.weight[2][k] * block.weight[1][j] * block.weight[0][i] * field[closed[node] ? own : node];
                }
            }
        }
        return sum;
    }

    const StaggeredGrid& grid_;
    const SlipWalls* walls_;
    double inverse_;
    std::array<double, 3> largest_{};
};

/// The faces on the tank's two walls normal to d: of the first cell and of the ghost after the last.
template <typename Visit>
void for_each_wall_face(const StaggeredGrid& grid, int d, const Visit& visit) {
    for_each_mirror(grid, d, false, [&](int inside, int ghost) { visit(std::max(inside, ghost)); });
}

}  // namespace

void map_to_grid(const StaggeredGrid& grid, const WaterParticles& particles, MappedWater& mapped) {
    const Kernels kernels(grid);
    const auto directions = grid.directions();
    for (const int d : directions) {
        std::fill(mapped.velocity[d].begin(), mapped.velocity[d].end(), 0.0);
        std::fill(mapped.share[d].begin(), mapped.share[d].end(), 0.0);
    }
    std::fill(mapped.fraction.begin(), mapped.fraction.end(), 0.0);
    PointKernel kernel;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        kernels.set(particles.place(p), kernel);
        for (const int d : directions)
            kernels.scatter(kernels.nodes(kernel, d), mapped.share[d], mapped.velocity[d], particles.velocity[d][p]);
        kernels.scatter(kernels.nodes(kernel, 3), mapped.fraction);
    }
    const double volume = particles.volume / grid.cell_volume();
    for (const int d : directions) {
        fold(grid, d, 1.0, mapped.share[d]);
        fold(grid, d, -1.0, mapped.velocity[d]);
        for_each_wall_face(grid, d, [&](int face) { mapped.velocity[d][face] = 0.0; });
        for (std::size_t f = 0; f < grid.size(); ++f) {
            if (mapped.share[d][f] <= 0.0) continue;
            mapped.velocity[d][f] /= mapped.share[d][f];
            mapped.share[d][f] *= volume;
        }
    }
    fold(grid, k_centres, 1.0, mapped.fraction);
    for (double& fraction : mapped.fraction) fraction *= volume;
}

void map_fraction(const StaggeredGrid& grid, const WaterParticles& particles, CellField& fraction) {
    const Kernels kernels(grid);
    fraction.assign(grid.size(), 0.0);
    PointKernel kernel;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        kernels.set(particles.place(p), kernel);
        kernels.scatter(kernels.nodes(kernel, 3), fraction);
    }
    fold(grid, k_centres, 1.0, fraction);
    const double volume = particles.volume / grid.cell_volume();
    for (double& share : fraction) share *= volume;
}

void mirror_faces(const StaggeredGrid& grid, FaceField& field) {
    for (const int d : grid.directions()) {
        for (const int e : grid.directions()) {
            const double sign = e == d ? -1.0 : 1.0;
            for_each_mirror(grid, e, e == d, [&](int inside, int ghost) { field[d][ghost] = sign * field[d][inside]; });
        }
    }
}

void extrapolate(const StaggeredGrid& grid, int layers, std::vector<FaceValue>& values, std::vector<int>& front,
                 std::initializer_list<std::vector<double>*> fields) {
    std::vector<int> next;
    for (int layer = 0; layer < layers; ++layer) {
        next.clear();
        for (const int face : front) {
            for (const int d : grid.directions()) {
                for (const int neighbour : {face - grid.stride(d), face + grid.stride(d)}) {
                    if (values[neighbour] != FaceValue::none) continue;
                    values[neighbour] = FaceValue::found;
                    next.push_back(neighbour);
                }
            }
        }
        for (const int face : next) {
            std::array<int, 6> sources{};
            int count = 0;
            for (const int d : grid.directions()) {
                for (const int neighbour : {face - grid.stride(d), face + grid.stride(d)}) {
                    if (values[neighbour] == FaceValue::present) sources[count++] = neighbour;
                }
            }
            for (std::vector<double>* field : fields) {
                double sum = 0.0;
                for (int n = 0; n < count; ++n) sum += (*field)[sources[n]];
                (*field)[face] = sum / count;
            }
        }
        for (const int face : next) values[face] = FaceValue::present;
        front.swap(next);
    }
}

void move_particles(const StaggeredGrid& grid, const SlipWalls& walls, const WaterMotion& motion, WaterParticles& particles) {
    const Kernels kernels(grid, &walls);
    PointKernel kernel;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 start = particles.place(p);
        kernels.set(start, kernel);
        const Vec3 increment = kernels.gather(kernel, motion.increment);
        const Vec3 first = kernels.gather(kernel, motion.velocity);
        Vec3 place = start + 0.5 * motion.step * first;
        kernels.keep_inside(place);
        const Vec3 second = kernels.gather(place, motion.velocity);
        place = start + 0.75 * motion.step * second;
        kernels.keep_inside(place);
        const Vec3 third = kernels.gather(place, motion.velocity);
        place = start + motion.step / 9.0 * (2.0 * first + 3.0 * second + 4.0 * third);
        kernels.keep_inside(place);
        for (const int d : grid.directions()) {
            particles.velocity[d][p] = motion.kept * (particles.velocity[d][p] + increment[d]) + (1.0 - motion.kept) * first[d];
            particles.position[d][p] = place[d];
        }
    }
}

void displace_particles(const StaggeredGrid& grid, const SlipWalls& walls, const FaceField& displacement, double largest,
                        WaterParticles& particles) {
    const Kernels kernels(grid, &walls);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        Vec3 place = particles.place(p);
        const Vec3 way = kernels.gather(place, displacement);
        for (const int d : grid.directions()) place[d] += std::clamp(way[d], -largest, largest);
        kernels.keep_inside(place);
        for (const int d : grid.directions()) particles.position[d][p] = place[d];
    }
}

Vec3 value_at(const StaggeredGrid& grid, const SlipWalls& walls, const FaceField& field, const Vec3& place) {
    return Kernels(grid, &walls).gather(place, field);
}

void keep_in_tank(const StaggeredGrid& grid, Vec3& place) {
    Kernels(grid).keep_inside(place);
}

}  // namespace cutterflow::free_surface

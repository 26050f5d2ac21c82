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

/// Nodes that a point sees of one field.
struct NodeBlock {
    int first;                              ///< index of the lowest node
    const std::array<double, 3>&x, &y, &z;  ///< weights
};

/// Kernels of points in a plane scene or in space: the directions and the number of nodes across are known to the compiler.
template <bool plane>
class Kernels {
public:
    static constexpr int k_across = plane ? 1 : 3;  ///< nodes in y

    explicit Kernels(const StaggeredGrid& grid, const SlipWalls* walls = nullptr)
        : grid_(grid), walls_(walls && !walls->empty() ? walls : nullptr), inverse_(1.0 / grid.spacing()) {
        for (int d = 0; d < 3; ++d) largest_[d] = (grid.cells(d) - k_wall_distance) * grid.spacing();
    }

    template <typename Visit>
    static void for_each_direction(const Visit& visit) {
        visit(0);
        if constexpr (!plane) visit(1);
        visit(2);
    }

    /// \param place  [m]
    PointKernel at(const Vec3& place) const {
        PointKernel kernel;
        for_each_direction([&](int d) {
            const double s = place[d] * inverse_;
            kernel.face[d] = quadratic_weights(s);
            kernel.centre[d] = quadratic_weights(s - 0.5);
        });
        return kernel;
    }

    /// Nodes of the faces of a direction, or k_centres.
    NodeBlock nodes(const PointKernel& kernel, int direction) const {
        static constexpr KernelWeights whole{0, {1.0, 0.0, 0.0}};
        const auto along = [&](int d) -> const KernelWeights& { return d == direction ? kernel.face[d] : kernel.centre[d]; };
        const KernelWeights &x = along(0), &y = plane ? whole : along(1), &z = along(2);
        return {grid_.at(x.first, y.first, z.first), x.weight, y.weight, z.weight};
    }

    double gather(const NodeBlock& block, const std::vector<double>& field) const {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < k_across; ++j) {
                const double* row = field.data() + block.first + j * grid_.stride(1) + k * grid_.stride(2);
                sum += block.z[k] * block.y[j] * (block.x[0] * row[0] + block.x[1] * row[1] + block.x[2] * row[2]);
            }
        }
        return sum;
    }

    /// Calls visit(node, weight) for every node.
    template <typename Visit>
    void for_each_node(const NodeBlock& block, const Visit& visit) const {
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < k_across; ++j) {
                const int row = block.first + j * grid_.stride(1) + k * grid_.stride(2);
                const double weight = block.z[k] * block.y[j];
                for (int i = 0; i < 3; ++i) visit(row + i, weight * block.x[i]);
            }
        }
    }

    Vec3 gather(const Vec3& place, const FaceField& field) const { return gather(at(place), field); }

    Vec3 gather(const PointKernel& kernel, const FaceField& field) const {
        Vec3 value = Vec3::Zero();
        const bool beside_walls = is_beside_walls(kernel);
        for_each_direction([&](int d) {
            if (beside_walls) {
                for_each_face_beside_walls(nodes(kernel, d), d, [&](int face, double weight) { value[d] += weight * field[d][face]; });
            } else {
                value[d] = gather(nodes(kernel, d), field[d]);
            }
        });
        return value;
    }

    /// Whether closed faces of still solids are among the faces that a point sees.
    bool is_beside_walls(const PointKernel& kernel) const {
        return walls_ && walls_->near[nodes(kernel, k_centres).first + middle(k_centres)];
    }

    /// Calls visit(face, weight) for what a point beside walls sees of the faces of a direction (SlipWalls).
    template <typename Visit>
    void for_each_face_beside_walls(const NodeBlock& block, int direction, const Visit& visit) const {
        const std::vector<std::uint8_t>& closed = walls_->closed[direction];
        const int own_row = block.first + middle(direction);
        for (int k = 0; k < 3; ++k) {
            for (int j = 0; j < k_across; ++j) {
                for (int i = 0; i < 3; ++i) {
                    const int node = block.first + i + j * grid_.stride(1) + k * grid_.stride(2);
                    const int place[3] = {i, j, k};
                    const int own = own_row + place[direction] * grid_.stride(direction);
                    visit(closed[node] ? own : node, block.z[k] * block.y[j] * block.x[i]);
                }
            }
        }
    }

    /// A place that is no number becomes one at a wall, for it is an index of cells.
    Vec3 kept_inside(Vec3 place) const {
        for_each_direction([&](int d) { place[d] = std::max(k_wall_distance * grid_.spacing(), std::min(largest_[d], place[d])); });
        return place;
    }

private:
    /// From the lowest node of a block to the middle one in all directions but `along` (k_centres: in all).
    int middle(int along) const {
        int way = 0;
        for_each_direction([&](int d) { way += d == along ? 0 : grid_.stride(d); });
        return way;
    }

    const StaggeredGrid& grid_;
    const SlipWalls* walls_;
    double inverse_;
    std::array<double, 3> largest_{};
};

/// Calls work(kernels) with the kernels of the grid's kind.
template <typename Work>
void with_kernels(const StaggeredGrid& grid, const SlipWalls* walls, const Work& work) {
    if (grid.is_plane()) {
        work(Kernels<true>(grid, walls));
    } else {
        work(Kernels<false>(grid, walls));
    }
}

/// The faces on the tank's two walls normal to d: of the first cell and of the ghost after the last.
template <typename Visit>
void for_each_wall_face(const StaggeredGrid& grid, int d, const Visit& visit) {
    for_each_mirror(grid, d, false, [&](int inside, int ghost) { visit(std::max(inside, ghost)); });
}

}  // namespace

void map_to_grid(const StaggeredGrid& grid, const SlipWalls& walls, const WaterParticles& particles, MappedWater& mapped) {
    const auto directions = grid.directions();
    for (const int d : directions) {
        std::fill(mapped.velocity[d].begin(), mapped.velocity[d].end(), 0.0);
        std::fill(mapped.share[d].begin(), mapped.share[d].end(), 0.0);
    }
    std::fill(mapped.fraction.begin(), mapped.fraction.end(), 0.0);
    with_kernels(grid, &walls, [&](const auto& kernels) {
        for (std::size_t p = 0; p < particles.size(); ++p) {
            const PointKernel kernel = kernels.at(particles.place(p));
            const bool beside_walls = kernels.is_beside_walls(kernel);
            kernels.for_each_direction([&](int d) {
                double *share = mapped.share[d].data(), *momentum = mapped.velocity[d].data();
                const double velocity = particles.velocity[d][p];
                const auto give = [&](int face, double weight) {
                    share[face] += weight;
                    momentum[face] += weight * velocity;
                };
                if (beside_walls) {
                    kernels.for_each_face_beside_walls(kernels.nodes(kernel, d), d, give);
                } else {
                    kernels.for_each_node(kernels.nodes(kernel, d), give);
                }
            });
            kernels.for_each_node(kernels.nodes(kernel, k_centres), [&](int node, double weight) { mapped.fraction[node] += weight; });
        }
    });
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
    fraction.assign(grid.size(), 0.0);
    with_kernels(grid, nullptr, [&](const auto& kernels) {
        for (std::size_t p = 0; p < particles.size(); ++p) {
            const PointKernel kernel = kernels.at(particles.place(p));
            kernels.for_each_node(kernels.nodes(kernel, k_centres), [&](int node, double weight) { fraction[node] += weight; });
        }
    });
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
    with_kernels(grid, &walls, [&](const auto& kernels) {
        for (std::size_t p = 0; p < particles.size(); ++p) {
            const Vec3 start = particles.place(p);
            const PointKernel kernel = kernels.at(start);
            const Vec3 increment = kernels.gather(kernel, motion.increment);
            const Vec3 first = kernels.gather(kernel, motion.velocity);
            const Vec3 second = kernels.gather(kernels.kept_inside(start + 0.5 * motion.step * first), motion.velocity);
            const Vec3 third = kernels.gather(kernels.kept_inside(start + 0.75 * motion.step * second), motion.velocity);
            const Vec3 end = kernels.kept_inside(start + motion.step / 9.0 * (2.0 * first + 3.0 * second + 4.0 * third));
            kernels.for_each_direction([&](int d) {
                particles.velocity[d][p] = motion.kept * (particles.velocity[d][p] + increment[d]) + (1.0 - motion.kept) * first[d];
                particles.position[d][p] = end[d];
            });
        }
    });
}

void displace_particles(const StaggeredGrid& grid, const SlipWalls& walls, const FaceField& displacement, double largest,
                        WaterParticles& particles) {
    with_kernels(grid, &walls, [&](const auto& kernels) {
        for (std::size_t p = 0; p < particles.size(); ++p) {
            Vec3 place = particles.place(p);
            const Vec3 way = kernels.gather(place, displacement);
            kernels.for_each_direction([&](int d) { place[d] += std::clamp(way[d], -largest, largest); });
            place = kernels.kept_inside(place);
            kernels.for_each_direction([&](int d) { particles.position[d][p] = place[d]; });
        }
    });
}

Vec3 value_at(const StaggeredGrid& grid, const SlipWalls& walls, const FaceField& field, const Vec3& place) {
    Vec3 value = Vec3::Zero();
    with_kernels(grid, &walls, [&](const auto& kernels) { value = kernels.gather(place, field); });
    return value;
}

void keep_in_tank(const StaggeredGrid& grid, Vec3& place) {
    with_kernels(grid, nullptr, [&](const auto& kernels) { place = kernels.kept_inside(place); });
}

}  // namespace cutterflow::free_surface

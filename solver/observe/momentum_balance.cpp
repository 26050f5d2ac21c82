#include "solver/observe/momentum_balance.hpp"

#include <vector>

#include <Eigen/Core>

#include "geometry/base/sphere.hpp"

namespace cutterflow::coupling {
namespace {

Vec3 momentum_of(const Rocks& rocks) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < rocks.size(); ++p) sum += rocks.density[p] * sphere_volume(rocks.diameter[p]) * rocks.velocity[p];
    return sum;
}

}  // namespace

/// Of this rank's fluid [N s].
Vec3 MomentumBalance::momentum_of_fluid() const {
    const FluidFields fields = fluid_.fields();
    const gsl::span<const double> volumes = fluid_.cells().volumes;
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < volumes.size(); ++c) sum += volumes[c] * fields.void_fraction[c] * fields.velocity[c];
    return properties_.density * sum;
}

/// That this rank's fluid has yet to receive [N s].
Vec3 MomentumBalance::momentum_of_carry(gsl::span<const Vec3> carry) const {
    const gsl::span<const double> volumes = fluid_.cells().volumes;
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < volumes.size(); ++c) sum += volumes[c] * carry[c];
    return properties_.density * sum;
}

void MomentumBalance::begin(gsl::span<const Vec3> carry) {
    rock_before_ = momentum_of(dem_.rocks());
    fluid_before_ = momentum_of_fluid();
    carry_before_ = momentum_of_carry(carry);
}

MomentumErrors MomentumBalance::end(gsl::span<const Vec3> carry, const DemStep& rock, const FluidLoads& loads) {
    Vec3 outside = loads.boundary_impulse + loads.interface_impulse + loads.replaced_momentum + loads.turned_momentum;
    double turnover = 0.0;
    const auto add = [&](const Rocks& rocks, const std::vector<Vec3>& impulse, const std::vector<Vec3>& contact_impulse) {
        for (std::size_t p = 0; p < rocks.size(); ++p) {
            const double submerged_mass = (rocks.density[p] - properties_.density) * sphere_volume(rocks.diameter[p]);
            const Vec3 weight_impulse = submerged_mass * fluid_.time_step() * rock.gravity;
            outside += contact_impulse[p] + weight_impulse;
            turnover += impulse[p].norm() + weight_impulse.norm();
        }
    };
    add(dem_.rocks(), rock.impulse, rock.contact_impulse);
    add(rock.left, rock.left_impulse, rock.left_contact_impulse);

    Eigen::Matrix<double, 6, 1> sums;  // gain of the cells; carry
    const Vec3 carry_after = momentum_of_carry(carry);
    sums << momentum_of_fluid() - fluid_before_ + carry_after - carry_before_, carry_after;
    communicator_.sum(gsl::span<double>(sums.data(), sums.size()));
    if (turnover == 0.0) return {};
    const Vec3 gain = momentum_of(dem_.rocks()) + momentum_of(rock.left) - rock_before_ + sums.head<3>();
    return {(gain - outside).norm() / turnover,      loads.interface_impulse.norm() / turnover, loads.replaced_momentum.norm() / turnover,
            loads.turned_momentum.norm() / turnover, sums.tail<3>().norm() / turnover,          loads.boundary_impulse.norm() / turnover};
}

}  // namespace cutterflow::coupling

#include "solver/liggghts/contact_law.hpp"

#include <cmath>

namespace cutterflow::liggghts {

ElasticPair elastic_pair(double youngs_modulus, double poisson_a, double poisson_b) {
    const auto compliance = [&](double poisson) { return (1.0 - poisson * poisson) / youngs_modulus; };
    const auto shear_compliance = [&](double poisson) { return 2.0 * (2.0 - poisson) * (1.0 + poisson) / youngs_modulus; };
    return {1.0 / (compliance(poisson_a) + compliance(poisson_b)), 1.0 / (shear_compliance(poisson_a) + shear_compliance(poisson_b))};
}

Vec3 contact_force(const Contact& contact, double time_step, Vec3& spring) {
    const double root = std::sqrt(contact.radius * contact.overlap);
    const double normal_stiffness = 4.0 / 3.0 * contact.elastic.youngs * root;
    const double tangential_stiffness = 8.0 * contact.elastic.shear * root;
    const double damping = contact.damping_factor * std::sqrt(contact.mass * normal_stiffness);
    const double normal_force = normal_stiffness * contact.overlap - damping * contact.normal_speed;

    Vec3 stretched = spring + contact.slip_velocity * time_step;
    stretched -= contact.normal * contact.normal.dot(stretched);
    Vec3 tangential = -tangential_stiffness * stretched - damping * contact.slip_velocity;
    const double limit = contact.friction * std::fabs(normal_force);
    const double elastic = tangential_stiffness * stretched.norm();
    if (elastic > limit) {
        stretched *= limit / elastic;
        tangential = -tangential_stiffness * stretched;
    } else if (const double size = tangential.norm(); size > limit) {
        tangential *= limit / size;
    }
    if (time_step > 0.0) spring = stretched;
    return normal_force * contact.normal + tangential;
}

}  // namespace cutterflow::liggghts

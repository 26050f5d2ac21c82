#include "solver/liggghts/contacts/slip_springs.hpp"

#include <cmath>
#include <cstring>

namespace cutterflow::liggghts {

namespace {

/// One number of each spring. Operators work on all of them, and a comparison selects among two by `?:`.
using Lanes = double __attribute__((vector_size(k_springs * sizeof(double))));
static_assert(k_springs == 4, "the lanes below are written for four springs");

/// A vector of each spring.
struct LaneVectors {
    Lanes x, y, z;
};

// Lanes are passed by reference and all is inlined: how vectors are passed by value depends on the processor's instructions.

[[gnu::always_inline]] inline void fill(Lanes& lanes, double value) {
    lanes = Lanes{value, value, value, value};
}

[[gnu::always_inline]] inline void fill(LaneVectors& lanes, const Vec3& value) {
    fill(lanes.x, value.x());
    fill(lanes.y, value.y());
    fill(lanes.z, value.z());
}

[[gnu::always_inline]] inline void load(LaneVectors& lanes, const double (&values)[3][k_springs]) {
    std::memcpy(&lanes.x, values[0], sizeof(Lanes));
    std::memcpy(&lanes.y, values[1], sizeof(Lanes));
    std::memcpy(&lanes.z, values[2], sizeof(Lanes));
}

[[gnu::always_inline]] inline void store(const LaneVectors& lanes, double (&values)[3][k_springs]) {
    std::memcpy(values[0], &lanes.x, sizeof(Lanes));
    std::memcpy(values[1], &lanes.y, sizeof(Lanes));
    std::memcpy(values[2], &lanes.z, sizeof(Lanes));
}

[[gnu::always_inline]] inline void dot(const LaneVectors& a, const LaneVectors& b, Lanes& product) {
    product = a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline void scale(LaneVectors& lanes, const Lanes& factor) {
    lanes.x *= factor;
    lanes.y *= factor;
    lanes.z *= factor;
}

/// Parts of a contact's radius [m] from `inner` to `outer`, one for each spring; without length beyond the contact.
struct Parts {
    Lanes inner, outer, length;
};

[[gnu::always_inline]] inline void cover(double width, double contact_radius, Parts& parts) {
    const Lanes number = {0.0, 1.0, 2.0, 3.0};
    Lanes radius;
    fill(radius, contact_radius);
    parts.inner = number * width;
    parts.inner = parts.inner < radius ? parts.inner : radius;
    parts.outer = (number + 1.0) * width;
    parts.outer = parts.outer < radius ? parts.outer : radius;
    parts.outer[k_springs - 1] = contact_radius;
    parts.length = parts.outer - parts.inner;
}

/// The integral of 3/2 (1 - x^2) over x = inner/a to outer/a. \param per_radius  1/a [1/m]
[[gnu::always_inline]] inline void share_pressure(const Parts& parts, double per_radius, Lanes& share) {
    const Lanes x = parts.inner * per_radius, y = parts.outer * per_radius;
    share = 1.5 * (y - x) - 0.5 * (y * y * y - x * x * x);
}

/// Stretches what was kept by this step's slip, within the plane of contact. Springs beyond the contact have none.
[[gnu::always_inline]] inline void stretch_springs(const Parts& before, const Parts& now, const LaneVectors& normal,
                                                   const LaneVectors& slip_velocity, double time_step, LaneVectors& stretch) {
    Lanes none, one, along;
    fill(none, 0.0);
    fill(one, 1.0);
    Lanes kept = before.length / (now.length > none ? now.length : one);
    kept = kept < one ? kept : one;
    stretch.x = kept * stretch.x + slip_velocity.x * time_step;
    stretch.y = kept * stretch.y + slip_velocity.y * time_step;
    stretch.z = kept * stretch.z + slip_velocity.z * time_step;
    dot(normal, stretch, along);
    stretch.x = now.length > none ? stretch.x - normal.x * along : none;
    stretch.y = now.length > none ? stretch.y - normal.y * along : none;
    stretch.z = now.length > none ? stretch.z - normal.z * along : none;
}

/// Forces [N] of springs and dampers, each at most its limit. What slips carries the limit in the spring alone.
[[gnu::always_inline]] inline void resist(const Lanes& stiffness, const Lanes& damping, const Lanes& limit,
                                          const LaneVectors& slip_velocity, LaneVectors& stretch, LaneVectors& force) {
    const Lanes limit_squared = limit * limit;
    Lanes elastic_squared, squared;
    const LaneVectors elastic = {-stiffness * stretch.x, -stiffness * stretch.y, -stiffness * stretch.z};
    dot(elastic, elastic, elastic_squared);
    const auto slips = elastic_squared > limit_squared;
    force.x = slips ? elastic.x : elastic.x - damping * slip_velocity.x;
    force.y = slips ? elastic.y : elastic.y - damping * slip_velocity.y;
    force.z = slips ? elastic.z : elastic.z - damping * slip_velocity.z;
    dot(force, force, squared);
    const auto exceeds = squared > limit_squared;
    if ((exceeds[0] | exceeds[1] | exceeds[2] | exceeds[3]) == 0) return;
    Lanes one;
    fill(one, 1.0);
    squared = exceeds ? squared : one;
    const Lanes size = {std::sqrt(squared[0]), std::sqrt(squared[1]), std::sqrt(squared[2]), std::sqrt(squared[3])};
    const Lanes share = exceeds ? limit / size : one;
    scale(force, share);
    scale(stretch, slips ? share : one);
}

}  // namespace

// Fused multiplication and addition (FMA) would round otherwise on newer processors than on older ones.
__attribute__((target_clones("avx2", "default"))) void add_slip_force(const SlipSprings& springs, const Vec3& normal,
                                                                      const Vec3& slip_velocity, double time_step, SlipMemory& memory,
                                                                      Vec3& force) {
    Parts before, now;
    cover(springs.width, memory.contact_radius, before);
    cover(springs.width, springs.contact_radius, now);
    LaneVectors stretch, of_each, normals, velocities;
    fill(normals, normal);
    fill(velocities, slip_velocity);
    load(stretch, memory.stretch);
    stretch_springs(before, now, normals, velocities, time_step, stretch);
    const double per_radius = 1.0 / springs.contact_radius;
    Lanes share;
    share_pressure(now, per_radius, share);
    resist(springs.stiffness * now.length, springs.damping * per_radius * now.length, springs.limit * share, velocities, stretch, of_each);
    for (int spring = 0; spring < k_springs; ++spring) force += Vec3(of_each.x[spring], of_each.y[spring], of_each.z[spring]);
    if (time_step <= 0.0) return;
    memory.contact_radius = springs.contact_radius;
    store(stretch, memory.stretch);
}

}  // namespace cutterflow::liggghts

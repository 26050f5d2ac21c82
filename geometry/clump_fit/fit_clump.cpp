#include "geometry/clump_fit/fit_clump.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/clump_fit/solid_shadow.hpp"

namespace cutterflow::geometry {
namespace {

constexpr int k_lattice = 24;  // points along the longest side of the rock's box
constexpr int k_surface_points = 600;
constexpr int k_rays = 2000;
constexpr double k_small_error = 0.002;
constexpr double k_small_distance = 0.02;  // of the equivalent diameter
constexpr double k_difference = 1e-3;      // of the equivalent diameter, for derivatives
constexpr double k_small_move = 0.1;       // of centres over the equivalent diameter, and of the logarithm of radii
constexpr int k_most_steps = 100;
constexpr double k_good_enough = 1e-4;  // relative change of the sum

/// What is to be met, in lengths of the equivalent diameter, about the rock's centroid and along its principal axes.
struct Target {
    TriangleSurface surface;
    Vec3 moments = Vec3::Zero();
    ShadowAreas extreme;
    std::vector<Vec3> directions;
    std::vector<double> shadows;
    std::vector<Vec3> surface_points;
};

/// Without its shadows.
ClumpProperties properties_of(const TriangleSurface& rock) {
    const MassProperties mass = mass_properties(rock);
    const PrincipalInertia principal = principal_inertia(mass);
    return {mass.volume, std::cbrt(6.0 * mass.volume / k_pi), mass.centroid, principal.moments, principal.axes, {}};
}

/// The k-th of `count` even directions over the sphere.
Vec3 even_direction(int k, int count) {
    const double z = 1.0 - 2.0 * (k + 0.5) / count;
    const double azimuth = k_pi * (3.0 - std::sqrt(5.0)) * k, across = std::sqrt(1.0 - z * z);
    return {across * std::cos(azimuth), across * std::sin(azimuth), z};
}

/// Points of a surface, as many on any of its parts as its area has a share.
std::vector<Vec3> even_points(const TriangleSurface& surface, int count) {
    std::vector<double> area;
    for (const Triangle& triangle : surface.triangles) area.push_back(area_vector(surface, triangle).norm());
    std::partial_sum(area.begin(), area.end(), area.begin());
    std::mt19937 random(1);
    const auto draw = [&] { return static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) {
        const auto at = std::lower_bound(area.begin(), area.end(), (k + 0.5) / count * area.back()) - area.begin();
        const Triangle& triangle = surface.triangles[static_cast<std::size_t>(at)];
        const double u = std::sqrt(draw()), v = draw();
        points.emplace_back((1.0 - u) * surface.points[triangle[0]] + u * (1.0 - v) * surface.points[triangle[1]] +
                            u * v * surface.points[triangle[2]]);
    }
    return points;
}

Target target_of(const TriangleSurface& rock, const ClumpProperties& properties) {
    Eigen::Affine3d inward = Eigen::Affine3d::Identity();
    inward.linear() = properties.axes.transpose() / properties.equivalent_diameter;
    inward.translation() = -(inward.linear() * properties.centroid);
    Target target;
    target.surface = transformed(rock, inward);
    target.moments = properties.principal_moments / std::pow(properties.equivalent_diameter, 5);
    const ExtremeShadows extreme = extreme_shadows(target.surface);
    target.extreme = extreme.areas;
    target.directions = {extreme.smallest_along, extreme.largest_along};
    for (const Vec3& direction : target.directions) target.shadows.push_back(shadow_area(target.surface, direction, 400));
    target.surface_points = even_points(target.surface, k_surface_points);
    return target;
}

/// Points of a lattice within the rock, with their distances from its surface.
std::vector<Ball> inscribed_balls(const TriangleSurface& rock) {
    const SolidSearch search(rock);
    const Bounds box = bounds_of(rock);
    const double spacing = box.extent().maxCoeff() / k_lattice;
    const Eigen::Array3i count = (box.extent() / spacing).array().ceil().cast<int>();
    std::vector<Ball> balls;
    for (int i = 0; i < count.x(); ++i)
        for (int j = 0; j < count.y(); ++j)
            for (int k = 0; k < count.z(); ++k) {
                const Vec3 place = box.min + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
                if (search.contains(place)) balls.push_back({place, search.nearest(place).distance});
            }
    return balls;
}

/// \param rock  the target's \param metres  of its length 1
[[noreturn]] void refuse_thin(const TriangleSurface& rock, double metres) {
    const double thickness = metres * 2.0 * volume_of(rock) / area_of(rock), length = metres * bounds_of(rock).extent().maxCoeff();
    throw UserError(
        fmt::format("the surface is about {:.2g} m thick and {:.3g} m long: no sphere finds a place in it", thickness, length),
        fmt::format("Spheres begin within it, at points of a lattice of {:.2g} m, 1/{} of its length", length / k_lattice, k_lattice),
        "Give a thicker surface: a plate or a needle this thin is no rock of spheres");
}

/// Of the balls the ones that one after the other hold the most centres that are in none before.
std::vector<Ball> filling_balls(const std::vector<Ball>& choice, int count) {
    std::vector<bool> filled(choice.size(), false);
    std::vector<Ball> taken;
    const auto holds = [](const Ball& ball, const Vec3& point) { return (point - ball.centre).squaredNorm() < ball.radius * ball.radius; };
    while (static_cast<int>(taken.size()) < count) {
        std::size_t best = 0;
        long most = 0;
        for (std::size_t b = 0; b < choice.size(); ++b) {
            long gain = 0;
            for (std::size_t p = 0; p < choice.size(); ++p) gain += !filled[p] && holds(choice[b], choice[p].centre) ? 1 : 0;
            if (gain <= most) continue;
            most = gain;
            best = b;
        }
        if (most == 0) break;
        taken.push_back(choice[best]);
        for (std::size_t p = 0; p < choice.size(); ++p) filled[p] = filled[p] || holds(choice[best], choice[p].centre);
    }
    return taken;
}

/// The radius as its logarithm: it stays above 0.
Clump clump_of(const Eigen::VectorXd& numbers) {
    Clump clump;
    for (Eigen::Index k = 0; k < numbers.size(); k += 4) clump.balls.push_back({numbers.segment<3>(k), std::exp(numbers[k + 3])});
    return clump;
}

Eigen::VectorXd numbers_of(const Clump& clump) {
    Eigen::VectorXd numbers(4 * static_cast<Eigen::Index>(clump.balls.size()));
    for (std::size_t b = 0; b < clump.balls.size(); ++b)
        numbers.segment<4>(4 * static_cast<Eigen::Index>(b)) << clump.balls[b].centre, std::log(clump.balls[b].radius);
    return numbers;
}

/// Distance of a point from the clump's surface, negative within.
double distance_from(const Clump& clump, const Vec3& point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Ball& ball : clump.balls) nearest = std::min(nearest, (point - ball.centre).norm() - ball.radius);
    return nearest;
}

double root_mean_square_distance(const Clump& clump, const Target& target) {
    double sum = 0.0;
    for (const Vec3& point : target.surface_points) sum += std::pow(distance_from(clump, point), 2);
    return std::sqrt(sum / static_cast<double>(target.surface_points.size()));
}

/// Integrals over a union of balls, about the origin.
struct RayMoments {
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    /// The part of a ray along `way` from one distance to another.
    void add(const Vec3& way, double from, double to) {
        const auto power = [&](int k) { return (std::pow(to, k) - std::pow(from, k)) / k; };
        volume += power(3);
        first += power(4) * way;
        second += power(5) * way * way.transpose();
    }
};

/// To 1e-4 in less than a millisecond: along each of 2,000 even rays from the origin the union is exact. It changes smoothly with the
/// balls.
RayMoments moments_by_rays(const Clump& clump) {
    static const std::vector<Vec3> rays = [] {
        std::vector<Vec3> all;
        for (int k = 0; k < k_rays; ++k) all.push_back(even_direction(k, k_rays));
        return all;
    }();
    RayMoments sum;
    std::vector<std::pair<double, double>> pieces;
    for (const Vec3& ray : rays) {
        pieces.clear();
        for (const Ball& ball : clump.balls) {
            const double along = ray.dot(ball.centre), square = ball.radius * ball.radius - ball.centre.squaredNorm() + along * along;
            if (square <= 0.0 || along + std::sqrt(square) <= 0.0) continue;
            pieces.emplace_back(std::max(0.0, along - std::sqrt(square)), along + std::sqrt(square));
        }
        std::sort(pieces.begin(), pieces.end());
        double end = 0.0;
        for (const auto& [from, to] : pieces) {
            if (to <= end) continue;
            sum.add(ray, std::max(from, end), to);
            end = to;
        }
    }
    const double share = 4.0 * k_pi / k_rays;
    return {share * sum.volume, share * sum.first, share * sum.second};
}

/// What the sum of squares is taken of.
Eigen::VectorXd misfits(const Clump& clump, const Target& target) {
    std::vector<double> list;
    const auto add = [&](double error) { list.push_back(error / k_small_error); };
    const RayMoments moments = moments_by_rays(clump);
    const Eigen::Matrix3d inertia = moments.second.trace() * Eigen::Matrix3d::Identity() - moments.second;
    add(moments.volume / (k_pi / 6.0) - 1.0);
    for (int i = 0; i < 3; ++i) add(moments.first[i] / (k_pi / 6.0));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) add((inertia(i, j) - (i == j ? target.moments[i] : 0.0)) / target.moments.mean());
    for (std::size_t k = 0; k < target.directions.size(); ++k) add(shadow_area(clump, target.directions[k]) / target.shadows[k] - 1.0);
    const double share = 1.0 / (k_small_distance * std::sqrt(static_cast<double>(target.surface_points.size())));
    for (const Vec3& point : target.surface_points) list.push_back(share * distance_from(clump, point));
    return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

/// The same, and how far the numbers are from where they began.
Eigen::VectorXd misfits_from(const Eigen::VectorXd& start, const Eigen::VectorXd& numbers, const Target& target) {
    const Eigen::VectorXd of_shape = misfits(clump_of(numbers), target);
    Eigen::VectorXd all(of_shape.size() + numbers.size());
    all << of_shape, (numbers - start) / k_small_move;
    return all;
}

/// The misfits and their derivatives, by differences, as Eigen's solver calls them.
struct MisfitFunction : Eigen::DenseFunctor<double> {
    MisfitFunction(const Target& given, const Eigen::VectorXd& first)
        : Eigen::DenseFunctor<double>(static_cast<int>(first.size()), static_cast<int>(misfits_from(first, first, given).size())),
          target(given),
          start(first) {}

    int operator()(const Eigen::VectorXd& numbers, Eigen::VectorXd& values) const {
        values = misfits_from(start, numbers, target);
        return 0;
    }
    int df(const Eigen::VectorXd& numbers, Eigen::MatrixXd& derivatives) const {
        const Eigen::VectorXd here = misfits_from(start, numbers, target);
        Eigen::VectorXd aside = numbers;
        for (Eigen::Index k = 0; k < numbers.size(); ++k) {
            aside[k] += k_difference;
            derivatives.col(k) = (misfits_from(start, aside, target) - here) / k_difference;
            aside[k] = numbers[k];
        }
        return 0;
    }
    const Target& target;
    const Eigen::VectorXd start;
};

/// \param inscribed  in the target's frame and lengths
Clump polished(const Clump& inscribed, const Target& target) {
    Eigen::VectorXd numbers = numbers_of(inscribed);
    MisfitFunction function(target, numbers);
    Eigen::LevenbergMarquardt<MisfitFunction> solver(function);
    solver.setMaxfev(k_most_steps);
    solver.setFtol(k_good_enough);
    solver.minimize(numbers);
    return clump_of(numbers);
}

/// Without balls that lie within others.
Clump without_hidden(const Clump& clump) {
    Clump seen;
    for (std::size_t i = 0; i < clump.balls.size(); ++i) {
        const Ball& ball = clump.balls[i];
        const bool hidden = std::any_of(clump.balls.begin(), clump.balls.end(), [&](const Ball& other) {
            return &other != &ball && (other.centre - ball.centre).norm() + ball.radius <= other.radius;
        });
        if (!hidden) seen.balls.push_back(ball);
    }
    return seen;
}

}  // namespace

ClumpFit fit_clump(const TriangleSurface& rock, int balls) {
    if (balls < 1 || balls > k_most_balls)
        throw UserError(fmt::format("{} spheres", balls), fmt::format("A clump has 1 to {} spheres", k_most_balls), "Correct the number");
    ClumpFit fit;
    fit.of_rock = properties_of(rock);
    const Target target = target_of(rock, fit.of_rock);
    const double d = fit.of_rock.equivalent_diameter;
    const Clump inscribed{filling_balls(inscribed_balls(target.surface), balls)};
    if (inscribed.balls.empty()) refuse_thin(target.surface, d);
    fit.of_rock.shadow = {d * d * target.extreme.smallest, d * d * target.extreme.largest};
    fit.inscribed_volume = d * d * d * union_mass_properties(inscribed).volume;
    const Clump clump = without_hidden(polished(inscribed, target));
    fit.surface_deviation = d * root_mean_square_distance(clump, target);
    for (const Ball& ball : clump.balls)
        fit.clump.balls.push_back({fit.of_rock.centroid + d * (fit.of_rock.axes * ball.centre), d * ball.radius});
    fit.clump.sphericity = std::min(1.0, k_pi * d * d / area_of(rock));
    const std::vector<Mistake> mistakes = clump_mistakes(fit.clump);
    if (!mistakes.empty())
        throw UserError(fmt::format("{} spheres do not make one rock: {}", balls, mistakes.front().what), "The spheres of a clump overlap",
                        "Give more spheres: few of them lie apart in a long or thin rock");
    fit.of_clump = clump_properties(fit.clump);
    return fit;
}

}  // namespace cutterflow::geometry

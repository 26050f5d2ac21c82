/// Clumps: mass properties of the union of the spheres, against closed forms and against an independent Monte Carlo.
#include <cmath>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/clump/clump.hpp"
#include "geometry/clump/clump_file.hpp"

namespace cutterflow::geometry {
namespace {

Clump five_balls() {
    return {{{Vec3(0.0, 0.0, 0.0), 0.010},
             {Vec3(0.008, 0.001, 0.0), 0.007},
             {Vec3(-0.006, 0.007, 0.002), 0.006},
             {Vec3(0.001, -0.008, 0.004), 0.0055},
             {Vec3(0.006, 0.006, -0.006), 0.005}}};
}

Clump moved(const Clump& clump, const Eigen::Matrix3d& turn, const Vec3& way) {
    Clump result = clump;
    for (Ball& ball : result.balls) ball.centre = turn * ball.centre + way;
    return result;
}

Eigen::Matrix3d some_turn() {
    return Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

/// Two balls of radius r, their centres c apart along x.
Clump dumbbell(double r, double c) {
    return {{{Vec3(-0.5 * c, 0.0, 0.0), r}, {Vec3(0.5 * c, 0.0, 0.0), r}}};
}

TEST(Clump, of_one_ball_is_a_sphere) {
    const double r = 0.02;
    const ClumpProperties properties = clump_properties({{{Vec3(1.0, -2.0, 0.5), r}}});
    const double volume = 4.0 / 3.0 * k_pi * r * r * r;
    EXPECT_NEAR(properties.volume / volume, 1.0, 1e-12);
    EXPECT_NEAR(properties.equivalent_diameter, 2.0 * r, 1e-13);
    EXPECT_NEAR((properties.centroid - Vec3(1.0, -2.0, 0.5)).norm(), 0.0, 1e-14);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(properties.principal_moments[k] / (0.4 * volume * r * r), 1.0, 1e-11);
    EXPECT_NEAR(properties.shadow.smallest / (k_pi * r * r), 1.0, 1e-11);
    EXPECT_NEAR(properties.shadow.largest / (k_pi * r * r), 1.0, 1e-11);
}

// Each half is a sphere cut at the plane between: radius^2 = r^2 - t^2, t from -c/2 (the plane) to r.
TEST(Clump, of_two_balls_has_the_values_of_the_closed_form) {
    const double r = 0.01;
    for (const double c : {0.002, 0.010, 0.019}) {
        const auto antiderivative = [](const std::vector<double>& coefficients, double t) {
            double sum = 0.0;
            for (std::size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * std::pow(t, k + 1.0) / (k + 1.0);
            return sum;
        };
        const auto integral = [&](const std::vector<double>& f) { return antiderivative(f, r) - antiderivative(f, -0.5 * c); };
        const double h = 0.5 * c, r2 = r * r;
        const double volume = 8.0 / 3.0 * k_pi * r * r2 - k_pi * (4.0 * r + c) * (2.0 * r - c) * (2.0 * r - c) / 12.0;
        const double fourth = integral({r2 * r2, 0.0, -2.0 * r2, 0.0, 1.0});                     // of (r^2 - t^2)^2
        const double along2 = integral({r2 * h * h, 2.0 * r2 * h, r2 - h * h, -2.0 * h, -1.0});  // of (r^2 - t^2)(t + h)^2
        const double about = k_pi * fourth, across = 0.5 * k_pi * fourth + 2.0 * k_pi * along2;
        const double lens = 2.0 * r2 * std::acos(0.5 * c / r) - 0.5 * c * std::sqrt(4.0 * r2 - c * c);

        const ClumpProperties properties = clump_properties(moved(dumbbell(r, c), some_turn(), Vec3(0.1, 0.2, -0.3)));
        EXPECT_NEAR(properties.volume / volume, 1.0, 1e-10) << c;
        EXPECT_NEAR((properties.centroid - Vec3(0.1, 0.2, -0.3)).norm(), 0.0, 1e-12) << c;
        EXPECT_NEAR(properties.principal_moments[0] / about, 1.0, 1e-9) << c;
        EXPECT_NEAR(properties.principal_moments[1] / across, 1.0, 1e-9) << c;
        EXPECT_NEAR(properties.principal_moments[2] / across, 1.0, 1e-9) << c;
        EXPECT_NEAR(std::abs(properties.axes.col(0).dot(some_turn().col(0))), 1.0, 1e-9) << c;
        EXPECT_NEAR(properties.axes.determinant(), 1.0, 1e-12) << c;
        // The area has a kink there: 2 r c/(pi r^2) per radian.
        EXPECT_NEAR(properties.shadow.smallest / (k_pi * r2), 1.0, 3e-6) << c;
        EXPECT_NEAR(properties.shadow.largest / (2.0 * k_pi * r2 - lens), 1.0, 1e-6) << c;
    }
}

/// Eight balls of 4 to 10 mm with their centres in a cube of 12 mm; each overlaps the first.
Clump random_clump(std::mt19937_64& random) {
    std::uniform_real_distribution<double> place(-0.006, 0.006), size(0.005, 0.010);
    Clump clump{{{Vec3::Zero(), 0.010}}};
    while (clump.balls.size() < 8) {
        clump.balls.push_back({Vec3(place(random), place(random), place(random)), size(random)});
        if (!clump_mistakes(clump).empty()) clump.balls.pop_back();
    }
    return clump;
}

// Every cross-section is another one after the turn.
TEST(Clump, properties_turn_and_move_with_the_clump) {
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const Clump clump = random_clump(random);
        const MassProperties here = union_mass_properties(clump);
        const MassProperties there = union_mass_properties(moved(clump, some_turn(), Vec3(5.0, 1.0, 2.0)));
        EXPECT_NEAR(there.volume / here.volume, 1.0, 1e-7);
        EXPECT_NEAR((there.centroid - some_turn() * here.centroid - Vec3(5.0, 1.0, 2.0)).norm(), 0.0, 1e-9);
        EXPECT_LT((there.inertia - some_turn() * here.inertia * some_turn().transpose()).norm() / here.inertia.norm(), 1e-7);
        const ShadowAreas areas = extreme_shadows(clump), turned = extreme_shadows(moved(clump, some_turn(), Vec3::Zero()));
        EXPECT_NEAR(turned.smallest / areas.smallest, 1.0, 1e-3);
        EXPECT_NEAR(turned.largest / areas.largest, 1.0, 1e-3);
    }
}

/// Integrals of the union by random points in its box, knowing nothing but who lies in which ball.
MassProperties by_monte_carlo(const Clump& clump, int points, std::mt19937_64& random) {
    Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);
    for (const Ball& ball : clump.balls) {
        low = low.cwiseMin(ball.centre - Vec3::Constant(ball.radius));
        high = high.cwiseMax(ball.centre + Vec3::Constant(ball.radius));
    }
    std::uniform_real_distribution<double> share(0.0, 1.0);
    double inside = 0.0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (int n = 0; n < points; ++n) {
        const Vec3 x = low + Vec3(share(random), share(random), share(random)).cwiseProduct(high - low);
        for (const Ball& ball : clump.balls) {
            if ((x - ball.centre).squaredNorm() > ball.radius * ball.radius) continue;
            inside += 1.0;
            first += x;
            second += x * x.transpose();
            break;
        }
    }
    const double volume = inside / points * (high - low).prod();
    const Vec3 arm = first / inside;
    const Eigen::Matrix3d covariance = volume * (second / inside - arm * arm.transpose());
    return {volume, arm, covariance.trace() * Eigen::Matrix3d::Identity() - covariance};
}

// 4 million points, of which about half are inside: standard error of the volume 5e-4, of the moments about 1e-3.
TEST(Clump, of_five_balls_is_what_random_points_find) {
    std::mt19937_64 random(7);
    const Clump clump = moved(five_balls(), some_turn(), Vec3(0.01, 0.0, 0.02));
    const MassProperties sampled = by_monte_carlo(clump, 4'000'000, random), exact = union_mass_properties(clump);
    EXPECT_NEAR(exact.volume / sampled.volume, 1.0, 2e-3);
    EXPECT_LT((exact.centroid - sampled.centroid).norm(), 2e-5);
    EXPECT_LT((exact.inertia - sampled.inertia).norm() / sampled.inertia.norm(), 4e-3);
}

TEST(Clump, shadow_is_what_random_points_find) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    std::normal_distribution<double> normal;
    const Clump clump = five_balls();
    const ShadowAreas extremes = extreme_shadows(clump);
    const double half = 0.02;
    for (int trial = 0; trial < 20; ++trial) {
        const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
        const Vec3 e1 = direction.unitOrthogonal(), e2 = direction.cross(e1);
        int inside = 0;
        const int points = 400'000;
        for (int n = 0; n < points; ++n) {
            const double u = half * share(random), v = half * share(random);
            for (const Ball& ball : clump.balls)
                if (std::hypot(u - ball.centre.dot(e1), v - ball.centre.dot(e2)) < ball.radius) {
                    ++inside;
                    break;
                }
        }
        const double sampled = 4.0 * half * half * inside / points;  // standard error 0.2 %
        EXPECT_NEAR(shadow_area(clump, direction) / sampled, 1.0, 8e-3);
        EXPECT_GT(sampled, extremes.smallest * (1.0 - 8e-3));
        EXPECT_LT(sampled, extremes.largest * (1.0 + 8e-3));
    }
    EXPECT_GT(extremes.largest, 1.05 * extremes.smallest);
}

TEST(Clump, with_a_hole_casts_a_shadow_with_a_hole) {
    Clump ring;
    for (int k = 0; k < 12; ++k) ring.balls.push_back({Vec3(0.03 * std::cos(k * k_pi / 6.0), 0.03 * std::sin(k * k_pi / 6.0), 0.0), 0.01});
    // Twelve discs of which neighbours overlap in one lens: centres 0.06 sin 15 degrees apart.
    const double c = 0.06 * std::sin(k_pi / 12.0), r = 0.01;
    const double lens = 2.0 * r * r * std::acos(0.5 * c / r) - 0.5 * c * std::sqrt(4.0 * r * r - c * c);
    EXPECT_NEAR(shadow_area(ring, Vec3::UnitZ()) / (12.0 * (k_pi * r * r - lens)), 1.0, 1e-11);
    const double cap = k_pi * (4.0 * r + c) * (2.0 * r - c) * (2.0 * r - c) / 12.0;
    EXPECT_NEAR(union_mass_properties(ring).volume / (12.0 * (4.0 / 3.0 * k_pi * r * r * r - cap)), 1.0, 1e-10);
}

class ClumpFile : public ::testing::Test {
protected:
    std::filesystem::path file_ = std::filesystem::path(::testing::TempDir()) / "test.clump";
    std::string mistakes_of(const std::string& text) {
        cutterflow::write_file(file_, text);
        try {
            read_clump(file_);
        } catch (const UserError& error) {
            return error.what();
        }
        return "none";
    }
};

TEST_F(ClumpFile, is_read_as_it_was_written) {
    const Clump clump = moved(five_balls(), some_turn(), Vec3(1.0 / 3.0, 0.0, 1e-7));
    write_clump(clump, "Five balls.\nTwo lines.", file_);
    const Clump read = read_clump(file_);
    ASSERT_EQ(read.balls.size(), clump.balls.size());
    for (std::size_t k = 0; k < read.balls.size(); ++k) {
        EXPECT_EQ(read.balls[k].centre, clump.balls[k].centre);
        EXPECT_EQ(read.balls[k].radius, clump.balls[k].radius);
    }
}

TEST_F(ClumpFile, is_refused_with_all_its_mistakes) {
    using ::testing::AllOf;
    using ::testing::HasSubstr;
    const std::string ball = "[[sphere]]\nx_m = 0\ny_m = 0\nz_m = 0\nradius_m = ";
    EXPECT_THAT(mistakes_of("[[sphere]]\nx_m = 0\ny_m = 0\nradius_m = -1\nradios_m = 2\n"),
                AllOf(HasSubstr("z_m"), HasSubstr("radius_m"), HasSubstr("radios_m"), HasSubstr("test.clump")));
    EXPECT_THAT(mistakes_of("# nothing\n"), HasSubstr("has no sphere"));
    EXPECT_THAT(mistakes_of(ball + "0.01\n" + ball + "0.004\n" + "[[sphere]]\nx_m = 1\ny_m = 0\nz_m = 0\nradius_m = 0.01\n"),
                AllOf(HasSubstr("sphere 2 lies within sphere 1"), HasSubstr("sphere 3 is not joined to sphere 1")));
    EXPECT_THAT(mistakes_of(ball + "0.01\n" + ball + "0.01\n"), HasSubstr("sphere 2 lies within sphere 1"));
    EXPECT_THAT(mistakes_of(ball + "0.01\n"), HasSubstr("none"));
}

}  // namespace
}  // namespace cutterflow::geometry

// What two sides of a surface of revolution share.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/foam/mesh_motion/revolution_overlap.hpp"

namespace cutterflow::foam {
namespace {

using Side = std::vector<RevolutionOverlap::Face>;

constexpr double k_radius = 0.3, k_height = 0.2;

Vec3 on_circle(double radius, double azimuth, double z) {
    return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

/// `around` faces of a ring from (r0, z0) to (r1, z1), unequally wide with `skew` > 0.
void add_ring(Side& side, int around, double r0, double z0, double r1, double z1, double skew = 0.0) {
    const auto azimuth = [&](int i) {
        const double turn = 2.0 * k_pi * i / around;
        return turn + skew * std::sin(turn);
    };
    for (int i = 0; i < around; ++i) {
        side.push_back({on_circle(r0, azimuth(i), z0), on_circle(r0, azimuth(i + 1), z0), on_circle(r1, azimuth(i + 1), z1),
                        on_circle(r1, azimuth(i), z1)});
    }
}

/// A square of n x n faces inside the circle of `radius`, and the faces between both.
void add_core(Side& side, int n, double radius, double z) {
    const double half = 0.5 * radius;
    const auto at = [&](int i) { return -half + 2.0 * half * i / n; };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j)
            side.push_back({{at(i), at(j), z}, {at(i + 1), at(j), z}, {at(i + 1), at(j + 1), z}, {at(i), at(j + 1), z}});
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Eigen::AngleAxisd turn(0.5 * k_pi * quarter, Vec3::UnitZ());
        const auto outer = [&](int i) { return on_circle(radius, -0.25 * k_pi + 0.5 * k_pi * i / n, z); };
        for (int i = 0; i < n; ++i) {
            const Vec3 inner{half, at(i), z}, next{half, at(i + 1), z};
            side.push_back({turn * inner, turn * outer(i), turn * outer(i + 1), turn * next});
        }
    }
}

/// A can: a wall of two rings, a disc of one ring and a core at each end.
Side can(int n, double skew = 0.0) {
    Side side;
    add_ring(side, 4 * n, k_radius, 0.0, k_radius, 0.4 * k_height, skew);
    add_ring(side, 4 * n, k_radius, 0.4 * k_height, k_radius, k_height, skew);
    for (const double z : {0.0, k_height}) {
        add_ring(side, 4 * n, 0.6 * k_radius, z, k_radius, z, skew);
        add_core(side, n, 0.6 * k_radius, z);
    }
    return side;
}

Vec3 centre_of(const RevolutionOverlap::Face& face) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : face) sum += corner;
    return sum / static_cast<double>(face.size());
}

TEST(RevolutionOverlap, EqualRingsShareByTheFractionOfAFace) {
    Side side;
    add_ring(side, 12, k_radius, 0.0, k_radius, k_height);
    const auto overlap = RevolutionOverlap::between(side, side, RotationAxis());
    ASSERT_TRUE(overlap.has_value());
    const double span = 2.0 * k_pi / 12;
    for (const double faces : {0.25, 3.7, -5.4, 1000.125}) {
        const double fraction = faces - std::floor(faces);
        const auto parts = overlap->at(faces * span);
        EXPECT_EQ(parts.size(), 24u);
        for (const FaceOverlap& part : parts) {
            // The still face i has the turned faces i - floor(faces), of which it covers 1 - fraction, and the one before.
            const int moved =
                ((static_cast<int>(part.still) - static_cast<int>(part.turned) - static_cast<int>(std::floor(faces))) % 12 + 12) % 12;
            ASSERT_TRUE(moved == 0 || moved == 1);
            EXPECT_NEAR(part.of_still, moved == 0 ? 1.0 - fraction : fraction, 1e-11);
            EXPECT_NEAR(part.of_turned, part.of_still, 1e-11);
        }
    }
}

TEST(RevolutionOverlap, SharesOfAFaceAddUpAndBothSidesShareTheSameAzimuth) {
    Side still, turning;
    add_ring(still, 10, k_radius, 0.0, k_radius, k_height, 0.3);
    add_ring(turning, 17, k_radius, 0.0, k_radius, k_height, 0.2);
    const auto overlap = RevolutionOverlap::between(still, turning, RotationAxis());
    ASSERT_TRUE(overlap.has_value());
    const auto span = [](const RevolutionOverlap::Face& face) {
        return std::abs(std::remainder(std::atan2(face[1].y(), face[1].x()) - std::atan2(face[0].y(), face[0].x()), 2.0 * k_pi));
    };
    for (int step = 0; step < 50; ++step) {
        std::vector<double> of_still(still.size(), 0.0), of_turned(turning.size(), 0.0);
        for (const FaceOverlap& part : overlap->at(0.37 * step)) {
            of_still[part.still] += part.of_still;
            of_turned[part.turned] += part.of_turned;
            EXPECT_NEAR(part.of_still * span(still[part.still]), part.of_turned * span(turning[part.turned]), 1e-11);
        }
        for (const double sum : of_still) EXPECT_NEAR(sum, 1.0, 1e-15);
        for (const double sum : of_turned) EXPECT_NEAR(sum, 1.0, 1e-15);
    }
}

TEST(RevolutionOverlap, TakesALinearFieldAcrossInSecondOrder) {
    double errors[2] = {0.0, 0.0};
    for (int level = 0; level < 2; ++level) {
        Side side;
        add_ring(side, level == 0 ? 24 : 48, k_radius, 0.0, k_radius, k_height);
        const auto overlap = RevolutionOverlap::between(side, side, RotationAxis());
        for (int step = 1; step < 20; ++step) {
            const double angle = 0.0731 * step;
            std::vector<double> value(side.size(), 0.0);
            for (const FaceOverlap& part : overlap->at(angle))
                value[part.still] += part.of_still * rotate_about(RotationAxis(), angle, centre_of(side[part.turned])).x();
            for (std::size_t f = 0; f < side.size(); ++f)
                errors[level] = std::max(errors[level], std::abs(value[f] - centre_of(side[f]).x()));
        }
    }
    EXPECT_GE(std::log2(errors[0] / errors[1]), 1.8);
}

// Random points of a still face say which turned faces cover it.
TEST(RevolutionOverlap, ClipsFacesOfADisc) {
    Side side;
    add_core(side, 4, k_radius, 0.0);
    const auto overlap = RevolutionOverlap::between(side, side, RotationAxis());
    ASSERT_TRUE(overlap.has_value());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto contains = [](const RevolutionOverlap::Face& face, const Vec3& p) {
        int turns = 0;
        for (std::size_t c = 0; c < face.size(); ++c) {
            const Vec3 along = face[(c + 1) % face.size()] - face[c], to = p - face[c];
            turns += along.x() * to.y() - along.y() * to.x() > 0.0 ? 1 : -1;
        }
        return std::abs(turns) == static_cast<int>(face.size());
    };
    for (const double angle : {0.2, 0.9, 2.5}) {
        std::vector<std::vector<double>> share(side.size(), std::vector<double>(side.size(), 0.0));
        for (const FaceOverlap& part : overlap->at(angle)) share[part.still][part.turned] += part.of_still;
        for (std::size_t f = 0; f < 16; ++f) {  // the core: no chord cuts its faces off from the other side
            constexpr int k_points = 4000;
            std::vector<int> hits(side.size(), 0);
            for (int k = 0; k < k_points; ++k) {
                const Vec3 p = side[f][0] + unit(random) * (side[f][1] - side[f][0]) + unit(random) * (side[f][3] - side[f][0]);
                const Vec3 own = rotate_about(RotationAxis(), -angle, p);
                for (std::size_t other = 0; other < side.size(); ++other) hits[other] += contains(side[other], own) ? 1 : 0;
            }
            for (std::size_t other = 0; other < side.size(); ++other)
                EXPECT_NEAR(share[f][other], static_cast<double>(hits[other]) / k_points, 0.04);  // 5 standard deviations
        }
    }
}

TEST(RevolutionOverlap, HoldsForACanOfAnyMeshAndAxis) {
    const RotationAxis tilted{{0.1, -0.2, 0.3}, Vec3(1.0, 2.0, -0.5).normalized()};
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), tilted.direction);
    const auto placed = [&](Side side) {
        for (auto& face : side) {
            for (Vec3& corner : face) corner = tilted.origin + turn * corner;
        }
        return side;
    };
    const Side still = placed(can(4, 0.1)), turning = placed(can(6));
    const auto overlap = RevolutionOverlap::between(still, turning, tilted);
    ASSERT_TRUE(overlap.has_value());
    for (int step = 0; step < 30; ++step) {
        const double angle = -0.41 * step;
        std::vector<double> of_still(still.size(), 0.0), of_turned(turning.size(), 0.0);
        for (const FaceOverlap& part : overlap->at(angle)) {
            of_still[part.still] += part.of_still;
            of_turned[part.turned] += part.of_turned;
            const Vec3 apart = centre_of(still[part.still]) - rotate_about(tilted, angle, centre_of(turning[part.turned]));
            EXPECT_LE(apart.norm(), 0.75 * k_radius);  // faces of one can are at most half a radius wide
        }
        for (const double sum : of_still) EXPECT_NEAR(sum, 1.0, 1e-14);
        for (const double sum : of_turned) EXPECT_NEAR(sum, 1.0, 1e-14);
    }
}

Vec3 area_of(const RevolutionOverlap::Face& face) {
    return 0.5 * (face[2] - face[0]).cross(face[3] - face[1]);
}

/// What the parts of a face, over both sides, lack at most of the area vector of the face.
double lacking_area(const Side& still, const Side& turning, const RevolutionOverlap& overlap, double angle) {
    std::vector<Vec3> of_still, of_turned;
    for (const auto& face : still) of_still.push_back(area_of(face));
    for (auto face : turning) {
        for (Vec3& corner : face) corner = rotate_about(RotationAxis(), angle, corner);
        of_turned.push_back(area_of(face));
    }
    for (const FaceOverlap& part : overlap.at(angle)) {
        of_still[part.still] -= part.area;
        of_turned[part.turned] -= part.area;
    }
    double worst = 0.0;
    for (const Vec3& rest : of_still) worst = std::max(worst, rest.norm());
    for (const Vec3& rest : of_turned) worst = std::max(worst, rest.norm());
    return worst;
}

// One area vector for a part closes the cells of both sides: also where chords of 10 and of 17 faces stand off from each other.
TEST(RevolutionOverlap, PartsOfAFaceAddUpToItsAreaOnBothSides) {
    Side still, turning;
    add_ring(still, 10, k_radius, 0.0, k_radius, k_height, 0.3);
    add_ring(turning, 17, k_radius, 0.0, k_radius, k_height, 0.2);
    const auto cylinder = RevolutionOverlap::between(still, turning, RotationAxis());
    ASSERT_TRUE(cylinder.has_value());
    ASSERT_TRUE(cylinder->pairs_areas());
    const Side side = can(6);
    const auto closed = RevolutionOverlap::between(side, side, RotationAxis());
    ASSERT_TRUE(closed.has_value());
    ASSERT_TRUE(closed->pairs_areas());
    for (int step = 0; step < 50; ++step) {
        EXPECT_LE(lacking_area(still, turning, *cylinder, 0.37 * step), 1e-14 * k_radius * k_height);
        EXPECT_LE(lacking_area(side, side, *closed, 0.37 * step), 1e-13 * k_radius * k_height);
    }
    for (const FaceOverlap& part : closed->at(0.37)) EXPECT_GT(part.area.dot(area_of(side[part.still])), 0.0);
}

// Discs of 16 and of 24 corners have not the same area.
TEST(RevolutionOverlap, HasNoAreasOfPartsWhereBothSidesHaveNotTheSame) {
    const auto unlike = RevolutionOverlap::between(can(4), can(6), RotationAxis());
    ASSERT_TRUE(unlike.has_value());
    EXPECT_FALSE(unlike->pairs_areas());
}

TEST(RevolutionOverlap, RefusesOtherSurfaces) {
    Side ring, half, other_rings;
    add_ring(ring, 12, k_radius, 0.0, k_radius, k_height);
    half.assign(ring.begin(), ring.begin() + 6);
    add_ring(other_rings, 12, k_radius, 0.0, k_radius, 0.5 * k_height);
    add_ring(other_rings, 12, k_radius, 0.5 * k_height, k_radius, k_height);
    EXPECT_FALSE(RevolutionOverlap::between(ring, half, RotationAxis()).has_value());
    EXPECT_FALSE(RevolutionOverlap::between(ring, other_rings, RotationAxis()).has_value());
    EXPECT_FALSE(RevolutionOverlap::between(ring, ring, RotationAxis{{0.01, 0.0, 0.0}, Vec3::UnitZ()}).has_value());
    EXPECT_FALSE(RevolutionOverlap::between(ring, {}, RotationAxis()).has_value());
}

}  // namespace
}  // namespace cutterflow::foam

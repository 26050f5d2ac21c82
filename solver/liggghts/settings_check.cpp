#include "solver/liggghts/settings_check.hpp"

#include <cmath>

#include <fmt/format.h>

#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts {

namespace {

constexpr const char* k_where = "constant/couplingProperties";
constexpr std::size_t k_longest_path = 250;  // LIGGGHTS copies paths into buffers of 256 characters

class Checker {
public:
    void require(bool holds, const std::string& what, const std::string& rule, const std::string& remedy) {
        if (!holds) mistakes_.push_back({k_where, what, rule, remedy});
    }
    void number(const std::string& key, double value, bool holds, const std::string& rule) {
        require(holds && std::isfinite(value), fmt::format("{} = {}", key, value), "It must be " + rule, "Correct it");
    }
    void positive(const std::string& key, double value) { number(key, value, value > 0.0, "> 0"); }
    std::vector<Mistake> take() { return std::move(mistakes_); }

private:
    std::vector<Mistake> mistakes_;
};

void check_contact(const coupling::ContactSettings& contact, Checker& check) {
    const auto poisson = [&](const std::string& key, double value) {
        check.number(key, value, value >= 0.0 && value <= 0.5, "within 0 and 0.5");
    };
    check.positive("rock.contact.youngsModulus", contact.youngs_modulus);
    poisson("rock.contact.poissonRock", contact.poisson_rock);
    poisson("rock.contact.poissonSteel", contact.poisson_steel);
    check.number("rock.contact.friction", contact.friction, contact.friction >= 0.0, ">= 0");
    check.number("rock.contact.restitution", contact.restitution,
                 contact.restitution >= physics::k_smallest_restitution && contact.restitution <= 1.0,
                 fmt::format("within {} and 1", physics::k_smallest_restitution));
    check.number("rock.contact.timeStepFraction", contact.time_step_fraction,
                 contact.time_step_fraction > 0.0 && contact.time_step_fraction <= 0.5, "> 0 and <= 0.5");
    check.positive("rock.contact.maxSpeed", contact.max_speed);
}

void check_linear(const coupling::DemSettings& settings, Checker& check) {
    const coupling::LinearContactSettings& law = settings.linear;
    check.positive("contact.theta", law.theta);
    check.positive("contact.reference_length_m", law.reference_length);
    check.positive("contact gravity", law.gravity);
    check.number("contact.damping", law.damping, law.damping >= 0.0 && law.damping < std::sqrt(0.5), ">= 0 and < sqrt(1/2): a pair swings");
    check.number("contact.poisson", law.poisson, law.poisson >= 0.0 && law.poisson <= 0.5, "within 0 and 0.5");
    check.number("contact steps per period", law.steps_per_period, law.steps_per_period >= 20.0, ">= 20");
    check.number("contact.friction", settings.contact.friction, settings.contact.friction >= 0.0, ">= 0");
}

void check_shape(const coupling::DemSettings& settings, Checker& check) {
    check.number("contact.gap_m", settings.contact_gap, settings.contact_gap >= 0.0, ">= 0");
    if (settings.shape != coupling::RockShape::cylinder) return;
    check.positive("cylinder length", settings.cylinder_length);
    check.number("fluid density", settings.fluid.density, settings.fluid.density == 0.0,
                 "0 for cylinders: added mass and buoyancy are a sphere's");
}

void check_domain(const coupling::DomainSettings& domain, Checker& check) {
    if (domain.shape == coupling::DomainShape::cylinder) {
        check.positive("rock.domain.radius", domain.radius);
        check.require(domain.lower.z() < domain.upper.z(),
                      fmt::format("rock.domain.zMin = {}, zMax = {}", domain.lower.z(), domain.upper.z()), "zMin must be below zMax",
                      "Correct them");
        for (const std::size_t side : {0, 1, 2, 3})
            check.require(!domain.side_is_wall[side], fmt::format("rock.domain.walls: {} of a cylinder", coupling::k_domain_sides[side]),
                          "A cylinder's plane sides are zMin and zMax", "Give its mantle as an STL in rock.walls");
        return;
    }
    for (Eigen::Index i = 0; i < 3; ++i)
        check.require(domain.lower[i] < domain.upper[i],
                      fmt::format("rock.domain: {0} from {1} to {2}", "xyz"[i], domain.lower[i], domain.upper[i]),
                      "Corner lower must lie below corner upper", "Correct the corners");
}

void check_fluid(const coupling::DemSettings& settings, Checker& check) {
    check.number("fluid density", settings.fluid.density, settings.fluid.density >= 0.0, ">= 0");
    check.number("closures.addedMass", settings.added_mass, settings.added_mass >= 0.0, ">= 0");
    if (!settings.contact.wet_restitution) return;
    check.require(
        settings.fluid.density > 0.0 && settings.fluid.kinematic_viscosity > 0.0,
        fmt::format("wet restitution with density {} and viscosity {}", settings.fluid.density, settings.fluid.kinematic_viscosity),
        "It needs a fluid with both > 0", "Set rock.contact.wetRestitution false, or give rho and nu");
}

}  // namespace

std::vector<Mistake> check_settings(const coupling::DemSettings& settings) {
    Checker check;
    if (settings.law == coupling::ContactLaw::linear) {
        check_linear(settings, check);
    } else {
        check_contact(settings.contact, check);
    }
    check_shape(settings, check);
    check_domain(settings.domain, check);
    check_fluid(settings, check);
    for (const coupling::WallSettings& wall : settings.walls) {
        const std::string path = std::filesystem::absolute(wall.file).string();
        check.require(path.size() <= k_longest_path && path.find('"') == std::string::npos,
                      fmt::format("wall {}: path {}", wall.name, path),
                      fmt::format("LIGGGHTS reads paths of at most {} characters without quotation marks", k_longest_path),
                      "Move the run to a shorter path");
    }
    return check.take();
}

}  // namespace cutterflow::liggghts

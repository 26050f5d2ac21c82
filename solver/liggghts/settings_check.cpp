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

void check_domain(const coupling::DomainSettings& domain, Checker& check) {
    check.positive("rock.domain.radius", domain.radius);
    check.require(domain.z_min < domain.z_max, fmt::format("rock.domain.zMin = {}, zMax = {}", domain.z_min, domain.z_max),
                  "zMin must be below zMax", "Correct them");
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

std::vector<Mistake> check_settings(const coupling::DemSettings& settings, const coupling::RotorMotion& rotor) {
    Checker check;
    check_contact(settings.contact, check);
    check_domain(settings.domain, check);
    check_fluid(settings, check);
    const Vec3& direction = rotor.axis.direction;
    check.require(std::fabs(std::fabs(direction.z()) - 1.0) < 1e-12,
                  fmt::format("rotor axis ({}, {}, {})", direction.x(), direction.y(), direction.z()),
                  "The DEM's domain is a cylinder along z", "Turn the run's frame so that the rotor's axis is z");
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

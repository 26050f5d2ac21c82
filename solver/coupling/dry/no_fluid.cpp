#include "solver/coupling/dry/no_fluid.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace cutterflow::coupling {
namespace {

[[noreturn]] void nothing_flows(const char* what) {
    throw std::logic_error(fmt::format("a run without a medium has no {}", what));
}

}  // namespace

gsl::span<const Vec3> NoFluid::vorticity() {
    nothing_flows("vorticity");
}
gsl::span<const Vec3> NoFluid::stress_divergence() {
    nothing_flows("stress");
}
gsl::span<const double> NoFluid::wall_retreat() const {
    nothing_flows("cells beside walls");
}
void NoFluid::reset_void_fraction(gsl::span<const double>) {
    nothing_flows("void fraction");
}
gsl::span<const Vec3> NoFluid::received() const {
    nothing_flows("momentum from rock");
}
void NoFluid::sample_velocity(gsl::span<const Vec3>, gsl::span<Vec3>) {
    nothing_flows("velocity");
}
void NoFluid::watch(const WatchedPlaces&) {
    nothing_flows("velocity");
}
std::vector<double> NoFluid::watched_means() {
    nothing_flows("velocity");
}
FluidLoads NoFluid::loads() {
    nothing_flows("loads");
}

}  // namespace cutterflow::coupling

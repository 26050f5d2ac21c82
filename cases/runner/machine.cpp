#include "cases/runner/machine.hpp"

#include <sched.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include <fmt/format.h>

#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/processor_time.hpp"

namespace cutterflow::cases {
namespace {

constexpr const char* k_openfoam = "v1912";

void require_openfoam_environment() {
    const char* version = std::getenv("WM_PROJECT_VERSION");
    if (version == nullptr || std::string(version).empty() || std::string(version) == k_openfoam) return;
    throw UserError(fmt::format("the environment of OpenFOAM {} is loaded (WM_PROJECT_VERSION)", version),
                    fmt::format("Cutterflow works with OpenFOAM {} alone", k_openfoam),
                    "Use a shell in which that version's etc/bashrc was not sourced");
}

void require_ranks(int ranks) {
    const int cores = available_cores();
    if (ranks < 1) throw UserError(fmt::format("--ranks {}", ranks), "A run needs one process or more", "Use --ranks 1");
    if (ranks <= cores) return;
    throw UserError(fmt::format("--ranks {} on {} core(s)", ranks, cores), "Each rank needs a core",
                    fmt::format("Use --ranks {}, or a machine with more cores", cores));
}

constexpr std::uint32_t k_lattice = 64;          // cells along an edge
constexpr int k_sweeps = 15;                     // some of them in every phase of what else the machine does
constexpr double k_reference_ns_per_cell = 8.4;  // median of a sweep on the reference machine

/// The faces between the cells of a cubic lattice, as OpenFOAM addresses a matrix.
struct LatticeMatrix {
    std::vector<std::uint32_t> lower, upper;
    std::vector<double> below, above, diagonal;

    explicit LatticeMatrix(std::uint32_t n) : diagonal(std::size_t{n} * n * n, 1.01) {
        const auto add = [this](std::uint32_t a, std::uint32_t b) {
            lower.push_back(a);
            upper.push_back(b);
        };
        for (std::uint32_t cell = 0; cell < diagonal.size(); ++cell) {
            if (cell % n + 1 < n) add(cell, cell + 1);
            if (cell / n % n + 1 < n) add(cell, cell + n);
            if (cell / (n * n) + 1 < n) add(cell, cell + n * n);
        }
        below.assign(lower.size(), -1.0 / 6.0);
        above = below;
    }
};

/// One damped Jacobi step of A x = 1.
void sweep(const LatticeMatrix& a, std::vector<double>& x, std::vector<double>& product) {
    for (std::size_t cell = 0; cell < x.size(); ++cell) product[cell] = a.diagonal[cell] * x[cell];
    for (std::size_t face = 0; face < a.lower.size(); ++face) {
        product[a.upper[face]] += a.below[face] * x[a.lower[face]];
        product[a.lower[face]] += a.above[face] * x[a.upper[face]];
    }
    for (std::size_t cell = 0; cell < x.size(); ++cell) x[cell] += 0.5 * (1.0 - product[cell]) / a.diagonal[cell];
}

}  // namespace

double machine_slowness() {
    const LatticeMatrix matrix(k_lattice);
    std::vector<double> x(matrix.diagonal.size(), 1.0), product(x.size());
    std::vector<double> seconds;
    for (int i = 0; i < k_sweeps; ++i) {
        const double begin = processor_seconds();
        sweep(matrix, x, product);
        seconds.push_back(processor_seconds() - begin);
    }
    std::nth_element(seconds.begin(), seconds.begin() + k_sweeps / 2, seconds.end());
    return 1e9 * seconds[k_sweeps / 2] / static_cast<double>(x.size()) / k_reference_ns_per_cell;
}

int available_cores() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // of a machine with more cores than the set holds
}

void require_machine(int ranks) {
    Mistakes mistakes;
    mistakes.gather([&] { require_ranks(ranks); });
    mistakes.gather(require_openfoam_environment);
    mistakes.refuse();
}

}  // namespace cutterflow::cases

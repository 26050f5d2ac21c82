/// The same run on 1, 2 and 4 ranks, whole or resumed.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cases/runner/solver_run.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "solver/coupling/checkpoint.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/rotor_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_end = 0.15, k_halfway = 0.1;

/// Linear solvers converge to rounding, so that the remaining difference between ranks is the program's own.
void solve_to_rounding(const fs::path& folder) {
    const fs::path file = folder / "system/fvSolution";
    std::string text = std::regex_replace(read_file(file), std::regex("tolerance +[^;]+;"), "tolerance 1e-13;");
    text = std::regex_replace(text, std::regex("relTol +[^;]+;"), "relTol 0; maxIter 100;");
    write_file(file, text);
}

constexpr const char* k_two_rocks = "1,0.03,0,0.18,-0.1,0.02,2650\n2,0.03,-0.05,0.23,0,0.02,2650\n";

/// A run of the tiny rotor. \param rocks  rows of the feed \param interval  of checkpoints [s]
fs::path rotor_case(const fs::path& folder, const std::string& rocks, double end, double interval, int ranks) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.ranks = ranks;
    inputs.times.end = end;
    inputs.checkpoint = {interval, 100};
    inputs.times.write_interval = interval;
    inputs.rock.emplace();
    coupling::use_preset(inputs.rock->contact, coupling::k_paper_pairs);
    write_rotor_case(folder, inputs, "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n" + rocks);
    return folder;
}

fs::path rotor_run(const fs::path& folder, int ranks) {
    rotor_case(folder, k_two_rocks, k_end, 0.05, ranks);
    solve_to_rounding(folder);
    cases::decompose(folder, ranks);
    run_cutter_foam(folder, ranks);
    return folder;
}

/// Largest distance of any rock over the tank's diameter in two checkpoints, which keep all digits.
double apart_in(const fs::path& a, const fs::path& b) {
    const auto one = coupling::read_state(a), other = coupling::read_state(b);
    if (one.rocks.empty() || one.rocks.size() != other.rocks.size())
        throw std::runtime_error(fmt::format("{} rocks in {}, {} in {}", one.rocks.size(), a.string(), other.rocks.size(), b.string()));
    double most = std::abs(one.time - other.time) < 1e-9 ? 0.0 : 1.0;
    for (const auto& [id, rock] : one.rocks) most = larger(most, (rock.position - other.rocks.at(id).position).norm());
    return most / (2.0 * cases::test::k_tiny_tank_radius);
}

/// The same at the end of two runs.
double apart(const fs::path& a, const fs::path& b) {
    return apart_in(newest_checkpoint(a), newest_checkpoint(b));
}

/// A copy of a run as it was at a time [s], resumed.
fs::path resumed(const Verification& verification, const std::string& name, const fs::path& whole, double from, int ranks) {
    const fs::path folder = verification.folder(name);
    fs::copy(whole, folder, fs::copy_options::recursive);
    for (const auto& checkpoint : fs::directory_iterator(folder / names::checkpoints))
        if (std::stod(checkpoint.path().filename()) > from + 1e-6) fs::remove_all(checkpoint.path());
    fs::remove_all(folder / "postProcessing");  // what is read afterwards is the resumed run's own
    drop_times_after_checkpoint(folder);
    cases::move_checkpoint_to_ranks(folder, ranks);
    run_cutter_foam(folder, ranks);
    return folder;
}

void check_ranks_and_restart(Verification& verification) {
    const fs::path one = rotor_run(verification.folder("ranks_1"), 1), two = rotor_run(verification.folder("ranks_2"), 2),
                   four = rotor_run(verification.folder("ranks_4"), 4);
    const About about{"exact", "0.15 s at 60 rpm, no contacts, linear solvers to rounding", {}};
    verification.at_most("rock on 2 ranks and on 1", "tank diameters", apart(one, two), 1e-8, about);
    verification.at_most("rock on 4 ranks and on 1", "tank diameters", apart(one, four), 1e-8, about);
    const auto resume = [&](const fs::path& whole, int begun, int ranks) {
        return apart(whole, resumed(verification, fmt::format("resumed_from_{}_on_{}", begun, ranks), whole, k_halfway, ranks));
    };
    verification.at_most("resumed on 1 rank, begun on 1", "tank diameters", resume(one, 1, 1), 1e-10, {"exact", "stopped at 0.1 s", {}});
    verification.at_most("resumed on 2 ranks, begun on 2", "tank diameters", resume(two, 2, 2), 1e-10, {"exact", "stopped at 0.1 s", {}});
    verification.at_most("resumed on 1 rank, begun on 2", "tank diameters", resume(two, 2, 1), 1e-8,
                         {"exact", "through reconstructPar", {}});
    verification.at_most("resumed on 4 ranks, begun on 1", "tank diameters", resume(one, 1, 4), 1e-8,
                         {"exact", "through decomposePar", {}});
}

/// Water after the first step from a checkpoint, against the run that did not stop.
void check_first_step(Verification& verification) {
    constexpr double step = 1e-3;
    const fs::path whole = rotor_case(verification.folder("first_step"), k_two_rocks, k_halfway + step, 0.05, 1);
    const std::size_t cells = cases::test::k_tiny_cells;
    const std::string time = fmt::format("{:g}", k_halfway + step);
    for (const auto& [key, value] :
         {std::pair("writeFormat", std::string("ascii")), std::pair("writePrecision", std::string("17")), std::pair("writeInterval", time)})
        run_in_case(whole, {"foamDictionary", "-entry", key, "-set", value, "system/controlDict"});
    solve_to_rounding(whole);
    run_cutter_foam(whole);
    const std::vector<Vec3> a = read_vector_field(whole / time / "U", cells);
    fs::remove_all(whole / time);
    const fs::path again = resumed(verification, "first_step_resumed", whole, k_halfway, 1);
    const std::vector<Vec3> b = read_vector_field(again / time / "U", cells);
    double fastest = 0.0, difference = 0.0;
    for (std::size_t c = 0; c < cells; ++c) {
        fastest = larger(fastest, a[c].norm());
        difference = larger(difference, (a[c] - b[c]).norm());
    }
    verification.at_most(
        "velocity after the first step from a checkpoint, over the largest", "-", difference / fastest, 1e-12,
        {"exact", fmt::format("begun and resumed on 1 rank, {} cells, linear solvers to rounding, written with 17 digits", cells), {}});
}

constexpr double k_rock = 0.02;      // diameter [m]
constexpr double k_spacing = 0.022;  // in the pack [m]

/// A pack of 20 rocks between the lumps of steel: it falls, and steel strikes it. \param shift  of all [m]
std::string pack(double shift) {
    std::string rocks;
    for (int i = 0; i < 20; ++i) {
        const double radius = 0.1275, azimuth = k_pi / 3.0 + k_spacing / radius * (i % 4);
        rocks += fmt::format("{},0,{:.9g},{:.9g},{:.9g},{},2650\n", i + 1, radius * std::cos(azimuth) + shift, radius * std::sin(azimuth),
                             -0.2 + k_spacing * (i / 4), k_rock);
    }
    return rocks;
}

/// Rocks that have come down to the floor at the end, within a quarter of a rock.
double on_floor(const fs::path& folder) {
    const auto state = coupling::read_state(newest_checkpoint(folder));
    return static_cast<double>(std::count_if(state.rocks.begin(), state.rocks.end(), [](const auto& rock) {
        return rock.second.position.z() < cases::test::k_tiny_z_min + 0.75 * k_rock;
    }));
}

/// Contacts at a time of a run that its balance has.
double contacts_at(const fs::path& folder, double time) {
    const auto balance = read_columns(folder / "postProcessing/balance/0/balance.csv");
    for (std::size_t i = 0; i < balance.at("time_s").size(); ++i)
        if (std::abs(balance.at("time_s")[i] - time) < 1e-6) return balance.at("contacts")[i];
    throw std::runtime_error(fmt::format("{} has no step that ends at {} s", folder.string(), time));
}

/// Contacts make runs part, so that a run resumed on other ranks is held against runs that began 1 um apart.
void check_contacts(Verification& verification) {
    constexpr int replicates = 6;
    constexpr double end = 0.4, struck = 0.04, quantile = 2.571;  // Student's, 95 %, 5 degrees of freedom
    std::vector<double> counts;
    fs::path first;
    double scatter = 1.0;
    for (int i = 0; i < replicates; ++i) {
        const fs::path folder = rotor_case(verification.folder(fmt::format("contacts_{}", i)), pack(1e-6 * i), end, struck, 1);
        run_cutter_foam(folder);
        counts.push_back(on_floor(folder));
        if (i == 0)
            first = folder;
        else
            scatter = std::min(scatter, apart(first, folder));
    }
    const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / replicates;
    double squares = 0.0;
    for (const double count : counts) squares += (count - mean) * (count - mean);
    const double reach = quantile * std::sqrt(squares / (replicates - 1) * (1.0 + 1.0 / replicates));

    verification.at_least(
        "contacts at the checkpoint from which the pack is resumed", "-", contacts_at(first, struck), 1.0,
        {"exact", "20 rocks of 20 mm at 60 rpm; a checkpoint without contacts would not show whether they are resumed", {}});
    const std::string stopped = fmt::format("stopped at {:g} s, as steel strikes the pack", struck);
    for (const int ranks : {1, 2, 4}) {
        const fs::path folder = resumed(verification, fmt::format("contacts_resumed_on_{}", ranks), first, struck, ranks);
        const std::string name = fmt::format("pack resumed on {} rank{}, begun on 1", ranks, ranks > 1 ? "s" : "");
        const fs::path soon = fs::path(names::checkpoints) / fmt::format("{:g}", 2.0 * struck);
        verification.at_most(name + fmt::format(", {:g} s later", struck), "tank diameters", apart_in(first / soon, folder / soon),
                             ranks == 1 ? 1e-10 : 1e-8, {"exact", stopped + "; linear solvers as shipped", {}});
        const double distance = apart(first, folder);
        if (ranks == 1) {
            verification.at_most(name, "tank diameters", distance, 1e-10, {"exact", stopped, {}});
            continue;
        }
        verification.at_most(name, "tank diameters", distance, scatter,
                             {"exact", stopped + "; farthest rock, against the nearest of the runs that began 1 um apart", {}});
        verification.absolute(
            fmt::format("rocks on the floor, pack resumed on {} ranks, begun on 1", ranks), "-", on_floor(folder), mean, reach,
            {"exact",
             fmt::format("the reference is the mean of {} runs that began 1 um apart ({}), the tolerance their prediction interval (95 %)",
                         replicates, fmt::join(counts, ", ")),
             {}});
    }
}

void run(Verification& verification) {
    check_first_step(verification);
    if (!verification.wants(Effort::standard)) return;
    check_ranks_and_restart(verification);
    check_contacts(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}

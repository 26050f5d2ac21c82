/// The same run on 1, 2 and 4 ranks, whole or resumed.
#include <regex>

#include <fmt/format.h>

#include "cases/rank_change.hpp"
#include "cases/tests/tiny_rotor_mesh.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/run_names.hpp"
#include "validation/support/box_case.hpp"
#include "validation/support/rotor_case.hpp"
#include "validation/support/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
namespace fs = std::filesystem;

constexpr double k_end = 0.15, k_halfway = 0.1;

/// Linear solvers go on to rounding, so that what is left is the program's own difference between ranks and not where a solver stopped.
void solve_to_rounding(const fs::path& folder) {
    const fs::path file = folder / "system/fvSolution";
    std::string text = std::regex_replace(read_file(file), std::regex("tolerance +[^;]+;"), "tolerance 1e-13;");
    text = std::regex_replace(text, std::regex("relTol +[^;]+;"), "relTol 0; maxIter 100;");
    write_file(file, text);
}

fs::path rotor_run(const fs::path& folder, int ranks) {
    cases::CaseInputs inputs = cases::test::tiny_inputs();
    inputs.ranks = ranks;
    inputs.times.end = k_end;
    inputs.times.checkpoint_interval = 0.05;
    inputs.times.write_interval = 0.05;
    inputs.rock.emplace();
    write_rotor_case(folder, inputs,
                     "id,time_s,x_m,y_m,z_m,diameter_m,density_kg_m3\n1,0.03,0,0.18,-0.1,0.02,2650\n2,0.03,-0.05,0.23,0,0.02,2650\n");
    solve_to_rounding(folder);
    cases::decompose(folder, ranks);
    run_cutter_foam(folder, ranks);
    return folder;
}

/// Largest distance of any rock over the tank's diameter.
double apart(const fs::path& a, const fs::path& b) {
    const RockPicture one = last_rocks(a), other = last_rocks(b);
    double most = 0.0;
    for (std::size_t p = 0; p < one.position.size(); ++p) most = std::max(most, (one.position[p] - other.position.at(p)).norm());
    return most / (2.0 * cases::test::k_tiny_tank_radius);
}

/// A copy of a run as it was halfway, resumed.
fs::path resumed(const Verification& verification, const fs::path& whole, int from, int ranks) {
    const fs::path folder = verification.folder(fmt::format("resumed_from_{}_on_{}", from, ranks));
    fs::copy(whole, folder, fs::copy_options::recursive);
    for (const auto& checkpoint : fs::directory_iterator(folder / names::checkpoints))
        if (std::stod(checkpoint.path().filename()) > k_halfway + 0.01) fs::remove_all(checkpoint.path());
    cases::move_checkpoint_to_ranks(folder, ranks);
    run_cutter_foam(folder, ranks);
    return folder;
}

void run(Verification& verification) {
    const fs::path one = rotor_run(verification.folder("ranks_1"), 1), two = rotor_run(verification.folder("ranks_2"), 2),
                   four = rotor_run(verification.folder("ranks_4"), 4);
    verification.at_most("rock on 2 ranks and on 1", "tank diameters", apart(one, two), 1e-8, {"exact", "0.15 s at 60 rpm, no contacts, linear solvers to rounding"});
    verification.at_most("rock on 4 ranks and on 1", "tank diameters", apart(one, four), 1e-8, {"exact", "0.15 s at 60 rpm, no contacts, linear solvers to rounding"});
    verification.at_most("resumed on 1 rank, begun on 1", "tank diameters", apart(one, resumed(verification, one, 1, 1)), 1e-10,
                         {"exact", "stopped at 0.1 s"});
    verification.at_most("resumed on 2 ranks, begun on 2", "tank diameters", apart(two, resumed(verification, two, 2, 2)), 1e-10,
                         {"exact", "stopped at 0.1 s"});
    verification.at_most("resumed on 1 rank, begun on 2", "tank diameters", apart(two, resumed(verification, two, 2, 1)), 1e-8,
                         {"exact", "through reconstructPar"});
    verification.at_most("resumed on 4 ranks, begun on 1", "tank diameters", apart(one, resumed(verification, one, 1, 4)), 1e-8,
                         {"exact", "through decomposePar"});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}

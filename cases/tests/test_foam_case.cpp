/// A case that the builder wrote, given to the stock programs: they read every file, take the frozen-rotor start and turn the rotor.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/flow_dictionaries.hpp"
#include "cases/scenes/cutter/start_flow.hpp"
#include "cases/testing/tiny_rotor_mesh.hpp"
#include "meshing/dictionary/foam_command.hpp"

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;

/// An empty run directory with the tiny mesh and the builder's case.
fs::path fresh_case(const std::string& name, const CaseInputs& inputs) {
    const fs::path directory = fs::path(CUTTERFLOW_BUILD_DIR) / "tests/runs" / name;
    fs::remove_all(directory);
    fs::create_directories(directory);
    write_case(directory, inputs);
    test::write_tiny_block_mesh(directory);
    require_child(meshing::foam_command(directory, "blockMesh"));
    return directory;
}

std::string read_text(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

int count(const std::string& text, const std::string& part) {
    int n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

/// Adds monitors of the flow through inlet, outlet and interface to the run's controlDict.
void monitor_flow(const fs::path& directory, const CaseInputs& inputs) {
    meshing::FoamDictionary functions;
    for (const char* patch : {"inlet", "outlet", "rotor_interface", "stator_interface"}) {
        meshing::FoamDictionary sum;
        sum.add("type", "surfaceFieldValue")
            .add("libs", meshing::FoamValue::list({"fieldFunctionObjects"}))
            .add("regionType", "patch")
            .add("name", patch);
        sum.add("operation", "sum").add("fields", meshing::FoamValue::list({"phi"})).add("writeFields", false);
        functions.add(patch, sum);
    }
    for (FoamFile file : run_system_files(inputs)) {
        if (file.path == "system/controlDict")
            meshing::write_foam_file(directory / file.path, file.foam_class, file.contents.add("functions", functions));
    }
}

/// Last value of a monitor [m3/s].
double flow_through(const fs::path& directory, const std::string& patch) {
    std::istringstream table(read_text(directory / "postProcessing" / patch / "0/surfaceFieldValue.dat"));
    double time = 0.0, value = 0.0;
    for (std::string line; std::getline(table, line);)
        if (line.front() != '#') std::istringstream(line) >> time >> value;
    return value;
}

TEST(FoamCase, is_readable_by_foamDictionary) {
    CaseInputs inputs = test::tiny_inputs();
    const fs::path directory = fresh_case("readable", inputs);
    int dictionaries = 0;
    for (const fs::path& file : write_case(directory, inputs)) {
        if (file.extension() == ".foam" || file.extension() == ".csv") continue;
        EXPECT_EQ(run_child(meshing::foam_command(directory, "foamDictionary", {"-keywords", file.string()})).exit_code, 0) << file;
        ++dictionaries;
    }
    EXPECT_EQ(dictionaries, 14);
    require_child(
        meshing::foam_command(directory, "foamDictionary", {"-entry", "boundaryField/outlet/volumetricFlowRate", "-value", "0/U"}));
    EXPECT_DOUBLE_EQ(std::stod(read_text(directory / "log.foamDictionary")), inputs.discharge);
}

TEST(FoamCase, starts_frozen_on_two_ranks_and_then_turns) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.ranks = 2;
    inputs.times.end = inputs.times.write_interval = 0.004;
    const fs::path directory = fresh_case("start", inputs);

    int last_iteration = 0;
    const StartFlowReport report = run_start_flow(directory, inputs, 60, [&](int iteration, int) { last_iteration = iteration; });
    EXPECT_EQ(last_iteration, 60);
    EXPECT_LT(report.torque.last, -0.1);    // the water resists
    EXPECT_LT(report.flow_imbalance, 0.1);  // 0.5 and more when the interface is taken for turning steel
    EXPECT_FALSE(fs::exists(directory / "start/processor0"));
    EXPECT_FALSE(fs::exists(directory / "60"));
    EXPECT_NE(read_text(directory / "0/U").find("nonuniform"), std::string::npos);
    EXPECT_NE(read_text(directory / "0/U").find("movingWallVelocity"), std::string::npos);

    monitor_flow(directory, inputs);
    require_child(meshing::foam_command(directory, "decomposePar"));
    require_child(meshing::foam_command(directory, "pimpleFoam", {}, 2));
    const std::string log = read_text(directory / "log.pimpleFoam");
    EXPECT_GE(count(log, "\nTime = "), 2);
    EXPECT_NE(log.find("solidBody"), std::string::npos);
    EXPECT_TRUE(fs::exists(directory / "processor1/0.004/U"));
    EXPECT_NEAR(flow_through(directory, "outlet"), inputs.discharge, 1e-9 * inputs.discharge);
    // What the two sides of the interface disagree on is the interface's own error; the solver's must be far smaller.
    const double interface = flow_through(directory, "rotor_interface") + flow_through(directory, "stator_interface");
    EXPECT_NEAR(flow_through(directory, "inlet"), -inputs.discharge - interface, 1e-6 * inputs.discharge);
    EXPECT_LT(std::abs(interface), 0.01 * inputs.discharge);
}

TEST(FoamCase, that_breaks_a_rule_is_not_written) {
    CaseInputs inputs = test::tiny_inputs();
    inputs.discharge = -1.0;
    const fs::path directory = fs::path(CUTTERFLOW_BUILD_DIR) / "tests/runs/refused";
    fs::remove_all(directory);
    EXPECT_THROW(write_case(directory, inputs), UserError);
    EXPECT_FALSE(fs::exists(directory));
}

}  // namespace
}  // namespace cutterflow::cases
